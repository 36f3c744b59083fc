"""Have columns of one joint one unit: its position, its rate, and what its drive wants of it?

    q(t_k+1) - q(t_k) = b ∫ v dt + c        over equal pieces of the log; v is measured or wanted
    q(t + τ) = b u(t)/g + c                 u is the wanted position, g the gear

b and c are least squares, c is an offset, and τ is how much later a servo follows. No model is
asked: whatever the robot is, b of a measured rate is 1, and a joint that goes with a wanted motion
goes neither ten times as far nor a tenth. Degrees in one of the two columns make b 57 or 1/57,
revolutions 6.3, rpm 1/9.5.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import mujoco
import numpy as np

from identification.logs.log import Log
from identification.logs.units import UNITS
from identification.model.predictor import output_columns
from identification.storage.files import toml_key

SERVO = {"qpos": ("m", "rad"), "qvel": ("m/s", "rad/s")}  # of a wanted motion: slide, hinge
PIECES = 20  # of a log
CERTAIN = 0.95  # share of the variance that the line explains
NEAR = 1.25  # factor from 1 that b may be once the unit is right; rpm is 1.5 from 1/2π
LATEST, LAGS = 0.2, 21  # how much later a servo follows at most [s], and lags that are tried
WANTED = 10.0  # factor from 1 that b may be of a drive that is weak, or of a joint that resounds


@dataclass(frozen=True)
class Pair:
    """Two columns of one joint."""

    q: str  # output that is the position
    other: str  # output or input that is a rate or a wanted motion
    unit: str  # SI unit of the other one
    slope: float  # b, without unit; NaN where the line does not explain the position
    free: float  # factor from 1 that b may be


def different_units(model: mujoco.MjModel, log: Log, column: Mapping[str, str]) -> str | None:
    """Returns which column has another unit than it says, and the cure; None where none has."""
    for pair in _pairs(model, log):
        b = pair.slope
        if np.isnan(b) or 1 / pair.free < b < pair.free:
            continue
        of_q = log.units.get(pair.q, "")
        for name, unit, power in ((pair.other, pair.unit, -1), (pair.q, of_q, 1)):
            for word, (of, factor) in UNITS.items():
                if of == unit and 1 / NEAR < b * factor**power < NEAR:
                    return (
                        f"{column[pair.q]} moves {b:.3g} times as far as {column[pair.other]}"
                        f' says; write {toml_key(column[name])} = "{word}" under [units] of the'
                        " log's TOML"
                    )
    return None


def wanted_units(model: mujoco.MjModel, log: Log) -> dict[str, str]:
    """Returns SI units of the inputs that drives compare with their joint's own motion, by name."""
    found = {}
    for i, name in enumerate(log.input_names):
        gain, bias = float(model.actuator_gainprm[i, 0]), model.actuator_biasprm[i]
        is_joint = model.actuator_trntype[i] == int(mujoco.mjtTrn.mjTRN_JOINT)
        is_affine = model.actuator_biastype[i] == int(mujoco.mjtBias.mjBIAS_AFFINE)
        if not (is_joint and is_affine and gain > 0):
            continue
        kind = int(model.jnt_type[model.actuator_trnid[i, 0]])
        place = (int(mujoco.mjtJoint.mjJNT_SLIDE), int(mujoco.mjtJoint.mjJNT_HINGE))
        if kind in place and -gain in (bias[1], bias[2]):
            found[name] = SERVO["qpos" if bias[1] == -gain else "qvel"][place.index(kind)]
    return found


def drive_units(model: mujoco.MjModel, log: Log) -> dict[str, str]:
    """Returns SI units of the inputs that drives turn into forces of joints, by name.

    Where the log does not say it, a gear of one is that of a force, and another that of a current.
    """
    found, wanted = {}, wanted_units(model, log)
    for i, name in enumerate(log.input_names):
        if name in wanted or model.actuator_trntype[i] != int(mujoco.mjtTrn.mjTRN_JOINT):
            continue
        is_slide = model.jnt_type[model.actuator_trnid[i, 0]] == int(mujoco.mjtJoint.mjJNT_SLIDE)
        force = "N" if is_slide else "N m"
        found[name] = log.units.get(name) or (force if model.actuator_gear[i, 0] == 1 else "A")
    return found


def _pairs(model: mujoco.MjModel, log: Log) -> Iterator[Pair]:
    """Yields positions with the measured rates, and with what drives want, of hinges and slides."""
    places = dict(zip(output_columns(model, log.output_names), log.output_names, strict=True))
    scalar = (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE))
    wanted = wanted_units(model, log)
    for joint in range(model.njnt):
        q = places.get(("qpos", int(model.jnt_qposadr[joint])))
        if q is None or model.jnt_type[joint] not in scalar:
            continue
        y = log.outputs[:, log.output_names.index(q)]
        v = places.get(("qvel", int(model.jnt_dofadr[joint])))
        if v is not None:
            rate = log.outputs[:, log.output_names.index(v)]
            yield Pair(q, v, log.units.get(v, ""), _of_rate(log, y, rate), NEAR)
        for i, name in enumerate(log.input_names):
            if name in wanted and model.actuator_trnid[i, 0] == joint:
                u = log.inputs[:, i] / (model.actuator_gear[i, 0] or 1.0)
                is_rate = wanted[name].endswith("/s")
                slope = _of_rate(log, y, u) if is_rate else _followed(log, u, y)
                yield Pair(q, name, wanted[name], slope, WANTED)


def _of_rate(log: Log, y: np.ndarray, v: np.ndarray) -> float:
    """Returns b of a position and a rate, shape (n,) each."""
    edges = np.linspace(0, len(y) - 1, min(PIECES, len(y) // 2) + 1).round().astype(int)
    means = (v[1:] + v[:-1]) / 2
    summed = np.concatenate([[0.0], np.cumsum(means * log.sampling_time)])
    return _slope(np.diff(summed[edges]), np.diff(y[edges]))


def _followed(log: Log, u: np.ndarray, y: np.ndarray) -> float:
    """Returns b of a wanted position and the position, shape (n,) each, at the best lag."""
    _, lag = best_lag(log, u, y)
    return _slope(u[: len(u) - lag], y[lag:])


def best_lag(log: Log, u: np.ndarray, y: np.ndarray) -> tuple[float, int]:
    """Returns the largest correlation of y (n,) with u (n,), and by how many samples y is late.

    Zeros where one of them stands still.
    """
    most = min(round(LATEST / log.sampling_time), len(y) // 4)
    lags = np.unique(np.linspace(0, most, LAGS).round().astype(int)).tolist()
    each = [(u[: len(u) - lag], y[lag:]) for lag in lags]
    if any(part.std() == 0 for pair in each for part in pair):
        return 0.0, 0
    return max((float(np.corrcoef(*pair)[0, 1]), lag) for pair, lag in zip(each, lags, strict=True))


def _slope(x: np.ndarray, y: np.ndarray) -> float:
    """Returns b of y = b x + c; NaN where the line does not explain y."""
    if len(x) < 3 or x.std() == 0 or y.std() == 0:
        return np.nan
    correlation = float(np.corrcoef(x, y)[0, 1])
    is_certain = correlation > 0 and correlation**2 > CERTAIN
    return correlation * float(y.std() / x.std()) if is_certain else np.nan
