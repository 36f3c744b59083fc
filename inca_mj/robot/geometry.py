"""The points where the cables leave the frame and where they meet the platform, and its handle.

The thesis lost the coordinates. These are ASSUMED: a flat SPIDAR-G cross, two cables on each
of four connectors, chosen because its unpowered equilibrium is stable, it has wrench closure,
and a 4 N pretension rests it at z = 1.43 m. A file of the user's own replaces them.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from numbers import Real
from pathlib import Path
from typing import Any

import numpy as np

from identification.errors import InputError
from identification.storage.files import read_toml, write_text

DRIVES = 8
FARTHEST = 100.0  # a frame of more is one in another unit [m]
# The body of the handle, as it is drawn and as cables can touch it; assumed like the points.
GRIP = ((0.0, 0.0, -0.02), (0.0, 0.0, -0.11))  # ends of the grip's axis in P [m]
GRIP_RADIUS = 0.015  # [m]
ARM_RADIUS = 0.005  # of the arms from the centre to the connectors [m]


@dataclass(frozen=True)
class Geometry:
    """Anchors of the eight cables.

    Attributes:
        exits: exit points A_i in the frame O (on the floor, centre, z up) [m], 8 rows of 3.
        connectors: connectors B_i in the platform frame P (at its centre of mass) [m], 8 of 3.
        assumed: True while nobody has measured them; shown wherever they are.
        source: where the numbers come from.

    Raises:
        InputError: not 8 rows of 3 finite numbers, too far for metres, or all connectors in one
            place, where no cable can turn the platform.
    """

    exits: tuple[tuple[float, float, float], ...]
    connectors: tuple[tuple[float, float, float], ...]
    assumed: bool
    source: str

    def __post_init__(self) -> None:
        for name in ("exits", "connectors"):
            try:
                rows = np.array(getattr(self, name), dtype=object)
                is_number = all(isinstance(x, Real) and not isinstance(x, bool) for x in rows.flat)
                rows = rows.astype(float) if is_number else np.empty(0)
            except (TypeError, ValueError, OverflowError):
                rows = np.empty(0)
            if rows.shape != (DRIVES, 3) or not np.isfinite(rows).all():
                raise InputError(
                    f"geometry: {name} must be {DRIVES} rows of 3 finite numbers [m],"
                    " as in examples/geometry.toml"
                )

        if max(np.abs(self.A).max(), np.abs(self.B).max()) > FARTHEST:
            raise InputError(
                f"geometry: a point lies more than {FARTHEST:g} m away; give metres, not mm"
            )
        if np.linalg.matrix_rank(self.B - self.B.mean(axis=0), tol=1e-6) < 2:
            raise InputError(
                "geometry: the connectors lie on one line, so the cables cannot hold the platform's"
                " turn about it; give connectors that span a plane"
            )

    @property
    def A(self) -> np.ndarray:
        """Exit points A_i in O, shape (8, 3) [m]."""
        return np.array(self.exits)

    @property
    def B(self) -> np.ndarray:
        """Connectors B_i in P, shape (8, 3) [m]."""
        return np.array(self.connectors)


INCA = Geometry(
    exits=(
        (1.5, 1.5, 0.1),
        (-1.5, 1.5, 0.1),
        (-1.5, -1.5, 0.1),
        (1.5, -1.5, 0.1),
        (1.5, 1.5, 3.0),
        (-1.5, 1.5, 3.0),
        (-1.5, -1.5, 3.0),
        (1.5, -1.5, 3.0),
    ),
    connectors=(
        (0.0, 0.05, 0.0),
        (0.0, 0.05, 0.0),
        (0.0, -0.05, 0.0),
        (0.0, -0.05, 0.0),
        (0.075, 0.0, 0.0),
        (-0.075, 0.0, 0.0),
        (-0.075, 0.0, 0.0),
        (0.075, 0.0, 0.0),
    ),
    assumed=True,
    source="assumed: flat SPIDAR-G cross; the thesis' own coordinates are lost",
)


def each_drive(name: str) -> tuple[str, ...]:
    """Returns the names of a quantity at each drive, such as tension_1 to tension_8."""
    return tuple(f"{name}_{k}" for k in range(1, DRIVES + 1))


def geometry_of(record: Mapping[str, Any]) -> Geometry:
    """Returns the geometry of a record from JSON; KeyError or TypeError where it is damaged."""
    rows = {name: tuple(map(tuple, record[name])) for name in ("exits", "connectors")}
    return Geometry(**{**record, **rows})


def read_geometry(path: str | Path) -> Geometry:
    """Read a geometry from TOML: `exits`, `connectors` (8 rows of 3) [m], `assumed`, `source`.

    Raises:
        InputError: the file is missing, is not TOML, or does not hold such rows.
    """
    path = Path(path)
    if not path.exists():
        raise InputError(f"no geometry file {path}; examples/geometry.toml shows one")
    table = read_toml(path)
    extra = sorted(set(table) - {"exits", "connectors", "assumed", "source"})
    if extra:
        raise InputError(
            f"geometry file {path}: unknown key {extra[0]!r};"
            " known: exits, connectors, assumed, source"
        )
    rows = {}
    for name in ("exits", "connectors"):
        if not isinstance(table.get(name), list):
            raise InputError(f"geometry file {path} lacks {name}, {DRIVES} rows of 3 numbers [m]")
        rows[name] = tuple(tuple(r) if isinstance(r, list) else r for r in table[name])
    return Geometry(
        **rows,
        assumed=table.get("assumed", False) is not False,
        source=str(table.get("source", path.name)),
    )


def write_geometry(geometry: Geometry, path: str | Path) -> Path:
    """Write a geometry as TOML, exact to the last bit; `read_geometry` reads it.

    Raises:
        InputError: the file cannot be written.
    """
    facts = {"assumed": geometry.assumed, "source": geometry.source}
    lines = [f"{name} = {json.dumps(value)}" for name, value in facts.items()]
    for name, about in (("exits", "exit points A in O"), ("connectors", "connectors B in P")):
        rows = [f"  [{', '.join(repr(float(x)) for x in row)}]," for row in getattr(geometry, name)]
        lines += ["", f"# {about} [m]", f"{name} = [", *rows, "]"]
    return write_text(Path(path), "\n".join(lines) + "\n")
