"""The limits of an experiment, and how near to them a simulated one comes.

    low ≤ q_j ≤ high      |q̇_j| ≤ fastest      low ≤ u_i ≤ high      |force_i| < forcerange

Where the model has a range (of a joint, ctrlrange, forcerange, actuatorfrcrange) it is the limit,
else the range of the robot's own logs, widened by a share of itself. Speeds are those of the logs,
widened likewise. Bodies that touch nothing where the experiment begins must touch nothing at all.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

from identification.effects.axes import Axis
from identification.errors import InputError
from identification.logs.log import Log
from identification.model.predictor import output_columns
from identification.runtime.engine import quiet

ROUNDING = 1e-9  # of a limit's width
OFF = int(mujoco.mjtDisableBit.mjDSBL_CONTACT) | int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
PLAIN = (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE))


@dataclass(frozen=True)
class Limit:
    """A limit of one number."""

    what: str  # "position", "speed", "input" or "force"
    name: str  # of the joint or the actuator
    low: float  # in SI units, as all that follows
    high: float
    source: str  # "model" or "logs"


@dataclass(frozen=True)
class Margin:
    """A limit, and how near to it an experiment comes."""

    limit: Limit
    least: float  # that it reaches
    most: float

    @property
    def left(self) -> float:
        """The smallest distance from the limit; negative where it is broken."""
        return min(self.least - self.limit.low, self.limit.high - self.most)

    @property
    def share(self) -> float:
        """The distance left, of half the limit's width; infinite where nothing may move or does."""
        width = 0.5 * (self.limit.high - self.limit.low)
        if not width and not self.left:
            return np.inf
        return self.left / (width or 1.0)


@dataclass(frozen=True)
class Limits:
    """All limits of an experiment."""

    joints: tuple[int, ...]  # indices of the hinges and slides
    positions: tuple[Limit | None, ...]  # of each of them
    speeds: tuple[Limit | None, ...]
    inputs: tuple[Limit, ...]  # of each input
    forces: tuple[Limit | None, ...]  # of each actuator
    touching: frozenset[tuple[int, int]]  # bodies that may touch, the smaller index first
    looks: bool  # whether contacts are looked for; not where the model switches them off


def limits_of(
    model: mujoco.MjModel, known: Sequence[Axis], logs: Sequence[Log], start: np.ndarray,
    widen: float = 0.0,
) -> Limits:  # fmt: skip
    """Returns the limits of a robot whose experiment begins at some positions (nq,).

    The logs show the motion of the known axes. Their range is widened by a share of itself on each
    side.

    Raises:
        InputError: the share is not one of 0 to 10.
    """
    if not 0 <= widen <= 10:
        raise InputError(f"a range widened by {widen:g} of itself is no limit; give 0 to 10")
    speed, q = {a.joint: a.speed for a in known}, _measured(model, logs)
    joints = tuple(j for j in range(model.njnt) if model.jnt_type[j] in PLAIN)
    positions: list[Limit | None] = []
    speeds: list[Limit | None] = []
    for j in joints:
        name = model.joint(j).name or f"joint {j}"
        own = model.jnt_range[j] if model.jnt_limited[j] else None
        positions.append(_limit("position", name, own, q.get(j), widen))
        fastest = speed.get(name)
        far = None if fastest is None else np.array([-fastest, fastest])
        speeds.append(_limit("speed", name, None, far, widen))
    u = np.concatenate([log.inputs for log in logs])
    inputs, forces = [], []
    for i in range(u.shape[1]):
        name = model.actuator(i).name
        own = model.actuator_ctrlrange[i] if model.actuator_ctrllimited[i] else None
        inputs.append(_limit("input", name, own, np.array([u[:, i].min(), u[:, i].max()]), widen))
        forces.append(_limit("force", name, _force_range(model, i), None, 0.0))
    touching = frozenset() if model.opt.disableflags & OFF else _touching(model, start)
    return Limits(
        joints, tuple(positions), tuple(speeds), tuple(x for x in inputs if x is not None),
        tuple(forces), touching, not model.opt.disableflags & OFF and bool(model.ngeom),
    )  # fmt: skip


@quiet()
def margins(
    model: mujoco.MjModel, limits: Limits, inputs: np.ndarray, qpos: np.ndarray, qvel: np.ndarray
) -> tuple[tuple[Margin, ...], str]:
    """Returns the margins of a simulated experiment, the nearest first, and what touches.

    It has inputs (N, nu), positions (N, nq) and rates (N, nv). Of what touches and may not, two
    bodies are told in words; "" where none do.
    """
    force, touch = _looked(model, limits, qpos, qvel, inputs)
    pairs: list[tuple[Limit | None, np.ndarray]] = []
    for k, j in enumerate(limits.joints):
        pairs.append((limits.positions[k], qpos[:, model.jnt_qposadr[j]]))
        pairs.append((limits.speeds[k], qvel[:, model.jnt_dofadr[j]]))
    pairs += [*zip(limits.inputs, inputs.T, strict=True), *zip(limits.forces, force.T, strict=True)]
    found = [Margin(limit, float(x.min()), float(x.max())) for limit, x in pairs if limit]
    return tuple(sorted(found, key=lambda m: m.share)), touch


def keeps(found: Sequence[Margin]) -> bool:
    """Returns whether all margins are kept; a force at its limit is cut off, and is not kept."""
    rounding = {"force": ROUNDING}
    return all(m.share >= rounding.get(m.limit.what, -ROUNDING) for m in found)


def _looked(
    model: mujoco.MjModel, limits: Limits, qpos: np.ndarray, qvel: np.ndarray, inputs: np.ndarray
) -> tuple[np.ndarray, str]:
    """Returns forces of the actuators at each sample, (N, nu), and what touches; see `margins`."""
    data, nu = mujoco.MjData(model), inputs.shape[1]
    needs_force = any(limits.forces) and not model.na
    force = np.zeros((len(qpos), nu))
    if not needs_force and not limits.looks:
        return force, ""
    for k, (q, v, u) in enumerate(zip(qpos, qvel, inputs, strict=True)):
        data.qpos[:], data.qvel[:], data.ctrl[:nu] = q, v, u
        mujoco.mj_fwdPosition(model, data)
        if needs_force:
            mujoco.mj_fwdVelocity(model, data)
            mujoco.mj_fwdActuation(model, data)
            force[k] = data.actuator_force[:nu]
        new = _pairs(model, data) - limits.touching if limits.looks else frozenset()
        if new:
            a, b = min(new)
            return force, f"{_called(model, a)} and {_called(model, b)}"
    return force, ""


def _touching(model: mujoco.MjModel, qpos: np.ndarray) -> frozenset[tuple[int, int]]:
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    with quiet():
        mujoco.mj_fwdPosition(model, data)
    return _pairs(model, data)


def _pairs(model: mujoco.MjModel, data: mujoco.MjData) -> frozenset[tuple[int, int]]:
    """Returns the bodies that touch."""
    found = set()
    for contact in data.contact:
        if not contact.exclude and contact.dist < contact.includemargin and min(contact.geom) >= 0:
            a, b = sorted(int(model.geom_bodyid[g]) for g in contact.geom)
            found.add((a, b))
    return frozenset(found)


def _called(model: mujoco.MjModel, body: int) -> str:
    return "the world" if not body else model.body(body).name or f"body {body}"


def _limit(
    what: str, name: str, own: np.ndarray | None, seen: np.ndarray | None, widen: float
) -> Limit | None:
    if own is not None:
        return Limit(what, name, float(own[0]), float(own[1]), "model")
    if seen is None or (what != "input" and not seen[1] > seen[0]):
        return None
    more = widen * max(0.0, float(seen[1] - seen[0]))
    return Limit(what, name, float(seen[0]) - more, float(seen[1]) + more, "logs")


def _force_range(model: mujoco.MjModel, i: int) -> np.ndarray | None:
    """Returns the range of an actuator's force, that of its joint included; None without one."""
    ranges = []
    if model.actuator_forcelimited[i]:
        ranges.append(np.array(model.actuator_forcerange[i]))
    j, gear = int(model.actuator_trnid[i, 0]), float(model.actuator_gear[i, 0])
    if model.actuator_trntype[i] == mujoco.mjtTrn.mjTRN_JOINT and model.jnt_actfrclimited[j]:
        ranges.append(np.sort(model.jnt_actfrcrange[j] / gear))
    if not ranges:
        return None
    return np.array([max(r[0] for r in ranges), min(r[1] for r in ranges)])


def _measured(model: mujoco.MjModel, logs: Sequence[Log]) -> dict[int, np.ndarray]:
    """Returns the range of the measured position of each joint."""
    found: dict[int, np.ndarray] = {}
    for log in logs:
        for k, (field, i) in enumerate(output_columns(model, log.output_names)):
            if field == "qpos":
                y = log.outputs[:, k]
                j = int(np.flatnonzero(model.jnt_qposadr == i)[0])
                low, high = found.get(j, (np.inf, -np.inf))
                found[j] = np.array([min(low, y.min()), max(high, y.max())])
    return found
