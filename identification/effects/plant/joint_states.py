"""Joints with states of their own: their numbers, their loads, and what motors may have of inertia.

    motor   θ, ω       of the motor behind a gear
    grip    p          the force of a friction that gives                            [N m or N]
    sum     z          ∫ e dt of a servo with an integral part                [rad s or m s]

The inertia that drives feel, and how much of it their motors may have:

    I_j = min 1/A_jj,   A = M⁻¹                      over several poses, of the model's file
    λ_max(√J A √J) < 1                               in each of them, J: of all motors at once

The links of a robot keep M - J. For one motor that is positive where J < I; several may together
ask for more than there is.
"""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, cast

import mujoco
import numpy as np

from identification.effects.effect import Effect
from identification.effects.plant.rows import JointLayout
from identification.effects.values import Values, numbers_at
from identification.errors import DivergenceError
from identification.logs.names import listed
from identification.model.paths import write
from identification.model.predictor import Numbers
from identification.model.rollout import UNLOGGED, State
from identification.native.joints.gear import Gear
from identification.native.joints.joint_callback import FIRST, TAG
from identification.runtime.engine import quiet

Kind = Literal["motor", "grip", "sum"]
WIDTH: Mapping[str, int] = {"motor": 2, "grip": 1, "sum": 1}  # activations
POSES = 8  # random ones, behind the model's own


@dataclass(frozen=True)
class JointState:
    """A state of a joint."""

    kind: Kind  # "motor", θ and ω behind a gear; "grip", p of a friction that gives; or "sum", z
    joint: str  # its name


@dataclass(frozen=True, kw_only=True)
class GearNumbers:
    """The numbers of a joint's gear in n value sets, shape (n,) each; see `state_effects`."""

    c: np.ndarray
    gap: np.ndarray
    J: np.ndarray
    zeta: np.ndarray
    side: np.ndarray
    slip: np.ndarray
    drag: np.ndarray
    k_i: np.ndarray

    @property
    def columns(self) -> tuple[np.ndarray, ...]:
        """The columns in the order of a joint's row, from `SIDE` on."""
        return self.side, self.c, self.gap, self.J, self.zeta, self.slip, self.drag, self.k_i

    @property
    def is_geared(self) -> np.ndarray:
        """Tells whether the motor moves by itself, shape (n,)."""
        return (self.c != 0) | (self.gap != 0)


def with_actuators(spec: mujoco.MjSpec, states: Sequence[JointState]) -> mujoco.MjSpec:
    """Returns the model with an actuator for each state, of no gain and a control of zero."""
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
    """Returns the numbers of a joint's gear; of two effects that tell J, ζ and side, the larger."""
    series, alone = np.zeros((6, n)), {"grip": np.zeros(n), "sum": np.zeros(n)}
    for effect in (e for e in effects if e.state):
        numbers = [_each(x, n) for x in numbers_at(effect, joint, values)]
        (law,) = effect.hooks.values()
        told = law.py_func(Gear(inertia), tuple(numbers))  # type: ignore[attr-defined]
        if effect.state in alone:
            alone[effect.state] = alone[effect.state] + told
            continue
        here, told = numbers[0] != 0, np.array([_each(x, n) for x in told])
        series[[0, 1, 5]] += told[[0, 1, 5]]
        for k in (2, 3, 4):
            series[k] = np.maximum(series[k], np.where(here, told[k], 0.0))
    c, gap, J, zeta, side, drag = series
    return GearNumbers(c=c, gap=gap, J=J, zeta=zeta, side=side, slip=alone["grip"], drag=drag,
                       k_i=alone["sum"])  # fmt: skip


def _each(x: float | np.ndarray, n: int) -> np.ndarray:
    """Returns one number or n of them as n numbers, shape (n,)."""
    x = np.asarray(x)
    return x if x.shape == (n,) else np.full(n, x)  # numpy's broadcast_to takes ten times as long


def fitting(start: State | None, model: mujoco.MjModel) -> State | None:
    """Returns a start with a model's number of activations: the last are left out, or zero."""
    if start is None:
        return None
    act = np.zeros(model.na)
    given = np.ravel(start.act)[: model.na]
    act[: len(given)] = given
    return State(start.qpos, start.qvel, act)


def needed_states(effects: Sequence[Effect]) -> dict[str, tuple[JointState, ...]]:
    """Returns the states that each size of an effect needs, by its name."""
    out: dict[str, tuple[JointState, ...]] = {}
    for effect in effects:
        if effect.state not in WIDTH:
            continue
        kind = cast("Kind", effect.state)
        single = [suffix[1:] for suffix in effect.places.values() if suffix]
        for where, suffix in effect.places.items():
            at = [suffix[1:]] if suffix else single
            for size in effect.sizes:
                out[effect.parameter(size.name, where)] = tuple(JointState(kind, j) for j in at)
    return out


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


@quiet()
def mobilities(model: mujoco.MjModel, joints: Sequence[str]) -> np.ndarray:
    """Returns A among some joints in several poses, shape (`POSES`, g, g) [1/kg or 1/(kg m²)]."""
    data, rng = mujoco.MjData(model), np.random.default_rng(0)
    dofs = [int(model.joint(joint).dofadr[0]) for joint in joints]
    units, columns = np.zeros((len(dofs), model.nv)), np.zeros((len(dofs), model.nv))
    units[range(len(dofs)), dofs] = 1.0
    out = np.empty((POSES, len(dofs), len(dofs)))
    for pose in out:
        mujoco.mj_forward(model, data)
        if dofs:
            mujoco.mj_solveM(model, data, columns, units)
        pose[:] = columns[:, dofs]
        mujoco.mj_integratePos(model, data.qpos, rng.normal(0, 1, model.nv), 1.0)
    return out


def felt_inertias(A: np.ndarray) -> np.ndarray:
    """Returns I of each joint, shape (g,) [kg m² or kg], from A of `mobilities`."""
    return np.asarray(1 / np.max(np.diagonal(A, axis1=1, axis2=2), axis=0))


def refuse_greedy(J: np.ndarray, A: np.ndarray, joints: Sequence[str]) -> None:
    """Refuse motors that leave less than nothing to the links.

    Args:
        J: inertias of the motors that move by themselves, else 0, in n value sets, shape (n, g).
        A: of `mobilities`.
        joints: their names.
    """
    J = J[np.count_nonzero(J, axis=1) > 1]
    if not len(J):
        return
    root = np.sqrt(J)[:, None]
    share = np.linalg.eigvalsh(root[..., None] * A * root[..., None, :])[..., -1]
    if np.any(share >= 1):
        raise DivergenceError(
            f"the motors of {listed(joints)} would have more inertia than the robot has; take a"
            " smaller share rho"
        )
