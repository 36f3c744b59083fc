"""The force that one set of values has and another one lacks, along one trajectory.

    f = M (v̇(θ) - v̇(θ₀))        at the same positions, velocities and logged inputs

θ and θ₀ differ by an effect, or by an effect and the values that were fitted with it. M is the mass
matrix at θ₀. f is then the force that would have to act on the model of θ₀ to make it accelerate
like that of θ, whatever the effect is: a friction, a weaker motor, another mass.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import mujoco
import numpy as np

from identification.kalman.linear import Linearisation, linearise_along
from identification.kalman.trajectory import Trajectory
from identification.model.predictor import Predictor
from identification.runtime.engine import quiet

MIN_ACTING_SHARE = 0.01  # of the largest rms: a degree of freedom with less force is not acted on
ROUNDING_FORCE = 1e-12  # [N or N m] a smaller force is rounding
JOINTS = (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE))


@dataclass(frozen=True, kw_only=True)
class ForceAlong:
    """Forces along a trajectory, on the degrees of freedom on which the first of them acts."""

    dofs: tuple[int, ...]  # n of them, each of a hinge or a slide
    # the linearisation along each, whose inputs are forces on these
    stretches: tuple[Linearisation, ...]
    predicted: np.ndarray  # outputs of the first set of values, shape (N, ny)
    # of each set of values beyond the base, shape (M, n) each [N or N m]
    forces: tuple[np.ndarray, ...]
    drives: np.ndarray  # forces of the base's actuators, shape (M, n) [N or N m]
    position: np.ndarray  # shape (M, n) [rad or m]
    rate: np.ndarray  # shape (M, n) [rad/s or m/s]
    # where the rate changes by more than itself to the point before or behind, and one point
    # beside: in a step of the simulation in which a joint turns or stops, friction has both signs,
    # shape (M, n)
    turning: np.ndarray
    time: np.ndarray  # in its record, shape (M, n) [s]
    kind: int  # of the joints, `mujoco.mjtJoint`
    # the first force at the same states and inputs, had the clock run backwards, shape (M, n)
    late: np.ndarray
    late_time: np.ndarray  # what that clock would say, shape (M, n) [s]

    @property
    def is_timed(self) -> bool:
        """Tells whether the first force would be another one at another time."""
        force = self.forces[0]
        return bool(np.abs(self.late - force).max() > MIN_ACTING_SHARE * np.abs(force).max())


@dataclass(frozen=True)
class Stretch:
    """A simulation from one state: of a record, or of a window of one."""

    predictor: Predictor  # of its outputs
    along: Trajectory  # its trajectory, of M points
    # of θ₀ and of each θ, the model and the inputs that reach it, shape (M, nu)
    reached: Sequence[tuple[mujoco.MjModel, np.ndarray]]


def forces_along(stretches: Sequence[Stretch], predicted: np.ndarray) -> ForceAlong | None:
    """Returns the forces of some sets of values beyond those of a base, along stretches.

    Args:
        stretches: with the models of base and sets.
        predicted: outputs of the first set along all of them, shape (N, ny).

    Returns:
        None where the first set has no force, or one on what is no hinge and no slide, or on joints
        of both kinds.
    """
    rates, drives, later = [], [], []
    for stretch in stretches:
        along, (bare, first, *_) = stretch.along, stretch.reached
        of = [_rates(*each, along) for each in stretch.reached]
        rates.append(_times_mass(bare[0], along, [a - of[0][0] for a, _ in of[1:]]))
        drives.append(of[0][1])
        turned = replace(along, time=along.time[::-1])
        off = [_rates(*each, turned)[0] for each in (bare, first)]
        later += _times_mass(bare[0], turned, [off[1] - off[0]])
    forces = [np.vstack(f) for f in zip(*rates, strict=True)]
    each = [stretch.along for stretch in stretches]
    model = each[0].model
    dofs, kind = _dofs(model, forces[0])
    if not dofs:
        return None
    joints = [int(model.dof_jntid[d]) for d in dofs]
    at = [int(model.jnt_qposadr[j]) for j in joints]
    return ForceAlong(
        dofs=tuple(dofs),
        stretches=tuple(linearise_along(s.predictor, s.along, dofs) for s in stretches),
        predicted=predicted,
        forces=tuple(f[:, dofs] for f in forces),
        drives=np.vstack(drives)[:, dofs],
        position=np.vstack([a.qpos[:, at] for a in each]),
        rate=np.vstack([a.qvel[:, dofs] for a in each]),
        turning=np.vstack([_turning(a.qvel[:, dofs]) for a in each]),
        time=np.concatenate([a.time for a in each])[:, None] * np.ones(len(dofs)),
        kind=kind,
        late=np.vstack(later)[:, dofs],
        late_time=np.concatenate([a.time[::-1] for a in each])[:, None] * np.ones(len(dofs)),
    )


def _dofs(model: mujoco.MjModel, force: np.ndarray) -> tuple[list[int], int]:
    """Returns degrees of freedom on which a force (M, nv) acts, and the kind of their joints."""
    rms = np.sqrt(np.mean(force**2, axis=0))
    if rms.max(initial=0.0) < ROUNDING_FORCE:
        return [], 0
    dofs = np.flatnonzero(rms > MIN_ACTING_SHARE * rms.max()).tolist()
    kinds = {int(model.jnt_type[model.dof_jntid[d]]) for d in dofs}
    kind = min(kinds)
    return (dofs, kind) if len(kinds) == 1 and kind in JOINTS else ([], 0)


def _turning(rate: np.ndarray) -> np.ndarray:
    """Returns a mask where rates change by more than themselves to a neighbour, shape (M, n).

    The neighbours are told too: in the step that ends with a joint at rest, what holds it is any
    force below its friction.
    """
    change = np.abs(np.diff(rate, axis=0))
    none = np.zeros_like(rate[:1])
    most = np.maximum(np.concatenate([none, change]), np.concatenate([change, none]))
    turned = np.abs(rate) < most
    near = turned.copy()
    near[1:] |= turned[:-1]
    near[:-1] |= turned[1:]
    return near


@quiet()
def _rates(
    model: mujoco.MjModel, inputs: np.ndarray, along: Trajectory
) -> tuple[np.ndarray, np.ndarray]:
    """Returns accelerations and actuator forces along a trajectory, shape (M, nv) each."""
    data = mujoco.MjData(model)
    rates, drives = np.empty_like(along.qvel), np.empty_like(along.qvel)
    for k in range(len(along.time)):
        _place(data, along, k)
        data.ctrl[:] = inputs[k]
        mujoco.mj_forward(model, data)
        rates[k], drives[k] = data.qacc, data.qfrc_actuator
    return rates, drives


def _times_mass(
    model: mujoco.MjModel, along: Trajectory, rates: Sequence[np.ndarray]
) -> list[np.ndarray]:
    """Returns the inertia matrix times accelerations along a trajectory, shape (M, nv) each."""
    data, out = mujoco.MjData(model), [np.empty_like(a) for a in rates]
    for k in range(len(along.time)):
        _place(data, along, k)
        mujoco.mj_fwdPosition(model, data)
        for f, a in zip(out, rates, strict=True):
            mujoco.mj_mulM(model, data, f[k], a[k])
    return out


def _place(data: mujoco.MjData, along: Trajectory, k: int) -> None:
    data.time = along.time[k]
    data.qpos[:], data.qvel[:], data.act[:] = along.qpos[k], along.qvel[k], along.act[k]
