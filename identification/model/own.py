"""Parameters of which each record of a joined log has a value of its own, such as its start.

NAME        of the first record
NAME [k]    of record k
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace

from identification.model.parameter import RECORD, Parameter, ParameterSet

_OWN = re.compile(r"(?P<name>.+) \[(?P<number>\d+)\]")


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


def of_record(names: Sequence[str], number: int) -> dict[str, int]:
    """Returns the parameters that a record sees, as its plant knows them, and their columns."""
    seen: dict[str, int] = {}
    mine: dict[str, int] = {}
    for column, name in enumerate(names):
        own = _OWN.fullmatch(name)
        if own is None:
            seen[name] = column
        elif int(own["number"]) == number:
            mine[own["name"]] = column
    return {**seen, **mine}


def values_of_record(values: Mapping[str, float], number: int) -> dict[str, float]:
    """Returns the values that a record sees, by names as its plant knows them."""
    names = [*values]
    return {name: values[names[column]] for name, column in of_record(names, number).items()}
