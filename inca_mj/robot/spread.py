"""Drives that differ and anchors that are not where the drawing has them.

    value at drive k     value (1 + δ_k)             δ_k: parameter `NAME@k`
    exit point A_k       A_k + (x, y, z)             parameters `exit_x@k`, `exit_y@k`, `exit_z@k`
    connector B_k        B_k + (x, y, z)             parameters `connector_x@k`, ...

All deviations are zero in the nominal robot. They are ordinary parameters, so that a fit may free
them; what is known of them before a fit is a `Spread`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np

from identification.model.parameter import Parameter, ParameterSet
from inca_mj.robot.geometry import DRIVES, Geometry
from inca_mj.robot.parameters import parameter_set

EACH_DRIVE = ("R", "R_s", "k_s", "lambda", "b", "J", "b_v", "b_c", "beta", "K_t")
POINTS = {"exit": "exit point", "connector": "connector"}
_LETTERS = {"exit": "A", "connector": "B"}
AXES = ("x", "y", "z")
FARTHEST = 0.3  # an anchor that is farther from its nominal place is another geometry [m]

DRIVE, POINT = "drive", "point"  # where a deviation goes, as `Parameter.where` says it


def deviations(names: tuple[str, ...] = EACH_DRIVE) -> Iterator[Parameter]:
    """Yields the relative deviation of each of some parameters at each drive."""
    common = parameter_set()
    for name in names:
        for k in range(1, DRIVES + 1):
            yield Parameter(
                name=f"{name}@{k}", value=0.0, unit="", where=DRIVE, lower=-0.9, upper=9.0,
                symbol=common[name].letter, source="nominal robot",
                about=f"{common[name].short}, drive {k}: relative deviation",
            )  # fmt: skip


def displacements() -> Iterator[Parameter]:
    """Yields the displacement of each exit point and connector along each axis."""
    for point, about in POINTS.items():
        for k in range(1, DRIVES + 1):
            for axis in AXES:
                yield Parameter(
                    name=f"{point}_{axis}@{k}", value=0.0, unit="m", where=POINT,
                    lower=-FARTHEST, upper=FARTHEST, symbol=_LETTERS[point],
                    about=f"{about}, cable {k}, along {axis}: displacement", source="nominal robot",
                )  # fmt: skip


def with_spread(parameters: ParameterSet) -> ParameterSet:
    """Returns the parameters with all deviations and displacements, zero where they are new."""
    known = {p.name for p in parameters}
    new = (p for p in (*deviations(), *displacements()) if p.name not in known)
    return replace(parameters, records=(*parameters.records, *new))


def at_drives(name: str, values: Mapping[str, float]) -> np.ndarray:
    """Returns a parameter at each drive, (8,), in its unit; unknown deviations are zero."""
    each = [values.get(f"{name}@{k}", 0.0) for k in range(1, DRIVES + 1)]
    return values[name] * (1 + np.array(each))


def displaced(geometry: Geometry, values: Mapping[str, float]) -> Geometry:
    """Returns the geometry with its points where the displacements put them; itself without any."""
    moves = {point: _moves(point, values) for point in POINTS}
    if not any(move.any() for move in moves.values()):
        return geometry
    return replace(
        geometry,
        exits=tuple(map(tuple, geometry.A + moves["exit"])),
        connectors=tuple(map(tuple, geometry.B + moves["connector"])),
    )


def _moves(point: str, values: Mapping[str, float]) -> np.ndarray:
    rows = [[values.get(f"{point}_{axis}@{k}", 0.0) for axis in AXES] for k in range(1, DRIVES + 1)]
    return np.array(rows, float)
