"""Magnitudes of the joints whose effects are sought, which make a size plausible.

    F = max |force of its drives|       V = max |q̇|       L = max q - min q      over a log

A size that would make a force of F at a speed V, or over a way L, is as large as physics admits;
the catalogue counts in shares of it. A drive that pulls at a tendon acts on the joints over which
this runs. Where a joint has no drive, F = M V²/L is what its inertia needs.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import mujoco
import numpy as np

from identification.effects.servo_error import commands_of, position_servo
from identification.errors import InputError
from identification.logs.log import Log
from identification.logs.names import listed
from identification.logs.noise import noise_floor
from identification.logs.plausible import refuse_frozen
from identification.model.hostile import HUGE
from identification.model.predictor import output_columns
from identification.model.rollout import UNLOGGED, logged_inputs
from identification.model.tied import is_filtered
from identification.runtime.engine import quiet

Kind = Literal["hinge", "slide"]
OVERRULE = ', or write trust = ["sensors"] into the robot\'s file'
MAGNITUDES = ("force", "speed", "travel")
POSES = 5  # random ones, to see on which joints gravity acts
PULLED = 500  # samples of a log at which drives that pull at tendons are asked
NOISE, SHARE = 5.0, 0.1  # a difference of noise, in its std, may be so much of the largest

_KINDS: dict[int, Kind] = {
    int(mujoco.mjtJoint.mjJNT_HINGE): "hinge",
    int(mujoco.mjtJoint.mjJNT_SLIDE): "slide",
}


@dataclass(frozen=True)
class Axis:
    """A hinge or slide joint.

    Attributes:
        joint: its name.
        kind: "hinge" or "slide".
        force: largest force of its drives [N m or N].
        speed: top speed [rad/s or m/s].
        travel: how far it moves [rad or m].
        plain: whether it has drives of its own, and their force is gain·u + bias: its load is then
            known; u is the input or what a filter makes of it. A tendon that pulls is no drive of
            its own.
        heavy: whether gravity acts on it anywhere.
        tilts: whether gravity's force on it changes with the pose; where it is constant, a friction
            that grows with it is a Coulomb friction.
        duration: of the record [s]; 0 where it is not known.
        middle: of the way that it moves [rad or m].
        share: of its inertia that its model gives to the motor, as armature; 0 where there is none.
        give: compliance on which its inertia swings once in 2π steps of the simulation: a stiffer
            one is not resolved [rad/(N m) or m/N].
        servo: its position servo, "" where it has none or several.
        gear: of this servo, by which it multiplies the position that it compares with its setpoint.
        stiffness: of this servo at the joint, 0 where there is none [N m/rad or N/m].

    Raises:
        InputError: a magnitude is not positive, or is one that no robot has.
    """

    joint: str
    kind: Kind
    force: float
    speed: float
    travel: float
    plain: bool = True
    heavy: bool = False
    duration: float = 0.0
    middle: float = 0.0
    share: float = 0.0
    give: float = 0.0
    servo: str = ""
    gear: float = 1.0
    stiffness: float = 0.0
    tilts: bool = True

    def __post_init__(self) -> None:
        for word in MAGNITUDES:
            value = getattr(self, word)
            if not 1 / HUGE <= value <= HUGE:  # their squares and cubes are numbers too
                raise InputError(
                    f"joint {self.joint!r} has {word} {value:g}; give one between {1 / HUGE:g} and"
                    f" {HUGE:g}"
                )


def axes(model: mujoco.MjModel, log: Log, trust: Sequence[str] = ()) -> tuple[Axis, ...]:
    """Returns the joints whose motion a log shows, in the model's order.

    Args:
        model: with the log's sensors.
        log: its inputs are those of the model's actuators.
        trust: with "sensors" in it, an output that repeats one value is not frozen.

    Raises:
        InputError: an output is no sensor of a joint, never changes, freezes, or is huge.
    """
    _refuse_useless(log)
    seen: dict[int, dict[str, int]] = {}
    for k, (field, i) in enumerate(output_columns(model, log.output_names)):
        at = model.jnt_qposadr if field == "qpos" else model.jnt_dofadr
        seen.setdefault(int(np.flatnonzero(at == i)[0]), {})[field] = k
    for j, column in seen.items():
        inputs = [_control(model, i) for i in drives_of(model, j)] or [*range(logged_inputs(model))]
        for field, k in column.items():
            others = [i for i in column.values() if i != k]
            if "sensors" not in trust:
                refuse_frozen(log, k, log.inputs[:, inputs], log.outputs[:, others], OVERRULE,
                              is_rate=field != "qpos")  # fmt: skip
    return tuple(
        _axis(model, log, j, {field: log.outputs[:, k] for field, k in seen[j].items()})
        for j in sorted(seen)
    )


def reach(each: Sequence[Sequence[Axis]]) -> tuple[Axis, ...]:
    """Returns the joints of several logs, each with the largest force, speed and way of all."""
    found: dict[str, Axis] = {}
    for axis in (axis for known in each for axis in known):
        old = found.get(axis.joint, axis)
        words = ("force", "speed", "duration")
        most = {word: max(getattr(old, word), getattr(axis, word)) for word in words}
        low = min(a.middle - a.travel / 2 for a in (old, axis))
        high = max(a.middle + a.travel / 2 for a in (old, axis))
        found[axis.joint] = replace(
            axis, **most, travel=high - low, middle=(low + high) / 2
        )  # fmt: skip
    return tuple(found.values())


def _refuse_useless(log: Log) -> None:
    """Refuse columns of which no magnitude can be made."""
    columns = dict(zip(log.output_names, log.outputs.T, strict=True))
    still = [name for name, column in columns.items() if not np.ptp(column)]
    if still:
        raise InputError(
            f"{listed(still)} of log {log.name!r} never change{'s' * (len(still) == 1)}: a dead"
            " sensor, or a joint that does not move; take a log in which it moves, or leave it out"
        )
    columns |= zip(log.input_names, log.inputs.T, strict=True)
    huge = [name for name, column in columns.items() if np.abs(column).max() > HUGE]
    if huge:
        raise InputError(
            f"{listed(huge)} of log {log.name!r} goes beyond {HUGE:g}, which no robot does; repair"
            " or cut the log there"
        )


def _axis(model: mujoco.MjModel, log: Log, j: int, columns: dict[str, np.ndarray]) -> Axis:
    h = log.sampling_time
    way = columns["qpos"] if "qpos" in columns else np.cumsum(columns["qvel"]) * h
    rates = columns["qvel"] if "qvel" in columns else _rate(way, h)
    speed, travel = float(np.abs(rates).max()), float(np.ptp(way))
    drives = drives_of(model, j)
    v = columns["qvel"] if "qvel" in columns else np.gradient(way, h)
    force = sum(float(np.abs(_forces(model, i, log.inputs, h, way, v)).max()) for i in drives)
    dof = int(model.jnt_dofadr[j])
    if not drives:
        force = _pulled(model, log, dof)
    if not force and travel > 0:
        force = float(model.dof_M0[dof]) * speed**2 / travel
    name, is_plain = model.joint(j).name, bool(drives) and all(_plain(model, i) for i in drives)
    is_heavy, tilts = _weight(model, j)
    return Axis(name, _KINDS[int(model.jnt_type[j])], force, speed, travel,
                is_plain, is_heavy,
                log.begun + log.duration, float(way.min() + way.max()) / 2,
                float(model.dof_armature[dof] * model.dof_invweight0[dof]),
                float(model.opt.timestep**2 * model.dof_invweight0[dof]),
                *position_servo(model, drives if is_plain else ()), tilts=tilts)  # fmt: skip


@quiet()
def _weight(model: mujoco.MjModel, j: int) -> tuple[bool, bool]:
    """Returns whether gravity acts on joint j in one of several poses, and whether it changes."""
    data, rng = mujoco.MjData(model), np.random.default_rng(0)
    dof, forces = int(model.jnt_dofadr[j]), []
    for _ in range(POSES):
        mujoco.mj_integratePos(model, data.qpos, rng.normal(0, 1, model.nv), 1.0)
        mujoco.mj_forward(model, data)  # at rest: all of the bias is gravity
        forces.append(float(data.qfrc_bias[dof]))
    least = 1e-9 * float(np.linalg.norm(model.opt.gravity) * model.body_mass.sum())
    return bool(np.abs(forces).max() > least), bool(np.ptp(forces) > least)


def _rate(way: np.ndarray, h: float) -> np.ndarray:
    """Returns the rates over the shortest lag at which noise does not determine the largest."""
    noise, lag = float(noise_floor(way[:, None])[0]), 1
    while True:
        rate = (way[lag:] - way[:-lag]) / (lag * h)
        if NOISE * noise < SHARE * lag * h * np.abs(rate).max() or 8 * lag > len(way):
            return rate
        lag *= 2


def drives_of(model: mujoco.MjModel, j: int) -> list[int]:
    """Returns the actuators that act on joint j."""
    at = int(mujoco.mjtTrn.mjTRN_JOINT)
    return [i for i in range(len(model.actuator_trntype))
            if model.actuator_trntype[i] == at and model.actuator_trnid[i, 0] == j
            and not model.actuator(i).name.startswith(UNLOGGED)]  # fmt: skip


def _control(model: mujoco.MjModel, i: int) -> int:
    return int(model.actuator_ctrladr[i])


def _forces(
    model: mujoco.MjModel, i: int, inputs: np.ndarray, h: float, q: np.ndarray, v: np.ndarray
) -> np.ndarray:
    """Returns the forces of actuator i on its joint, shape (N,): γ (k u + b_0 + b_1 γ q + b_2 γ v).

    A servo's are far smaller than its command alone would make.
    """
    gear, gain = float(model.actuator_gear[i, 0]), float(model.actuator_gainprm[i, 0])
    is_biased = int(model.actuator_biastype[i]) == int(mujoco.mjtBias.mjBIAS_AFFINE)
    b_0, b_1, b_2 = model.actuator_biasprm[i, :3] if is_biased else np.zeros(3)
    u = commands_of(model, i, inputs, h)
    return np.asarray(gear * (gain * u + b_0 + b_1 * gear * q + b_2 * gear * v))


@quiet()
def _pulled(model: mujoco.MjModel, log: Log, dof: int) -> float:
    """Returns the largest force of drives at tendons along a log on a degree of freedom."""
    if not np.any(model.actuator_trntype == int(mujoco.mjtTrn.mjTRN_TENDON)):
        return 0.0
    data, columns, largest = mujoco.MjData(model), output_columns(model, log.output_names), 0.0
    controls = [
        _control(model, i) for i in range(len(model.actuator_trntype))
        if not model.actuator(i).name.startswith(UNLOGGED)
    ]  # fmt: skip
    for k in np.unique(np.linspace(0, len(log) - 1, PULLED).round().astype(int)):
        for (field, i), y in zip(columns, log.outputs[k], strict=True):
            getattr(data, field)[i] = y
        data.ctrl[controls] = log.inputs[k]
        mujoco.mj_forward(model, data)
        largest = max(largest, abs(float(data.qfrc_actuator[dof])))
    return largest


def _plain(model: mujoco.MjModel, i: int) -> bool:
    """Returns whether the force of actuator i is gain·u + bias, u its input or that, filtered."""
    biases = (mujoco.mjtBias.mjBIAS_NONE, mujoco.mjtBias.mjBIAS_AFFINE)
    is_direct = int(model.actuator_dyntype[i]) == int(mujoco.mjtDyn.mjDYN_NONE)
    return (
        (is_direct or (is_filtered(model, i) and not model.actuator_actearly[i]))
        and int(model.actuator_gaintype[i]) == int(mujoco.mjtGain.mjGAIN_FIXED)
        and int(model.actuator_biastype[i]) in (int(b) for b in biases)
    )
