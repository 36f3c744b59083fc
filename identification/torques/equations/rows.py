"""The equations of a record: what its drives gave, and what its motion needs, joint by joint.

    y = τ_u - (τ_inv(q, v, a) - Y π_0 - I_0 a - d_0 v)              I_0, d_0: armature, damping
    y = Y π + I a + d v + f_c sign v - f_0 + what is missing

τ_inv is MuJoCo's inverse dynamics of the model (`mj_inverse`), so that its springs, tendons and
whatever else it has stay known; τ_u is what its actuators make of the logged inputs. τ_u and the
signs of the rates go through the filter that makes the motion smooth, as the accelerations do:
where a joint reverses, friction and accelerations jump together. A clock that is off moves the
inputs alone, and not the positions that a servo compares them with (`Rows.shifted`). Both sides are
then means over short times, a weak form of the equation with boxes as test functions. A joint that
is nearly at rest has no equation, because friction may then be any force below its level; nor has
one that reverses its direction, where the filter mixes both directions.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import mujoco
import numpy as np

from identification.errors import InputError
from identification.logs.log import Log
from identification.model.predictor import output_columns
from identification.torques.equations.bodies import read_numbers, regressor
from identification.torques.equations.drives import (
    drive_forces,
    inverse_forces,
    without_constraints,
)
from identification.torques.equations.smoothing import (
    Motion,
    choose_band,
    edge_of,
    low_pass,
    noise_gains,
    smooth,
)

SCALAR = (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE))
PER_PERIOD = 4.0  # times of mean in a period of the band
SAMPLES = 20_000  # of which the regressor is made at once
MOST = 8_000  # equations of each joint, over all records
SLOW = 0.02  # of the top rate of a joint in all records: slower it is at rest
TURNING = 0.1  # of a filtered sign, that it may be off
WIDE = 2.0  # times the band, that of the rates of which a drive makes its force
STATES = 40  # of a record, over which the masses that joints move are averaged
NOISY = 4.0  # std of a rate's noise: slower it may be at rest


@dataclass(frozen=True, kw_only=True)
class Rows:
    """Means of N short times of a record."""

    name: str  # of the record
    time: np.ndarray  # shape (N,) [s]
    q: np.ndarray  # positions, shape (N, nv) [rad or m]
    v: np.ndarray  # rates, shape (N, nv)
    a: np.ndarray  # accelerations, shape (N, nv)
    sign: np.ndarray  # of the rates, through the filter, shape (N, nv)
    bodies: np.ndarray  # Y, shape (N, nv, bodies, 10)
    gravity: np.ndarray  # its force on the joints, shape (N, nv) [N m or N]
    drives: np.ndarray  # forces of each actuator on the joints, shape (N, nv, nu) [N m or N]
    late: np.ndarray  # how they fall as the inputs come later, shape (N, nv, nu) [N m/s or N/s]
    y: np.ndarray  # shape (N, nv) [N m or N]
    used: np.ndarray  # where a joint moves, shape (N, nv)
    noise: np.ndarray  # std that noise of positions and drives makes in y, shape (nv,) [N m or N]
    band: float  # of the motion [Hz]
    # returns `drives` and `late` with inputs that act by a time later than their stamps say
    drives_at: Callable[[float], tuple[np.ndarray, np.ndarray]]
    shift: float = 0.0  # this time [s]

    def shifted(self, shift: float) -> Rows:
        """Returns the equations with inputs that act this much later than their stamps say [s]."""
        if shift == self.shift:
            return self
        drives, late = self.drives_at(shift)
        y = self.y + (drives - self.drives).sum(axis=2)
        return replace(self, drives=drives, late=late, y=y, shift=shift)


def refuse_unfit(model: mujoco.MjModel, log: Log) -> None:
    """Refuse a model or a log of which no equations of torques can be made."""
    for j, kind in enumerate(model.jnt_type):
        if int(kind) not in SCALAR:
            raise InputError(
                f"joint {model.joint(j).name!r} is neither hinge nor slide; torques are compared"
                " for robots of hinges and slides: use identification discover"
            )
    if model.neq:
        raise InputError(
            "the model has equality constraints, whose forces no motion tells; torques are compared"
            " for robots without closed loops: use identification discover"
        )
    if model.na:
        raise InputError(
            "an actuator of the model has a state of its own; torques are compared where the force"
            " follows from the input: log the torque, and write a motor in its place"
        )
    told = {i for field, i in output_columns(model, log.output_names) if field == "qpos"}
    for j, i in enumerate(model.jnt_qposadr):
        if int(i) not in told:
            raise InputError(
                f"no output of log {log.name!r} is the position of joint {model.joint(j).name!r};"
                " torques are compared where all positions are measured: add a jointpos sensor"
            )


def make_rows(
    model: mujoco.MjModel, logs: Sequence[Log], own: Sequence[mujoco.MjModel] = (),
    wider: float = 1.0,
) -> tuple[Rows, ...]:  # fmt: skip
    """Returns the equations of records, smooth in bands that are `wider` by this factor.

    `own` is the model of each log, where some of its values hold in that log alone.

    Raises:
        InputError: the model has other joints than hinges and slides, closed loops or drives with
            states, a position is not measured, no input moves, a record is too short for its band,
            or no joint moves long enough one way.
    """
    measured = [_positions(model, log) for log in logs]
    motions = [_motion(model, log, q, wider) for log, q in zip(logs, measured, strict=True)]
    top = np.max([np.abs(m.v).max(axis=0) for m in motions], axis=0)
    least = -(-sum(map(len, logs)) // MOST)
    if not any(log.inputs.any() for log in logs):
        raise InputError(
            "no input moves in these logs, and without a drive's torque the masses of everything"
            " have no scale: give a log with the drives' torques, or use identification fit"
        )
    known = read_numbers(model)
    each = zip(own or [model] * len(logs), logs, measured, motions, strict=True)
    rows = tuple(_rows(m, known, log, q, motion, top, least) for m, log, q, motion in each)
    if not any(r.used.any() for r in rows):
        raise InputError(
            "no joint moves long enough in one direction: between two reversals of its direction"
            " its rate must stay above the noise for longer than the low-pass filter of positions"
            f" (cutoff {max(r.band for r in rows):.3g} Hz) mixes both directions; give logs whose"
            " motion reverses less often, that are sampled faster or that have less noise"
        )
    return rows


def _positions(model: mujoco.MjModel, log: Log) -> np.ndarray:
    """Returns the measured positions of the joints, shape (n, nv)."""
    refuse_unfit(model, log)
    columns = output_columns(model, log.output_names)
    at = {i: k for k, (field, i) in enumerate(columns) if field == "qpos"}
    return log.outputs[:, [at[int(i)] for i in model.jnt_qposadr]]


def _motion(model: mujoco.MjModel, log: Log, q: np.ndarray, wider: float) -> Motion:
    h = log.sampling_time
    chosen = [choose_band(x, h) for x in q.T]
    # One band for all: the torque of a joint has the accelerations of all others in it. The widest
    # where a joint has no drive: no torque goes through the filter that would leave out as much.
    moving = np.ptp(q, axis=0) > SLOW * np.ptp(q, axis=0).max()
    bands = [f for (f, _), moves in zip(chosen, moving, strict=True) if moves]
    band = float(np.median(bands) if _have_drives(model) else max(bands))
    return smooth(q, h, wider * band, np.array([noise for _, noise in chosen]))


def _have_drives(model: mujoco.MjModel) -> bool:
    """Returns whether a drive acts on each joint."""
    data, moment = mujoco.MjData(model), np.zeros((model.nu, model.nv))
    mujoco.mj_fwdPosition(model, data)
    mujoco.mju_sparse2dense(
        moment, data.actuator_moment, data.moment_rownnz, data.moment_rowadr, data.moment_colind
    )
    return bool(moment.any(axis=0).all())


def _rows(
    model: mujoco.MjModel, numbers: np.ndarray, log: Log, measured: np.ndarray, motion: Motion,
    top: np.ndarray, least: int,
) -> Rows:  # fmt: skip
    h, band = log.sampling_time, motion.band
    width = max(least, round(1 / (PER_PERIOD * band * h)), 1)
    cut = edge_of(len(log), h, band)
    keep = slice(cut, len(log) - cut)
    count = (len(log) - 2 * cut) // width
    if count < 2:
        raise InputError(
            f"log {log.name!r} lasts {log.duration:g} s, and {2 * cut * h:.2g} s of its ends are"
            " cut because its accelerations are not known there; give a longer log"
        )
    mean = partial(_means, count=count, width=width)
    q, v, a = motion.q[keep], motion.v[keep], motion.a[keep]
    Y, gravity = _mean_regressor(model, q, v, a, count, width)
    bare = without_constraints(model)
    inverse = inverse_forces(bare, motion)
    # What the filter leaves out of a setpoint, it leaves out of the position beside it, once.
    rates = smooth(measured, h, WIDE * band, motion.noise).v

    def forces_at(shift: float) -> np.ndarray:
        return drive_forces(bare, measured, rates, log, [shift, shift - h / 2, shift + h / 2])

    def averaged(forces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        now, before, after = (mean(low_pass(x, h, band)[keep]) for x in forces)
        return now, (before - after) / h

    forces = forces_at(0.0)
    noise = _noise(model, motion, forces[0].sum(axis=2), h, width)
    drives, late = averaged(forces)
    sign = low_pass(np.sign(motion.v), h, band)[keep]
    known = mean(inverse[keep]) - np.einsum("kjbn,bn->kj", Y, numbers)
    known -= mean(model.dof_armature * a + model.dof_damping * v)
    limit = np.maximum(SLOW * top, NOISY * motion.noise)
    resting = (np.abs(v) < limit) | (np.abs(np.abs(sign) - 1) > TURNING)
    used = mean(resting.astype(float)) == 0
    time = log.time[keep] - log.time[0] + log.begun
    for begin, end in log.gaps:
        at = time + log.time[0] - log.begun
        used &= (mean(((at >= begin) & (at <= end)).astype(float)) == 0)[:, None]
    return Rows(
        name=log.name, time=mean(time), q=mean(q), v=mean(v), a=mean(a), sign=mean(sign),
        bodies=Y, gravity=gravity, drives=drives, late=late,
        drives_at=lambda shift: averaged(forces_at(shift)),
        y=drives.sum(axis=2) - known, used=used, noise=noise, band=motion.band,
    )  # fmt: skip


def _noise(
    model: mujoco.MjModel, motion: Motion, force: np.ndarray, h: float, width: int
) -> np.ndarray:
    """Returns the std that white noise of positions and of drives' forces makes in means of y.

    That of accelerations with the model's masses, and that of forces, through the filter; of other
    noise, such as what a controller makes of that of the positions in its band, it knows nothing.
    """
    of_a, of_force = noise_gains(motion.band, h, width)
    white = motion.noise / motion.gain
    data, M, squares = mujoco.MjData(model), np.empty((model.nv, model.nv)), np.zeros(model.nv)
    some = np.linspace(0, len(motion.q) - 1, STATES).astype(int)
    for k in some:
        data.qpos = motion.q[k]
        mujoco.mj_fwdPosition(model, data)
        mujoco.mj_fullM(model, data, M)
        squares += ((M * white * of_a) ** 2).sum(axis=1)
    of_drives = np.array([choose_band(f, h)[1] if np.ptp(f) else 0.0 for f in force.T])
    return np.sqrt(squares / len(some) + (of_force * of_drives) ** 2)


def _mean_regressor(
    model: mujoco.MjModel, q: np.ndarray, v: np.ndarray, a: np.ndarray, count: int, width: int
) -> tuple[np.ndarray, np.ndarray]:
    """Returns means of Y and of gravity's forces over short times, some at once to spare memory."""
    at_once = max(1, SAMPLES // width)
    out = []
    for first in range(0, count, at_once):
        n = min(at_once, count - first)
        some = slice(first * width, (first + n) * width)
        out.append([_means(x, n, width) for x in regressor(model, q[some], v[some], a[some])])
    Y, gravity = (np.concatenate(part) for part in zip(*out, strict=True))
    return Y, gravity


def _means(x: np.ndarray, count: int, width: int) -> np.ndarray:
    """Returns the means of `count` times of `width` samples each, of an array (n, ...)."""
    return np.asarray(x[: count * width].reshape(count, width, *x.shape[1:]).mean(axis=1))
