"""The knowledge of a robot before a fit: its common values, and how much its parts differ.

    value at drive k = common value (1 + δ_k),      δ_k ~ N(0, s²)       s of the parameter
    point            = nominal place + e,           e ~ N(0, s²)         s of exits, of connectors

The deviations of one kind are a group: a fit may find that they scatter less than s
(`identification.kalman.refit`), so that a robot whose drives are alike is not paid for.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from identification.errors import InputError, unknown_name
from identification.storage.files import is_file, read_toml
from inca_mj.files import model_path
from inca_mj.robot.geometry import DRIVES
from inca_mj.robot.spread import AXES, EACH_DRIVE, POINTS
from inca_mj.twin.logs import POSE

# Common values: those that the thesis calls measured or arbitrary are known to
# 30 %, those of data sheets better.
KNOWN = {
    "lambda": 0.3, "b": 0.3, "J": 0.3, "b_v": 0.3, "b_c": 0.3, "beta": 0.3, "K_t": 0.3,
    "k_s": 0.3, "R": 0.005, "m": 0.01, **dict.fromkeys(POSE, 0.1),
}  # fmt: skip
INERTIAS = ("I_x", "I_y", "I_z")
WORDS = ("none", "usual")


@dataclass(frozen=True)
class Spread:
    """Differences of the parts of a robot from what they should be, each number a std.

    Attributes:
        drives: relative deviation of a drive, by the name of a parameter.
        points: of each coordinate of an exit point or connector [m].
        inertia: relative deviation of the platform's inertias.
        source: where the numbers come from.
    """

    drives: Mapping[str, float]
    points: Mapping[str, float]
    inertia: float
    source: str

    @property
    def groups(self) -> dict[str, tuple[str, ...]]:
        """The deviations that share one std, by what deviates."""
        every = range(1, DRIVES + 1)
        drives = {name: tuple(f"{name}@{k}" for k in every) for name in self.drives}
        points = {
            point: tuple(f"{point}_{axis}@{k}" for k in every for axis in AXES)
            for point in self.points
        }
        return {**drives, **points}

    @property
    def known(self) -> dict[str, float]:
        """The std of every free parameter before a fit, by name: common values, then deviations."""
        std = {**self.drives, **self.points}
        parts = {name: std[group] for group, names in self.groups.items() for name in names}
        inertia = dict.fromkeys(INERTIAS, self.inertia) if self.inertia else {}
        return {**KNOWN, **inertia, **parts}


NONE = Spread({}, {}, 0.0, "all drives alike, all points where the drawing has them")


def spread_of(word: str) -> Spread:
    """Returns the spread that a user names: none, usual, or a TOML file.

    Raises:
        InputError: it is neither a word nor a file that can be read.
    """
    if word == "none":
        return NONE
    path = model_path("inca6d_spread.toml") if word == "usual" else Path(word)
    if word != "usual" and not is_file(path):
        raise InputError(f"no spread {word!r}; give {' or '.join(WORDS)}, or a TOML file")
    return read_spread(path)


def read_spread(path: Path) -> Spread:
    """Read a spread from TOML: tables [drives], [points], [platform], and a source.

    Raises:
        InputError: the file is no TOML, names what a robot has not, or a std is no positive number.
    """
    table = read_toml(path)
    for name in table:
        if name not in ("drives", "points", "platform", "source"):
            raise unknown_name(f"table in {path}", name, ("drives", "points", "platform", "source"))
    drives = _numbers(path, table, "drives", EACH_DRIVE)
    points = _numbers(path, table, "points", tuple(POINTS))
    platform = _numbers(path, table, "platform", ("inertia",))
    source = str(table.get("source", path.name))
    return Spread(drives, points, platform.get("inertia", 0.0), source)


def _numbers(
    path: Path, table: Mapping[str, object], name: str, known: tuple[str, ...]
) -> dict[str, float]:
    part = table.get(name, {})
    if not isinstance(part, dict):
        raise InputError(f"spread file {path}: {name} is no table; write [{name}] above its lines")
    for key, value in part.items():
        if key not in known:
            raise unknown_name(f"key under [{name}] in {path}", key, known)
        if isinstance(value, bool) or not isinstance(value, int | float) or not 0 < value < 1:
            raise InputError(
                f"spread file {path}: {key} is {value!r}; give a std above 0 and below 1, or leave"
                " the line out"
            )
    return {key: float(value) for key, value in part.items()}
