"""Joints that a log has far outside the limits of the model.

A simulation pushes such a joint back with all its force, and diverges. The usual cause is a range
in radians in a file whose angles are degrees, as MuJoCo reads them unless the file says otherwise.
A limit is soft: a right log goes a little beyond it.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import mujoco
import numpy as np

from identification.errors import InputError
from identification.logs.cures import how_to_turn
from identification.logs.log import Log
from identification.model.predictor import output_columns, output_dofs
from identification.quantities import alike
from identification.refusals.far_angles import COUNTS, FAR_ANGLE, far_sentence
from identification.refusals.same_units import wanted_units
from identification.refusals.trust import RobotFile

_HINGE = int(mujoco.mjtJoint.mjJNT_HINGE)
FAR = 1.0  # of its range's width: a soft limit gives way by less
MOST, SOFT = 0.5, 0.05  # share of samples outside a range, by this share of it, and mirrored none
SHARE = 0.05  # of the samples that are so far outside; fewer are wrong readings
# A reading beyond it [rad, m] that lies within the range as degrees, counts or millimetres has a
# wrong unit, which other checks say first.
LARGE = {_HINGE: (FAR_ANGLE, (np.pi / 180, *(2 * np.pi / n for n in COUNTS))),
         int(mujoco.mjtJoint.mjJNT_SLIDE): (10.0, (1e-3,))}  # fmt: skip
OFF = int(mujoco.mjtDisableBit.mjDSBL_LIMIT) | int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)


def refuse_limits(
    file: RobotFile, model: mujoco.MjModel, is_degree: bool, log: Log, whatever: bool = False
) -> None:
    """Refuse a log that has a joint far outside the limits of the model, if nobody trusts it.

    The file of the model gives angles in degrees where `is_degree`. A log that may have another
    unit is left to the checks of units, or refused too, `whatever` it may have.
    """
    if "limits" in file.trust:
        return
    _refuse_mirrored(file, model, log)
    names = log.output_names
    each = zip(output_columns(model, names), output_dofs(model, names), log.outputs.T, strict=True)
    positions = {
        model.joint(int(model.dof_jntid[dof])).name: y
        for (field, _), dof, y in each
        if field == "qpos"
    }
    if said := limit_sentence(model, is_degree, positions, file.model, whatever):
        unit = f"; {far_sentence(model, log, file.columns)}" if whatever else ""
        raise InputError(
            f"log {log.name!r} does not belong to the model: {said}{unit}, or write trust ="
            f' ["limits"] into {file.path} if all is right'
        )


def _refuse_mirrored(file: RobotFile, model: mujoco.MjModel, log: Log) -> None:
    """Refuse a log most of which lies outside the range of a joint, and with another sign in it."""
    if model.opt.disableflags & OFF:
        return
    names = log.output_names
    each = zip(names, output_columns(model, names), output_dofs(model, names), log.outputs.T,
               strict=True)  # fmt: skip
    for name, (field, _), dof, q in each:
        joint = int(model.dof_jntid[dof])
        if field != "qpos" or not model.jnt_limited[joint]:
            continue
        low, high = model.jnt_range[joint].tolist()
        if _outside(q, low, high) < MOST or _outside(-q, low, high) > 0:
            continue
        wanted = wanted_units(model, log)
        driven = [
            n for i, n in enumerate(log.input_names)
            if n in wanted and model.actuator_trnid[i, 0] == joint
            and _outside(log.inputs[:, i] / (model.actuator_gear[i, 0] or 1.0), low, high) >= MOST
        ]  # fmt: skip
        told = alike([low, high, *np.quantile(q, [0.0, 1.0]).tolist()], log.units.get(name, ""))
        column = {n: file.columns.get(n, n) for n in log.columns}
        factors = {column[n]: f for n, f in log.factors.items() if n in column}
        cure = how_to_turn([column[n] for n in (name, *driven)], factors)
        raise InputError(
            f"log {log.name!r} does not belong to the model: joint {model.joint(joint).name} can"
            f" move from {told[0]} to {told[1]} in the model, was measured from {told[2]} to"
            f" {told[3]}, and would lie in its range with the other sign; {cure}, or correct its"
            f' range in {file.model.name}, or write trust = ["limits"] into {file.path}'
        )


def _outside(q: np.ndarray, low: float, high: float) -> float:
    """Returns the share of positions that lie outside a range by more than a soft limit gives."""
    return float(np.mean(np.maximum(low - q, q - high) > SOFT * (high - low)))


def limit_sentence(
    model: mujoco.MjModel, is_degree: bool, positions: Mapping[str, np.ndarray], path: Path,
    whatever: bool = False,
) -> str:  # fmt: skip
    """Returns what is wrong with the limits of a joint and how to mend it; "" where nothing is.

    Positions are given as measured, by joint, shape (n,) [rad or m], with the path of the model's
    file. What may have another unit is told too, `whatever` it may have.
    """
    if model.opt.disableflags & OFF:
        return ""
    for name, every in positions.items():
        q = every[np.isfinite(every)]
        joint = model.joint(name)
        (kind,) = joint.type.tolist()
        low, high = joint.range.tolist()
        if not joint.limited[0] or kind not in LARGE or not _is_far(q, low, high):
            continue
        large, factors = LARGE[kind]
        is_large = not whatever and np.max(np.abs(q)) > large
        if is_large and not all(_is_far(factor * q, low, high) for factor in factors):
            continue
        is_hinge = kind == _HINGE
        least, most = np.quantile(q, [0.0, 1.0]).tolist()
        told = alike([low, high, least, most], "rad" if is_hinge else "m")
        cure = f"correct its range in {path.name}, or the unit of its column"
        if is_hinge and is_degree:
            cure = (
                f"its range in {path.name} counts in degrees, as MuJoCo reads angles: write"
                ' <compiler angle="radian"/> there if all its angles are radians, or else correct'
                " the range"
            )
        return (
            f"joint {name} can move from {told[0]} to {told[1]} in the model, and was measured from"
            f" {told[2]} to {told[3]}; {cure}"
        )
    return ""


def _is_far(q: np.ndarray, low: float, high: float) -> bool:
    """Returns whether more than a few positions lie outside a range by more than its width."""
    outside = np.maximum(low - q, q - high)
    return bool(np.mean(outside > FAR * (high - low)) > SHARE)
