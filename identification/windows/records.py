"""The records of one robot, made of its logs: some are fitted, the others only confirm."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from identification.errors import InputError
from identification.logs.joined import Record as Record
from identification.logs.joined import Role, refuse_different
from identification.logs.log import Log


def as_records(
    fit: Sequence[Log],
    confirm: Sequence[Log] = (),
    values: Mapping[str, Mapping[str, float]] | None = None,
) -> tuple[Record, ...]:
    """Returns records to fit and records to confirm.

    Where nothing confirms, the first half of each log is fitted (its part `estimation`) and the
    rest of it confirms.

    Args:
        fit: logs to fit.
        confirm: logs that no fit may see.
        values: by the name of a log, values that hold for it alone, beside those that the log says
            itself (`Log.values`).

    Raises:
        InputError: there is no log to fit, the columns differ, or a log is given twice, in whole
            or in part.
    """
    if not fit:
        raise InputError("no log is to be fitted; give at least one")
    refuse_different([*fit, *confirm])
    given = values or {}
    every = [*fit, *confirm]
    own = [{**log.values, **given.get(log.name, {})} for log in every]
    named = list(zip(_distinct(every), own, strict=True))
    if confirm:
        return (
            *(Record(log, "fit", v) for log, v in named[: len(fit)]),
            *(Record(log, "confirm", v) for log, v in named[len(fit) :]),
        )
    return tuple(Record(log.part(part), role, v) for part, role in _HALVES for log, v in named)


_HALVES: tuple[tuple[str, Role], ...] = (("estimation", "fit"), ("validation", "confirm"))


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
