"""Joints with states of their own: where the states stand, and what effects make of them.

As a window knows them (s and w stay small where a gear becomes stiff):

    motor   s, w       δ = c s + ε clip(s/s_0, -1, 1),  dδ/dt = c w        [N m, N m/s or N, N/s]
    grip    p          the force of the friction                                     [N m or N]

As MuJoCo integrates them: θ = q + δ, ω = v + dδ/dt, and p. Where the encoder sits on the motor's
side, what is measured is θ, so that q = θ - δ. Sizes of zero leave q and v as they are, to the bit.
"""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import mujoco
import numpy as np

from identification.effects.axes import Axis
from identification.effects.effect import Effect
from identification.effects.rows import JointLayout
from identification.effects.values import Values, numbers_at
from identification.engine import quiet
from identification.model.paths import write
from identification.model.predictor import Numbers
from identification.model.rollout import UNLOGGED, State
from identification.native.gear import Gear
from identification.native.joint_callback import FIRST, TAG

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


WIDTH = {"motor": 2, "grip": 1}  # activations
CERTAIN = 0.02  # s_0, of the largest force of the drives: with more, teeth are sure to touch


@dataclass(frozen=True)
class JointState:
    """A state of a joint.

    Attributes:
        kind: "motor", θ and ω behind a gear; or "grip", p of a friction that gives.
        joint: its name.
    """

    kind: Literal["motor", "grip"]
    joint: str


@dataclass(frozen=True, kw_only=True)
class GearNumbers:
    """The numbers of a joint's gear in n value sets, shape (n,) each; see `state_laws`."""

    c: np.ndarray
    gap: np.ndarray
    J: np.ndarray
    zeta: np.ndarray
    side: np.ndarray
    slip: np.ndarray

    @property
    def columns(self) -> tuple[np.ndarray, ...]:
        """The columns in the order of a joint's row, from `SIDE` on."""
        return self.side, self.c, self.gap, self.J, self.zeta, self.slip

    @property
    def is_geared(self) -> np.ndarray:
        """Whether the motor moves by itself, shape (n,)."""
        return (self.c != 0) | (self.gap != 0)


def with_actuators(spec: mujoco.MjSpec, states: Sequence[JointState]) -> mujoco.MjSpec:
    """Returns the model with an actuator for each state, of no gain and a control of zero.

    Args:
        spec: the model, which is not changed.
        states: which.
    """
    spec = spec.copy()
    for state in states:
        spec.add_actuator(
            name=f"{UNLOGGED}{state.kind} {state.joint}", target=state.joint,
            trntype=mujoco.mjtTrn.mjTRN_JOINT, dyntype=mujoco.mjtDyn.mjDYN_USER,
            actdim=WIDTH[state.kind], gaintype=mujoco.mjtGain.mjGAIN_FIXED, gainprm=[0.0] * 10,
            biastype=mujoco.mjtBias.mjBIAS_USER, biasprm=[TAG, *[0.0] * 9],
            gear=[1.0, 0, 0, 0, 0, 0],
        )  # fmt: skip
    return spec


def places_of(model: mujoco.MjModel, states: Sequence[JointState]) -> list[int]:
    """Returns the index of each state's first activation."""
    return [int(model.actuator(f"{UNLOGGED}{s.kind} {s.joint}").actadr[0]) for s in states]


def gear_numbers(
    effects: Sequence[Effect], joint: str, inertia: float, values: Values, n: int
) -> GearNumbers:
    """Returns the numbers of a joint's gear; of two effects that tell J, ζ and side, the larger.

    Args:
        effects: a set; those without states are passed over.
        joint: its name.
        inertia: I, that its drive feels.
        values: of all parameters, one or n of each.
        n: how many value sets.
    """
    series, slip = np.zeros((5, n)), np.zeros(n)
    for effect in (e for e in effects if e.state):
        numbers = [_each(x, n) for x in numbers_at(effect, joint, values)]
        (law,) = effect.hooks.values()
        told = law.py_func(Gear(inertia), tuple(numbers))  # type: ignore[attr-defined]
        if effect.state == "grip":
            slip = slip + told
            continue
        here, told = numbers[0] != 0, np.array([_each(x, n) for x in told])
        series[:2] += told[:2]
        for k in (2, 3, 4):
            series[k] = np.maximum(series[k], np.where(here, told[k], 0.0))
    c, gap, J, zeta, side = series
    return GearNumbers(c=c, gap=gap, J=J, zeta=zeta, side=side, slip=slip)


def _each(x: float | np.ndarray, n: int) -> np.ndarray:
    """Returns one number or n of them as n numbers, shape (n,)."""
    x = np.asarray(x)
    return x if x.shape == (n,) else np.full(n, x)  # numpy's broadcast_to takes ten times as long


def deflected(g: GearNumbers, s: np.ndarray, axis: Axis) -> np.ndarray:
    """Returns the deflection δ of a gear that passes on s."""
    return g.c * s + g.gap * s / (abs(s) + CERTAIN * axis.force)


def begun(
    model: mujoco.MjModel, states: Sequence[JointState], gears: Mapping[str, GearNumbers],
    axes: Mapping[str, Axis], known: State,
) -> State:  # fmt: skip
    """Returns states as MuJoCo integrates them, from states as windows know them.

    Args:
        model: with the states.
        states: of its joints.
        gears: of their joints, a number for each row of the states.
        axes: their joints.
        known: m rows.
    """
    qpos, qvel, act = np.array(known.qpos), np.array(known.qvel), np.array(known.act)
    for state, at in zip(states, places_of(model, states), strict=True):
        if state.kind != "motor":
            continue
        g, (q, v) = gears[state.joint], _columns(model, state.joint)
        delta = deflected(g, act[:, at], axes[state.joint])
        rate = (g.c + g.gap / (abs(act[:, at]) + axes[state.joint].force)) * act[:, at + 1]
        qpos[:, q] -= g.side * delta
        qvel[:, v] -= g.side * rate
        act[:, at], act[:, at + 1] = qpos[:, q] + delta, qvel[:, v] + rate
    return State(qpos, qvel, act)


def shown(
    model: mujoco.MjModel, states: Sequence[JointState], gears: Mapping[str, GearNumbers],
    run: Mapping[str, np.ndarray],
) -> Mapping[str, np.ndarray]:  # fmt: skip
    """Returns positions and rates as encoders see them: those of the motor where they sit there.

    Args:
        model: with the states.
        states: of its joints.
        gears: of their joints, a number for each simulation.
        run: qpos, qvel and act of m simulations, shape (m, samples, size).
    """
    qpos, qvel = np.array(run["qpos"]), np.array(run["qvel"])
    for state, at in zip(states, places_of(model, states), strict=True):
        if state.kind != "motor":
            continue
        g, (q, v) = gears[state.joint], _columns(model, state.joint)
        rows = np.flatnonzero(g.is_geared & (g.side > 0))
        qpos[rows, :, q], qvel[rows, :, v] = run["act"][rows, :, at], run["act"][rows, :, at + 1]
    return {**run, "qpos": qpos, "qvel": qvel}


def fitting(start: State | None, model: mujoco.MjModel) -> State | None:
    """Returns a start with a model's number of activations: the last are left out, or zero."""
    if start is None:
        return None
    act = np.zeros(model.na)
    given = np.ravel(start.act)[: model.na]
    act[: len(given)] = given
    return State(start.qpos, start.qvel, act)


def _columns(model: mujoco.MjModel, joint: str) -> tuple[int, int]:
    j = model.joint(joint)
    return int(j.qposadr[0]), int(j.dofadr[0])
