"""Records of one robot, one after the other in one log.

A simulation begins anew with each record, and so does a Kalman predictor. The time of the joined
log counts on through all records, so that a part of it is the end of one record and the beginning
of the next.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from identification.errors import InputError, unknown_name
from identification.logs.log import Log, halves
from identification.logs.overlap import refuse_different
from identification.logs.sampling import grid, rows_between


@dataclass(frozen=True, eq=False, kw_only=True)
class JoinedLog(Log):
    """A log that is made of several records; `join_logs` makes one.

    Attributes:
        records: the records, one after the other.
        numbers: of each record among those that were joined, counted from 1; a part of the log
            keeps the numbers of its records.
    """

    records: tuple[Log, ...] = field(repr=False)
    numbers: tuple[int, ...]

    def between(self, start: float, end: float) -> Log:
        """Returns the samples of [start, end) [s], of the records that have some; see `Log`."""
        first, last = rows_between(self.time, start, end)
        parts, numbers, begun = [], [], 0
        for number, record in zip(self.numbers, self.records, strict=True):
            rows = slice(max(0, first - begun), max(0, min(len(record), last - begun)))
            begun += len(record)
            if rows.start < rows.stop:
                h = record.sampling_time
                times = record.time[0] + h * np.array([rows.start, rows.stop])
                parts.append(record.between(*times))
                numbers.append(number)
        return _joined(parts, numbers, self.name, float(self.time[first]))

    def part(self, name: str) -> Log:
        """Returns the samples of a named split, of all records that have it; see `Log.part`."""
        has = [(number, record) for number, record in zip(self.numbers, self.records, strict=True)
               if name in (record.splits or halves(record))]  # fmt: skip
        if not has:
            known = dict.fromkeys(n for record in self.records for n in record.splits)
            raise unknown_name("part of the logs", name, known)
        parts = [record.part(name) for _, record in has]
        numbers = [number for number, _ in has]
        return _joined(parts, numbers, f"{self.name} [{name}]", float(self.time[0]))


def join_logs(logs: Sequence[Log], name: str = "") -> Log:
    """Returns several records as one log; a single one stays as it is."""
    if not logs:
        raise InputError("there is no log to join; give one or more")
    if len(logs) == 1:
        return logs[0]
    refuse_different(logs)
    for log in logs[1:]:
        _refuse_unlike(logs[0], log)
    numbers = [*range(1, 1 + len(logs))]
    return _joined(logs, numbers, name or " + ".join(log.name for log in logs), 0.0)


def rows_of(log: Log, name: str) -> np.ndarray:
    """Returns which samples of a log, or of joined records, belong to a split, shape (N,)."""
    out = []
    for _, record in records_of(log):
        splits = record.splits or halves(record)
        inside = np.zeros(len(record), bool)
        if name in splits:
            first, last = rows_between(record.time, *splits[name])
            inside[first:last] = True
        out.append(inside)
    return np.concatenate(out)


def _joined(records: Sequence[Log], numbers: Sequence[int], name: str, start: float) -> JoinedLog:
    first = records[0]
    return JoinedLog(
        time=grid(start, first.sampling_time, sum(map(len, records))),
        inputs=np.concatenate([log.inputs for log in records]),
        outputs=np.concatenate([log.outputs for log in records]),
        input_names=first.input_names,
        output_names=first.output_names,
        units={n: u for n, u in first.units.items() if n not in first.extras},
        name=name,
        hold=first.hold,
        remarks=tuple(dict.fromkeys(r for log in records for r in log.remarks)),
        records=tuple(records),
        numbers=tuple(numbers),
    )


def records_of(log: Log) -> tuple[tuple[int, Log], ...]:
    """Returns the records of a log with their numbers; a log that was not joined is number 1."""
    if isinstance(log, JoinedLog):
        return tuple(zip(log.numbers, log.records, strict=True))
    return ((1, log),)


def _refuse_unlike(first: Log, log: Log) -> None:
    """Refuse a record that cannot follow the first one."""
    if not np.isclose(first.sampling_time, log.sampling_time, rtol=1e-6):
        raise InputError(
            f"log {first.name!r} has a sample every {first.sampling_time:g} s, {log.name!r} every"
            f" {log.sampling_time:g} s; give logs of the same sampling time"
        )
    if first.values or log.values:
        raise InputError(
            f"logs {first.name!r} and {log.name!r}: values of one log alone are not known to this"
            " search; leave [values] out"
        )
