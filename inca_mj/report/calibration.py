"""The results of a calibration: sentences, tables, and plain values for JSON."""

from __future__ import annotations

from typing import Any

import numpy as np

from identification.chances import normal_level
from identification.quantities import alike, matched, quantity
from identification.report.words.values import describe_parameter
from inca_mj.robot.geometry import DRIVES
from inca_mj.robot.spread import AXES, EACH_DRIVE, POINTS
from inca_mj.twin.logs import POSE
from inca_mj.workflows.calibration import Calibration
from inca_mj.workflows.spread import INERTIAS

TOLD = 0.8  # a group whose deviations keep more than this share of their prior std is not told
ALIKE = 0.1  # parts that scatter less than this share of what is usual are alike
MOST = 3  # values far from usual that are told in words
RARE = 0.01  # share of usual robots that have one or more values told as far from usual


def calibration_verdict(found: Calibration) -> list[str]:
    """Returns what the calibration means, in sentences."""
    n, length = len(found.logs), sum(log.duration for log in found.logs)
    records = "one record" if n == 1 else f"{n} records"
    before, after = (
        float(np.sqrt(np.mean([getattr(gap, when) ** 2 for gap in found.unseen])))
        for when in ("before", "after")
    )
    was, now = alike([before, after], "rad")
    lines = [
        f"Calibrated from {records}, {length:.0f} s in all. Free runs over unseen samples are off"
        f" by {now} rms; with all drives alike and all points as drawn it was {was}."
    ]
    if after >= before:
        lines.append(
            "The calibration predicts no better than drives that are alike and points as drawn: do"
            " not use it. Record longer, or with inputs that move the platform farther."
        )
    usual = {**found.spread.drives, **found.spread.points}
    same = [_kind(found, g) for g, s in found.scatter.items() if s < ALIKE * usual[g]]
    if same:
        lines.append(f"All parts are alike in: {', '.join(same)}.")
    unknown = untold(found)
    if unknown:
        lines.append(
            "The records do not tell the single deviations of: "
            + ", ".join(_kind(found, g) for g in unknown)
            + ". What is said of them is the common value, with the scatter of all parts as std."
        )
    far = unusual(found)
    if far:
        told = []
        for group, name, times in far[:MOST]:
            column, _, number = name.partition("@")
            if group in found.spread.points:
                size = f"{POINTS[group]} {number}, {column[-1]} {_scaled(found, name, 1e3)} mm"
            else:
                kind = _kind(found, group)
                size = f"drive {number}, {kind} {_scaled(found, name, 100)} %"
            told.append(f"{size} ({times:.2g} times)")
        lines.append(
            f"Far from what is usual: {'; '.join(told)}"
            + (f"; and {len(far) - MOST} more" if len(far) > MOST else "")
            + ". So large a difference is a fault of this part or of a sensor, or it stands for an"
            " effect that the twin lacks: run inca discover on the same logs."
        )
    if "exit" in found.spread.points:
        relative, together = exit_std(found)
        lines.append(
            f"Exit points are known to {1e3 * relative:.2g} mm rms relative to one another, and to"
            f" {1e3 * together:.2g} mm rms in the frame: no angle of a motor tells where the frame"
            " as a whole stands."
        )
    return lines


def untold(found: Calibration) -> tuple[str, ...]:
    """Returns groups of which the records do not tell the single deviations."""
    out = []
    for group, names in found.spread.groups.items():
        rest = np.mean([found.std[name] ** 2 for name in names]) / found.scatter[group] ** 2
        usual = {**found.spread.drives, **found.spread.points}[group]
        if rest > TOLD**2 and found.scatter[group] >= ALIKE * usual:
            out.append(group)
    return tuple(out)


def unusual(found: Calibration) -> tuple[tuple[str, str, float], ...]:
    """Returns values farther from the others than usual parts ever are, the farthest first.

    Each has its group, its name, and how many times the usual std it is. A robot whose parts
    scatter as usual has any such value with a probability of `RARE` at most.
    """
    usual = {**found.spread.drives, **found.spread.points}
    every = [(g, name) for g, names in found.spread.groups.items() for name in names]
    most = normal_level(RARE / 2 / max(1, len(every)))
    times = [(g, name, abs(found.values[name]) / usual[g]) for g, name in every]
    return tuple(sorted((t for t in times if t[2] > most), key=lambda t: -t[2]))


def _kind(found: Calibration, group: str) -> str:
    """Returns the kind of a group's deviations, in words."""
    return f"{POINTS[group]}s" if group in POINTS else found.robot.parameters[group].short


def exit_std(found: Calibration) -> tuple[float, float]:
    """Returns the rms std of exits without turns and shifts of all of them, and with these [m]."""
    names = [f"exit_{axis}@{k}" for k in range(1, DRIVES + 1) for axis in AXES]
    at = [found.fit.point.space.names.index(name) for name in names]
    C = found.covariance[np.ix_(at, at)]
    places = found.robot.geometry.A
    turns = [np.cross(axis, places - places.mean(axis=0)).ravel() for axis in np.eye(3)]
    shifts = [np.tile(axis, DRIVES) for axis in np.eye(3)]
    Q = np.linalg.qr(np.array([*shifts, *turns]).T)[0]
    P = np.eye(len(names)) - Q @ Q.T
    return float(np.sqrt(np.trace(P @ C @ P) / len(C))), float(np.sqrt(np.trace(C) / len(C)))


def _common(found: Calibration) -> list[str]:
    """Returns the names of the fitted values that all drives have in common."""
    return [n for n in (*EACH_DRIVE, "m", *INERTIAS, *POSE) if n in found.std]


def common_rows(found: Calibration) -> list[tuple[str, str, str]]:
    """Returns rows of common values: what it is, nominal value, value with std."""
    parameters, nominal = found.robot.parameters, found.fit.point.predictor.plant.parameters
    return [
        (describe_parameter(nominal[n]), quantity(nominal[n].value, 0.0, nominal[n].unit),
         quantity(parameters[n].value, found.std[n], parameters[n].unit))
        for n in _common(found)
    ]  # fmt: skip


def drive_rows(found: Calibration) -> list[tuple[str, ...]]:
    """Returns rows of deviations: the parameter, then its deviation at each drive [%]."""
    parameters, every = found.robot.parameters, range(1, DRIVES + 1)
    return [
        (describe_parameter(parameters[name]), *(_scaled(found, f"{name}@{k}", 100) for k in every))
        for name in found.spread.drives
    ]


def point_rows(found: Calibration) -> list[tuple[str, ...]]:
    """Returns rows of displacements: the point, then x, y, z [mm]."""
    return [
        (f"{point} {k}", *(_scaled(found, f"{point}_{axis}@{k}", 1e3) for axis in AXES))
        for point in POINTS
        if point in found.spread.points
        for k in range(1, DRIVES + 1)
    ]


def gap_rows(found: Calibration) -> list[tuple[str, ...]]:
    """Returns rows of records: name, role, and the gap on unseen samples before and after."""
    texts = alike([rms for g in found.unseen for rms in (g.before, g.after)], "rad")
    pairs = zip(texts[::2], texts[1::2], strict=True)
    return [(g.name, g.role, *pair) for g, pair in zip(found.unseen, pairs, strict=True)]


def calibration_json(found: Calibration) -> dict[str, Any]:
    """Returns the calibration as plain values."""
    parameters, values, std = found.robot.parameters, found.values, found.std
    places = range(1, DRIVES + 1)

    def row(name: str, unit: str) -> dict[str, Any]:
        return {"value": values[name], "std": std[name], "unit": unit}

    return {
        "verdict": calibration_verdict(found),
        "parameters": {n: row(n, parameters[n].unit) for n in _common(found)},
        "drives": {n: [row(f"{n}@{k}", "") for k in places] for n in found.spread.drives},
        "points": {f"{p}_{a}": [row(f"{p}_{a}@{k}", "m") for k in places]
                   for p in found.spread.points for a in AXES},
        "scatter": dict(found.scatter),
        "not_told": list(untold(found)),
        "unusual": [{"name": name, "times": times} for _, name, times in unusual(found)],
        "exits": found.robot.geometry.A.tolist(),
        "connectors": found.robot.geometry.B.tolist(),
        "records": [vars(gap) for gap in found.unseen],
        "noise_rms": found.fit.level.sigma,
        "input_error_rms": found.fit.level.input_std,
        "seconds": found.seconds,
    }  # fmt: skip


def _scaled(found: Calibration, name: str, factor: float) -> str:
    """Returns a value with its std in percent (a factor of 100) or in millimetres (1000)."""
    return " ± ".join(matched(factor * found.values[name], factor * found.std[name], "+"))
