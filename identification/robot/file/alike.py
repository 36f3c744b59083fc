"""Values of a robot that are alike but for their spread, as its TOML says it.

    value at place i = nominal_i · common · (1 + δ_i),    δ_i ~ N(0, std²)

The parameters of a table [spread.damping] are the common value, `damping`, which is the value at
the first place with the others in proportion, and a relative deviation of each place, such as
`damping@shoulder`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import mujoco

from identification.errors import InputError, repeated, told_of
from identification.model.parameter import DEVIATION, Parameter
from identification.model.plant import start_place
from identification.model.tied import spread_place, value_of
from identification.robot.file.file_checks import Kinds, check_table, texts

KNOWN = 0.3  # std of the common value, relative, unless given
FARTHEST = (-0.9, 9.0)  # of a deviation
_KEYS: Kinds = {
    "of": (list, "a list of paths into the model"),
    "std": ((int, float), "a number above zero"),
    "known": ((int, float), "a number above zero"),
}


@dataclass(frozen=True)
class Alike:
    """Values that are alike."""

    name: str  # of the common value
    of: tuple[str, ...]  # the paths into the model
    std: float  # of each place's deviation, relative
    known: float = KNOWN  # std of the common value, relative
    deviates: bool = True  # whether the places deviate at all
    where: str = field(default="", compare=False)  # it is told, key and file, for messages

    @property
    def deviations(self) -> dict[str, str]:
        """The path of each deviation, by the name of the parameter."""
        # "elbow" of "joint/elbow.damping"
        things = [p.partition("/")[2].partition("[")[0].rpartition(".")[0] or p for p in self.of]
        words = self.of if repeated(things) else things
        each = zip(words, self.of, strict=True)
        return {f"{self.name}@{word}": path for word, path in each if self.deviates}

    @property
    def names(self) -> tuple[str, ...]:
        """The common value, then the deviations."""
        return (self.name, *self.deviations)

    def parameters(self, model: mujoco.MjModel, unit: str) -> dict[str, tuple[Parameter, float]]:
        """Returns the parameters by name, each with the std of its prior."""
        with told_of(self.where or f"spread.{self.name}"):
            nominal = [self._nominal(path, model) for path in self.of]
        ties = tuple((path, x / nominal[0]) for path, x in zip(self.of, nominal, strict=True))[1:]
        common = Parameter(
            name=self.name, value=nominal[0], unit=unit, where=self.of[0], lower=0.0, ties=ties,
            scale=nominal[0], about=f"{self.name}: common value, at the first place",
        )  # fmt: skip
        lower, upper = FARTHEST
        each = [
            Parameter(
                name=name, value=0.0, unit="", where=DEVIATION, lower=lower, upper=upper,
                ties=((path, 1.0),), symbol=self.name,
                about=f"{name.replace('@', ', ')}: relative deviation of {path}",
            )
            for name, path in self.deviations.items()
        ]  # fmt: skip
        return {self.name: (common, self.known), **{p.name: (p, self.std) for p in each}}

    def _nominal(self, path: str, model: mujoco.MjModel) -> float:
        if start_place(path, model) is not None or spread_place(path, model) is not None:
            raise InputError(
                f"{path!r} is an entry of the state; give paths to numbers of the model, such as"
                ' "joint/elbow.damping"'
            )
        value = value_of(model, path)
        if value > 0:
            return value
        raise InputError(
            f"{path} is {value:g} in the model, and a spread tells relative deviations; give it"
            " a value above zero there, or leave it out of the table"
        )


def read_alike(content: Mapping[str, Any], path: Path, free: Sequence[str]) -> tuple[Alike, ...]:
    """Returns the tables under `spread` of a robot's TOML, or of a file of such tables."""
    out = [_alike(name, table, path) for name, table in content.get("spread", {}).items()]
    for each in out:
        taken = [n for n in (*each.names, *each.of) if n in free]
        if taken:
            raise InputError(
                f"{path} frees {taken[0]} and has it in spread.{each.name}; keep one of both"
            )
    twice = repeated([place for each in out for place in each.of])
    if twice:
        raise InputError(f"{path} has {twice[0]} in two places under spread; keep one of them")
    return tuple(out)


def _alike(name: str, table: Any, path: Path) -> Alike:
    where = f"spread.{name} in {path}"
    if not isinstance(table, dict):
        raise InputError(f"{where} must be a table; write [spread.{name}] above its lines")
    check_table(table, _KEYS, where)
    of = texts(table.get("of", []), f"spread.{name}.of", path)
    if len(of) < 2:
        raise InputError(f"{where} names {len(of)} places under `of`; give two or more")
    if "std" not in table:
        raise InputError(f"{where} does not say `std`; give the relative deviation, such as 0.1")
    std, known = float(table["std"]), float(table.get("known", KNOWN))
    return Alike(name, of, std, known, where=where)
