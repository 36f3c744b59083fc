"""The records of one robot, made of its logs: some are fitted, the others only confirm."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import chain, repeat

from identification.errors import InputError
from identification.logs.joined import Record as Record
from identification.logs.joined import Role, refuse_different
from identification.logs.log import Log


def as_records(fit: Sequence[Log], confirm: Sequence[Log] = ()) -> tuple[Record, ...]:
    """Returns records to fit and records to confirm.

    Where nothing confirms, the first half of each log is fitted (its part `estimation`) and the
    rest of it confirms.

    Args:
        fit: logs to fit.
        confirm: logs that no fit may see.

    Raises:
        InputError: there is no log to fit, the columns differ, or a log is given twice, in whole
            or in part.
    """
    if not fit:
        raise InputError("no log is to be fitted; give at least one")
    refuse_different([*fit, *confirm])
    named = _distinct([*fit, *confirm])
    if confirm:
        roles = chain(repeat(_FIT, len(fit)), repeat(_CONFIRM))
        return tuple(map(Record, named, roles, (log.values for log in named)))
    return tuple(
        Record(log.part(part), role, log.values) for part, role in _HALVES for log in named
    )


_FIT: Role = "fit"
_CONFIRM: Role = "confirm"
_HALVES = (("estimation", _FIT), ("validation", _CONFIRM))


def _distinct(logs: Sequence[Log]) -> list[Log]:
    """Returns the logs under distinct names: a record's own values are told by its name."""
    out: list[Log] = []
    for log in logs:
        used = {other.name for other in out}
        name, k = log.name, 1
        while name in used:
            k += 1
            name = f"{log.name} ({k})"
        out.append(log if name == log.name else replace(log, name=name))
    return out
