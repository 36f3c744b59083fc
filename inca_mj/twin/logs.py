"""Logs of the INCA 6D: eight currents in, eight motor angles out, at 100 Hz in the thesis."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from identification import InputError, Log, read_log
from identification.logs.cures import unit_lines
from identification.logs.noise import noise_floor
from identification.refusals.trust import TRUST
from inca_mj.robot.geometry import each_drive
from inca_mj.robot.parameters import POSE as POSE
from inca_mj.twin.run import Run

JUDGED = {word: TRUST[word] for word in ("sensors", "units", "wiring")}  # a user may overrule
UNJUDGED = (*JUDGED,)  # for who draws a log as it is


def overruled_by(*words: str) -> str:
    """Returns how the user overrules judgements, for the end of their message."""
    known = " and that ".join(JUDGED[word] for word in words)
    return f"; if you know that {known}, write --trust {' '.join(words)}"


CURRENTS, ANGLES = each_drive("current"), each_drive("angle")
VELOCITY = ("vx", "vy", "vz", "wx", "wy", "wz")  # v in O, body rates
OPTIONAL = (
    *POSE, *each_drive("tension"), *VELOCITY, *each_drive("rate"), *each_drive("no_load_length"),
)  # fmt: skip

UNITS = {
    "current": "A", "angle": "rad", "rate": "rad/s", "tension": "N", "no_load_length": "m",
    **dict.fromkeys(("x", "y", "z"), "m"), **dict.fromkeys(("roll", "pitch", "yaw"), "rad"),
    **dict.fromkeys(("vx", "vy", "vz"), "m/s"), **dict.fromkeys(("wx", "wy", "wz"), "rad/s"),
}  # fmt: skip

# A larger number must be in another unit: 20 A is ten times what the motors can bear; 400 rad are
# 7 m of cable in a frame of 3 m; at 300 rad/s a cable moves at 5 m/s, faster than a hand.
LIMITS = {"current": 20.0, "angle": 400.0, "x": 3.0, "y": 3.0, "z": 4.0, "tension": 1000.0}
RATES = {"angle": 300.0}

SLOWEST = 0.5  # a larger sampling time means that time is in milliseconds [s]

NOISE = 6.0  # std that the noise of one sample may be
ZERO = 0.05  # a log begins at φ = 0; 0.05 rad is 0.9 mm of cable, 30 counts of an encoder [rad]


def read_inca_log(path: str | Path, trust: Sequence[str] | None = None) -> Log:
    """Read a log of the robot: CSV with a TOML beside it, or MATLAB (`u`, `y`, `Ts`).

    Args:
        path: of the log.
        trust: checks of the log that you overrule, words of `inca_mj.twin.logs.JUDGED`: with
            "units" in it, numbers may be as large as they are. None where a caller asks nobody.

    Raises:
        InputError: the file cannot be a log of this robot (see `identification.read_log`), or does
            not begin at zero angles.
    """
    judged, asked = "units" not in (trust or ()), trust is not None
    log = read_log(
        path, CURRENTS, ANGLES, OPTIONAL, units=UNITS, limits=LIMITS if judged else None,
        rates=RATES if judged else None, overrule=overruled_by("units") if asked else "",
    )  # fmt: skip
    if log.sampling_time > SLOWEST:
        raise InputError(
            f"{path} has a sample every {log.sampling_time:g} s, too few for a robot that moves;"
            " time must be in seconds: is it in milliseconds?"
        )
    if not np.ptp(log.outputs, axis=0).any():
        raise InputError(f"nothing moves in {path}: all eight angles are constant")
    worst = int(np.abs(log.outputs[0]).argmax())
    first = float(log.outputs[0, worst])
    if abs(first) > ZERO:
        noise = float(noise_floor(log.outputs)[worst])
        raise InputError(
            f"{path} begins at {ANGLES[worst]} = {first:.3g} rad, but a log begins at rest with all"
            f" angles zero; {_how_to_begin_at_zero(first, noise)}"
        )
    return log


def _how_to_begin_at_zero(first: float, noise: float) -> str:
    """Returns the cure for a log with this first angle and std of noise [rad]."""
    if abs(first) > NOISE * noise:
        return "cut it where the robot rests and subtract its angles"
    return (
        f"the noise of this angle is {noise:.2g} rad, far more than an encoder makes, so that the"
        f" file is likely not in radians: {unit_lines({'angle': 'deg'})} if its angles are in"
        " degrees, and else the unit that they are in"
    )


def pose_of(log: Log) -> np.ndarray | None:
    """Returns the measured pose x, y, z [m], roll, pitch, yaw [rad], shape (N, 6), if logged."""
    if not all(name in log.extras for name in POSE):
        return None
    return np.stack([log.extras[name] for name in POSE], axis=1)


def run_to_log(run: Run, name: str = "run", notes: str = "") -> Log:
    """Returns a run as a log; pose, velocities, tensions, no-load lengths are optional columns.

    Args:
        run: the result of `simulate`.
        name: what to call the log in a report.
        notes: remarks about it.
    """
    extras = {
        **dict(zip(POSE, np.hstack([run.position, run.angles]).T, strict=True)),
        **dict(zip(each_drive("tension"), run.tension.T, strict=True)),
        **dict(zip(VELOCITY, run.qvel[:, :6].T, strict=True)),
        **dict(zip(each_drive("rate"), run.motor_rate.T, strict=True)),
        **dict(zip(each_drive("no_load_length"), run.act.T, strict=True)),
    }
    columns = (*CURRENTS, *ANGLES, *extras)
    units = {column: UNITS[column.rstrip("_12345678")] for column in columns}
    return Log(
        time=run.time, inputs=run.currents, outputs=run.motor_angle, input_names=CURRENTS,
        output_names=ANGLES, extras=extras, units=units, name=name, notes=notes,
    )  # fmt: skip
