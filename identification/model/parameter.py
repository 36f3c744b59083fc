"""A parameter is one frozen record; a set of them is a frozen mapping from name to record.

Each record of a joined log may have a value of its own, such as its start:

NAME        of the first record
NAME [k]    of record k
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf, isfinite

from identification.errors import InputError, repeated, unknown_name
from identification.logs.units import refuse_not_si

_OWN = re.compile(r"(?P<name>.+) \[(?P<number>\d+)\]")
RECORD = "record"  # where a value goes that one record of a joined log has for itself
DEVIATION = "deviation"  # where one goes that multiplies what another parameter writes


@dataclass(frozen=True, kw_only=True)
class Parameter:
    """One number of a model: what it is, how large it may be, and where it goes.

    Attributes:
        name: canonical name, as in JSON, TOML and on the command line.
        value: value in `unit`.
        unit: SI unit, "" when dimensionless.
        where: path in the MuJoCo model (see `identification.model.paths`), "start" for an initial
            condition, "record" for the value of one record, or "deviation" for a
            relative deviation of what another parameter writes to its tie.
        lower: smallest admissible value [unit].
        upper: largest admissible value [unit].
        symbol: letter in the equations; `name` when not given.
        about: what it is, in words; what stands before a colon is its short name.
        source: table, data sheet or paper the value was taken from.
        ties: further paths that get its value, each multiplied by a factor.
        scale: a magnitude that matters [unit]; a search divides by it where the value may be zero.
        bounded_by: why its bounds are where they are, and what moves them, as a clause; "" where a
            user gave them or they are plain.

    Raises:
        InputError: the unit is not SI (g, mm, deg), the bounds are in the wrong order, the value is
            outside them, or a tie's factor is zero or not finite.
    """

    name: str
    value: float
    unit: str
    where: str
    lower: float = -inf
    upper: float = inf
    symbol: str = ""
    about: str = ""
    source: str = ""
    ties: tuple[tuple[str, float], ...] = ()
    scale: float = 1.0
    bounded_by: str = ""

    def __post_init__(self) -> None:
        refuse_not_si(self.unit, f"parameter {self.name!r}")
        if not self.lower < self.upper:
            raise InputError(
                f"parameter {self.name!r}: lower bound {self.lower:g} must be less than "
                f"upper bound {self.upper:g}"
            )
        if not (isfinite(self.value) and self.lower <= self.value <= self.upper):
            raise InputError(
                f"parameter {self.name!r} = {self.value:g} {self.unit}".rstrip()
                + f" is outside its range [{self.lower:g}, {self.upper:g}];"
                " give a value inside it (SI units)"
            )
        for path, factor in self.ties:
            if not (isfinite(factor) and factor):
                raise InputError(
                    f"parameter {self.name!r} is tied to {path!r} by the factor {factor:g}; give a"
                    " finite one that is not zero"
                )

    @property
    def letter(self) -> str:
        """The symbol of the parameter in equations; its name where it has none."""
        return self.symbol or self.name

    @property
    def short(self) -> str:
        """A description in few words; "" where nobody gave one."""
        return self.about.partition(":")[0]

    @property
    def places(self) -> tuple[tuple[str, float], ...]:
        """Every path that it writes, with its factor: `where` with factor 1, then the ties."""
        return () if self.where in (RECORD, DEVIATION) else ((self.where, 1.0), *self.ties)


@dataclass(frozen=True)
class ParameterSet:
    """Parameters by name, in a fixed order; `with_values` returns a new set.

    Attributes:
        name: name of the set.
        records: the parameters; each name occurs once.

    Raises:
        InputError: a name occurs twice.
    """

    name: str
    records: tuple[Parameter, ...]

    def __post_init__(self) -> None:
        names = [p.name for p in self.records]
        twice = repeated(names)
        if twice:
            raise InputError(f"parameter set {self.name!r} names {', '.join(twice)} twice")

    @cached_property
    def _by_name(self) -> dict[str, Parameter]:
        # A robot with 50 joints has thousands of parameters, each of which is asked for by name.
        return {p.name: p for p in self.records}

    @cached_property
    def _values(self) -> dict[str, float]:
        return {p.name: p.value for p in self.records}

    def __getitem__(self, name: str) -> Parameter:
        if name not in self._by_name:
            raise unknown_name("parameter", name, self._by_name)
        return self._by_name[name]

    def __iter__(self) -> Iterator[Parameter]:
        return iter(self.records)

    def values(self) -> dict[str, float]:
        """Returns the values by name, each in its parameter's unit."""
        return self._values.copy()

    def with_values(self, values: Mapping[str, float], source: str = "") -> ParameterSet:
        """Returns the same set with some values replaced.

        Args:
            values: the new values by name, in their parameters' units.
            source: where they come from; when empty, each parameter keeps its old source.

        Raises:
            InputError: a name is unknown, or a value is outside its parameter's bounds.
        """
        for name in values:
            self[name]
        records = tuple(
            replace(p, value=float(values[p.name]), source=source or p.source)
            if p.name in values
            else p
            for p in self
        )
        return replace(self, records=records)


def own_name(name: str, number: int) -> str:
    """Returns the name of a parameter's value in a record, whose number is counted from 1."""
    return name if number == 1 else f"{name} [{number}]"


def with_own(parameters: ParameterSet, names: Sequence[str], records: int) -> ParameterSet:
    """Returns a robot's parameters with own values of each record, where these are missing yet."""
    known = {p.name for p in parameters}
    new = [_own(parameters[name], k) for k in range(2, records + 1) for name in names]
    return replace(
        parameters, records=(*parameters.records, *(p for p in new if p.name not in known))
    )


def of_record(names: Sequence[str], number: int) -> dict[str, int]:
    """Returns the parameters that a record sees, as its plant knows them, and their columns."""
    seen: dict[str, int] = {}
    found: dict[str, int] = {}
    for column, name in enumerate(names):
        of_one = _OWN.fullmatch(name)
        if of_one is None:
            seen[name] = column
        elif int(of_one["number"]) == number:
            found[of_one["name"]] = column
    return {**seen, **found}


def values_of_record(values: Mapping[str, float], number: int) -> dict[str, float]:
    """Returns the values that a record sees, by names as its plant knows them."""
    names = [*values]
    return {name: values[names[column]] for name, column in of_record(names, number).items()}


def _own(parameter: Parameter, number: int) -> Parameter:
    """Returns the value of a record, which has its number in its name and in its words."""
    short, colon, detail = parameter.about.partition(":")
    return replace(
        parameter,
        name=own_name(parameter.name, number),
        where=RECORD,
        symbol=parameter.letter,
        about=f"{short}, record {number}{colon}{detail}" if short else "",
        ties=(),
    )
