"""The force that one set of values has and another one lacks, along one trajectory.

    f = M (v̇(θ) - v̇(θ₀))        at the same positions, velocities and logged inputs

θ and θ₀ differ by an effect, or by an effect and the values that were fitted with it. M is the mass
matrix at θ₀. f is then the force that would have to act on the model of θ₀ to make it accelerate
like that of θ, whatever the effect is: a friction, a weaker motor, another mass.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import mujoco
import numpy as np

from identification.kalman.linear import Linearisation, linearise_records
from identification.kalman.trajectory import Trajectory, average_inputs
from identification.model.numbers import with_numbers
from identification.model.predictor import Predictor
from identification.model.rollout import hold, substeps, without_sensors

ACTS = 0.01  # of the largest rms: a degree of freedom with less force is not acted on
LEAST = 1e-12  # [N or N m] a smaller force is rounding
JOINTS = (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE))


@dataclass(frozen=True, kw_only=True)
class ForceAlong:
    """Forces along a trajectory, on the degrees of freedom on which the first of them acts.

    Attributes:
        dofs: n of them, each of a hinge or a slide.
        records: the linearisation of each record, whose inputs are forces on these.
        predicted: outputs of the first set of values, shape (N, ny).
        forces: of each set of values beyond the base, shape (M, n) each [N or N m].
        drives: forces of the base's actuators, shape (M, n) [N or N m].
        position: shape (M, n) [rad or m].
        rate: shape (M, n) [rad/s or m/s].
        time: of each record, shape (M, n) [s].
        kind: of the joints, `mujoco.mjtJoint`.
        late: the first force at the same states and inputs, had the clock run backwards,
            shape (M, n).
        late_time: what that clock would say, shape (M, n) [s].
    """

    dofs: tuple[int, ...]
    records: tuple[Linearisation, ...]
    predicted: np.ndarray
    forces: tuple[np.ndarray, ...]
    drives: np.ndarray
    position: np.ndarray
    rate: np.ndarray
    time: np.ndarray
    kind: int
    late: np.ndarray
    late_time: np.ndarray

    @property
    def is_timed(self) -> bool:
        """Whether the first force would be another one at another time."""
        force = self.forces[0]
        return bool(np.abs(self.late - force).max() > ACTS * np.abs(force).max())


def force_along(
    predictor: Predictor, values: Mapping[str, float], base: Mapping[str, float],
    sets: Sequence[Mapping[str, float]],
) -> ForceAlong | None:  # fmt: skip
    """The forces of some sets of values beyond those of a base, along a predicted trajectory.

    Args:
        predictor: plant and log.
        values: whose trajectory it is, by name, in their units.
        base: θ₀, likewise.
        sets: each a θ; the first says on which degrees of freedom they act.

    Returns:
        None where the first set has no force, or one on what is no hinge and no slide, or on joints
        of both kinds.

    Raises:
        DivergenceError: the model cannot be simulated.
    """
    whole = _with(predictor, values)
    records = linearise_records(whole, _row(values)[0])
    each = [_with(predictor, chosen).records() for chosen in (base, *sets)]
    rates, drives, later = [], [], []
    for k, linear in enumerate(records):
        of = [_rates(*own[k], _row(chosen)[0], linear.along)
              for own, chosen in zip(each, (base, *sets), strict=True)]  # fmt: skip
        rates.append(_times_mass(of[0][2], linear.along, [a - of[0][0] for a, _, _ in of[1:]]))
        drives.append(of[0][1])
        turned = replace(linear.along, time=linear.along.time[::-1])
        off = [_rates(*own[k], _row(chosen)[0], turned)[0]
               for own, chosen in zip(each, (base, sets[0]), strict=False)]  # fmt: skip
        later += _times_mass(of[0][2], turned, [off[1] - off[0]])
    forces = [np.vstack(f) for f in zip(*rates, strict=True)]
    model = records[0].along.model
    dofs, kind = _dofs(model, forces[0])
    if not dofs:
        return None
    joints = [int(model.dof_jntid[d]) for d in dofs]
    at = [int(model.jnt_qposadr[j]) for j in joints]
    along = [linear.along for linear in records]
    pushed = linearise_records(whole, _row(values)[0], forces=dofs)
    return ForceAlong(
        dofs=tuple(dofs),
        records=pushed,
        predicted=whole.predict(_row(values))[0],
        forces=tuple(f[:, dofs] for f in forces),
        drives=np.vstack(drives)[:, dofs],
        position=np.vstack([a.qpos[:, at] for a in along]),
        rate=np.vstack([a.qvel[:, dofs] for a in along]),
        time=np.concatenate([a.time for a in along])[:, None] * np.ones(len(dofs)),
        kind=kind,
        late=np.vstack(later)[:, dofs],
        late_time=np.concatenate([a.time[::-1] for a in along])[:, None] * np.ones(len(dofs)),
    )


def _with(predictor: Predictor, values: Mapping[str, float]) -> Predictor:
    return replace(predictor, names=tuple(values), fixed={})


def _row(values: Mapping[str, float]) -> np.ndarray:
    return np.array([[*values.values()]])


def _dofs(model: mujoco.MjModel, force: np.ndarray) -> tuple[list[int], int]:
    """Degrees of freedom on which a force (M, nv) acts, and the kind of their joints."""
    rms = np.sqrt(np.mean(force**2, axis=0))
    if rms.max(initial=0.0) < LEAST:
        return [], 0
    dofs = np.flatnonzero(rms > ACTS * rms.max()).tolist()
    kinds = {int(model.jnt_type[model.dof_jntid[d]]) for d in dofs}
    kind = min(kinds)
    return (dofs, kind) if len(kinds) == 1 and kind in JOINTS else ([], 0)


def _rates(
    predictor: Predictor, columns: list[int], values: np.ndarray, along: Trajectory
) -> tuple[np.ndarray, np.ndarray, mujoco.MjModel]:
    """Accelerations and forces of the actuators along a trajectory (M, nv), and the model."""
    row, log = values[None, columns], predictor.log
    plant = predictor.plant.model
    model = with_numbers(without_sensors(plant), predictor.settings(row)[1], 0)
    held = hold(log.inputs, substeps(log.sampling_time, along.timestep), log.hold)
    inputs = average_inputs(predictor.inputs(row)(held), along.steps, model.nu)[0]
    data = mujoco.MjData(model)
    rates, drives = np.empty_like(along.qvel), np.empty_like(along.qvel)
    for k in range(len(along.time)):
        _place(data, along, k)
        data.ctrl[:] = inputs[k]
        mujoco.mj_forward(model, data)
        rates[k], drives[k] = data.qacc, data.qfrc_actuator
    return rates, drives, model


def _times_mass(
    model: mujoco.MjModel, along: Trajectory, rates: Sequence[np.ndarray]
) -> list[np.ndarray]:
    """M times accelerations along a trajectory, shape (M, nv) each."""
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
