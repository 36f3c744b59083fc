"""Records of one robot: one after the other in one log, and whether they are different records.

A simulation begins anew with each record, and so does a Kalman predictor. The time of the joined
log counts on through all records, so that a part of it is the end of one record and the beginning
of the next.

Sensors' noise never repeats, so that as many samples in a row that are equal to the bit were
measured once. A log says little beside others if a mere replay of them explains its share R:

    R = 1 - Σ_blocks min_s Σ_t ‖z(t) - z_f(t - s)‖² / Σ_blocks Σ_t ‖z(t)‖²      about block means

z are the inputs and outputs of a log, each divided by its std there, and z_f those of other logs,
without the mean of a block, because an axis that integrates drifts; twice the variance of the noise
is taken off the error. Each quarter of the log stands beside the most alike piece of the others.
Where R is above 0.95 a replay leaves as little as a model that is said to explain a log.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from identification.errors import InputError, unknown_name
from identification.logs.log import Log, halves
from identification.logs.noise import noise_floor
from identification.logs.parts import Parts
from identification.logs.sampling import grid, rows_between

REPLAYED = 0.95  # R above which a log says little beside the others
BLOCKS = 4
ROW = 20  # samples
MOVING = 10  # of them, at least, that differ from one another: robots at rest are all alike
Role = Literal["fit", "confirm"]


@dataclass(frozen=True)
class Record:
    """A log and what it is used for."""

    log: Log  # what was measured
    role: Role  # "fit" or "confirm"
    # values of the plant's parameters that hold for this record alone, by name
    values: Mapping[str, float] = field(default_factory=dict)
    # of what no fit sees of it, in a search; None where nothing is told apart
    parts: Parts | None = None
    edge: float = 0.0  # for how long at its ends inputs act that it does not have [s]


@dataclass(frozen=True, eq=False, kw_only=True)
class JoinedLog(Log):
    """A log that is made of several records; `join_logs` makes one."""

    records: tuple[Log, ...] = field(repr=False)  # the records, one after the other
    # of each record among those that were joined, counted from 1; a part of the log keeps the
    # numbers of its records
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


def join_logs(logs: Sequence[Log]) -> Log:
    """Returns several records as one log; a single one stays as it is."""
    if not logs:
        raise InputError("there is no log to join; give one or more")
    if len(logs) == 1:
        return logs[0]
    refuse_different(logs)
    for log in logs[1:]:
        _refuse_unlike(logs[0], log)
    numbers = [*range(1, 1 + len(logs))]
    return _joined(logs, numbers, " + ".join(log.name for log in logs), 0.0)


def records_of(log: Log) -> tuple[tuple[int, Log], ...]:
    """Returns the records of a log with their numbers; a log that was not joined is number 1."""
    if isinstance(log, JoinedLog):
        return tuple(zip(log.numbers, log.records, strict=True))
    return ((1, log),)


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


def refuse_different(logs: Sequence[Log]) -> None:
    """Refuse logs that are not different records of one robot."""
    first = logs[0]
    for k, log in enumerate(logs):
        for other in logs[:k]:
            if _is_same(log, other):
                said = f"logs {other.name!r} and {log.name!r} hold the same samples"
                if log.name == other.name:
                    said = f"log {log.name!r} is given twice"
                raise InputError(
                    f"{said}; a record counts once, and confirms nothing when it was fitted: leave"
                    " one of them out"
                )
        for what in ("input_names", "output_names", "hold"):
            names, expected = getattr(log, what), getattr(first, what)
            if names != expected:
                raise InputError(
                    f"log {log.name!r} has the {what.replace('_', ' ')} {names} where"
                    f" {first.name!r} has {expected}; give records of one robot and one set of"
                    " columns"
                )
        for other in logs[:k]:
            if share_samples(log, other):
                raise InputError(
                    f"logs {log.name!r} and {other.name!r} hold the same samples; what was fitted"
                    " confirms nothing, and what is given twice counts twice: give parts that do"
                    " not overlap"
                )


def share_samples(a: Log, b: Log) -> bool:
    """Returns whether some samples in a row stand in both logs, to the bit."""
    rows = [np.hstack([log.inputs, log.outputs]) for log in (a, b)]
    if min(map(len, rows)) < ROW:
        return False
    _, names = np.unique(np.concatenate(rows), axis=0, return_inverse=True)
    names = names.ravel()
    first, second = (_stretches(n) for n in np.split(names, [len(rows[0])]))
    return bool(np.isin(first, second).any())


def replayed_share(fitted: Sequence[Log], log: Log) -> float:
    """Returns R of a log, no unit; 0 where nothing varies or no fitted piece is long enough."""
    z = np.hstack([log.inputs, log.outputs])
    scale = z.std(axis=0)
    kept = scale > 0
    if not kept.any():
        return 0.0
    size = len(log) // BLOCKS
    middle = z[:, kept].mean(axis=0)
    noise = 2 * float(np.sum((noise_floor(z[:, kept]) / scale[kept]) ** 2))
    pieces = [(np.hstack([f.inputs, f.outputs])[:, kept] - middle) / scale[kept]
              for f in fitted if len(f) >= size > 0]  # fmt: skip
    if not pieces:
        return 0.0
    z = (z[:, kept] - middle) / scale[kept]
    error = total = 0.0
    for k in range(BLOCKS):
        block = z[k * size : (k + 1) * size]
        block = block - block.mean(axis=0)
        total += float(np.sum(block**2))
        error += max(0.0, min(_least(block, piece) for piece in pieces) - size * noise)
    return 1 - error / total if total > 0 else 0.0


def _least(block: np.ndarray, piece: np.ndarray) -> float:
    """Returns min_s Σ ‖block - piece_s‖² over all places s in a piece, each about its own mean."""
    from scipy.signal import fftconvolve  # slow to import

    size = len(block)
    pairs = zip(piece.T, block.T, strict=True)
    across = np.sum([fftconvolve(p, b[::-1], "valid") for p, b in pairs], axis=0)
    sums, power = (
        np.concatenate([np.zeros((1, x.shape[1])), np.cumsum(x, axis=0)]) for x in (piece, piece**2)
    )
    sums, power = sums[size:] - sums[:-size], power[size:] - power[:-size]
    around = np.sum(power - sums**2 / size, axis=1)
    return float(np.min(around - 2 * across) + np.sum(block**2))


def _stretches(names: np.ndarray) -> np.ndarray:
    """Returns samples in a row by their names, one entry a stretch, those at rest left out."""
    each = np.ascontiguousarray(sliding_window_view(names, ROW))
    different = (np.diff(np.sort(each, axis=1), axis=1) != 0).sum(axis=1) + 1
    return each[different >= MOVING].view(f"V{ROW * each.itemsize}").ravel()


def _is_same(a: Log, b: Log) -> bool:
    """Returns whether two logs are one record, to the bit."""
    return a is b or (np.array_equal(a.inputs, b.inputs) and np.array_equal(a.outputs, b.outputs))


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
