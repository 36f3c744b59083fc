"""Loads of gears and friction where windows begin, as a plant without their states says.

    s̄ = f_u - J dv/dt          p̄ = the force of friction          w̄ = 0

Where a gear does not swing, it carries what moves the link; the states of windows are free about
that. How far: s and p by their own rms, w by a change of s by its rms within a sample.
"""

from __future__ import annotations

import copy
from collections.abc import Sequence

import mujoco
import numpy as np

from identification.effects.joint_layout import JointLayout
from identification.effects.joint_states import GearNumbers, JointState
from identification.engine import quiet
from identification.model.paths import write
from identification.model.predictor import Numbers
from identification.model.rollout import State
from identification.native.joint_callback import FIRST

LEAST = 1e-3  # of the largest force of the drives: the smallest std of a force


@quiet()
def first_loads(
    model: mujoco.MjModel, layout: JointLayout, numbers: Numbers, begun: State, inputs: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Returns forces of drives and of friction, and accelerations, of each degree of freedom.

    Args:
        model: of the plant without states.
        layout: of its effects.
        numbers: entries of the model, one value each.
        begun: where windows begin, W rows.
        inputs: there, shape (W, nu).

    Returns:
        Three arrays of shape (W, nv).
    """
    model = copy.copy(model)
    for slot, values in numbers:
        write(model, slot, float(np.asarray(values).ravel()[0]))
    data = mujoco.MjData(model)
    mujoco.mj_setConst(model, data)
    loose = copy.copy(model)  # without friction
    first = model.nuser_jnt - layout.entries + FIRST
    for term in layout.on_joints:
        if term.function("friction") is not None:
            at = first + term.column
            tagged = model.jnt_user[:, -2] == layout.key
            loose.jnt_user[tagged, at : at + term.sizes] = 0.0
    out = np.zeros((3, len(begun.qpos), model.nv))
    for k, u in enumerate(inputs):
        data.qpos[:], data.qvel[:], data.ctrl[:] = begun.qpos[k], begun.qvel[k], u
        data.act[:] = begun.act[k, : model.na]
        mujoco.mj_forward(loose, data)
        free = np.array(data.qfrc_passive)
        mujoco.mj_forward(model, data)
        out[:, k] = data.qfrc_actuator, free - data.qfrc_passive, data.qacc
    return out[0], out[1], out[2]


def first_states_of(
    states: Sequence[JointState], model: mujoco.MjModel, gears: dict[str, GearNumbers],
    forces: dict[str, float], loads: tuple[np.ndarray, np.ndarray, np.ndarray],
    sampling_time: float,
) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
    """Returns the states where windows begin, shape (W, na), and how far off they may be, (na,).

    Args:
        states: in the order of their activations.
        model: of the plant.
        gears: what effects make of their joints, one value each.
        forces: largest force of the drives of their joints [N m or N].
        loads: of `first_loads`.
        sampling_time: [s].
    """
    drives, friction, rates = loads
    columns, far = [], []
    for state in states:
        dof = int(model.joint(state.joint).dofadr[0])
        least = LEAST * forces[state.joint]
        if state.kind == "grip":
            p = friction[:, dof]
            columns.append(p)
            far.append(max(least, _rms(p)))
            continue
        s = drives[:, dof] - gears[state.joint].J[0] * rates[:, dof]
        columns += [s, np.zeros(len(s))]
        far += [max(least, _rms(s)), max(least, _rms(s)) / sampling_time]
    return np.stack(columns, axis=1), np.array(far)


def _rms(x: np.ndarray) -> float:
    return float(np.sqrt(np.mean(x**2)))
