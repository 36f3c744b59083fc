"""Readings of a log: is every column in its unit, with its sign, in its place?

    ε_k = Σ ‖y_k - ŷ_k‖² / Σ ‖y_k - y_k(0)‖²       share of output k that a model leaves unexplained

A model whose parameters are yet to be found may be far off, so a log is refused only where the
model would explain it as another one, and far better: in other units, against a sign, with two
columns exchanged. What only a better model explains is left to the search: `misread` asks its
caller. Where the model's ŷ begins, and over which time, is the caller's: he gives ε as a function
of a log.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, product

import numpy as np

from identification.logs.cures import how_to_exchange, how_to_turn, unit_lines
from identification.logs.log import Log
from identification.logs.names import listed
from identification.logs.units import UNITS
from identification.progress import counted

UNEXPLAINED = 0.05  # least ε of an output that is not what it says
NEARER = 0.2  # of ε, that another reading must leave
EXPLAINED = 0.5  # ε of all that it changes, at most
SAME = 0.01  # of ε, within which two readings are the same: a factor of 57.3 and the unit deg

# Pairs of columns that are tried in each other's place, which are all of twelve columns. Each costs
# a simulation, and of 50 columns they would take an hour; columns side by side are confused first.
MOST_PAIRS = 66


@dataclass(frozen=True)
class Reading:
    """Another way to read a log.

    Attributes:
        log: so read.
        columns: outputs that change, with it or with what an input does to them.
        said: what it would be, in words.
        cure: what to do, were it so.
        kinds: "units", "wiring" or both, which a user may trust.
    """

    log: Log
    columns: Sequence[int]
    said: str
    cure: str
    kinds: tuple[str, ...] = ("wiring",)


# ε of a reading, shape (ny,); None where none can be had, or where it is not far better
Unexplained = Callable[[Reading], np.ndarray | None]


def is_far_better(reading: Reading, left: np.ndarray, own: np.ndarray) -> bool:
    """Returns whether a reading explains every column that it changes far better.

    Args:
        reading: another one.
        left: its ε, shape (ny,), without unit.
        own: ε of the log as it is read, shape (ny,).
    """
    k = list(reading.columns)
    return bool((left[k] < np.minimum(EXPLAINED, NEARER * own[k])).all())


def misread(
    log: Log,
    own: np.ndarray,
    readings: Iterable[Reading],
    unexplained: Unexplained,
    believed: Callable[[Reading, np.ndarray], bool] = lambda reading, left: True,
) -> tuple[Reading, str] | None:
    """Returns the reading that explains a log far better than the present one, and that in words.

    Far better: every column that it changes. Of several, the one that leaves least in all, and of
    those that leave the same the first.

    Args:
        log: as it is read.
        own: its ε, shape (ny,), without unit.
        readings: other ones.
        unexplained: ε of a reading.
        believed: whether a reading with its ε is what no better model could be.

    Returns:
        The reading, and how much is explained of which outputs, how much would be, and the cure;
        None where no reading is far better.
    """
    best, least = None, np.inf
    for reading in counted(readings, "other readings of the log"):
        left = unexplained(reading)
        if left is None or not is_far_better(reading, left, own):
            continue
        if left.sum() < (1 - SAME) * least and believed(reading, left):
            best, least = (reading, left), float(left.sum())
    if best is None:
        return None
    reading, left = best
    before, after = (100 * max(0.0, 1 - float(e[list(reading.columns)].max())) for e in (own, left))
    return reading, (
        f"explains {before:.0f} % of {listed(log.output_names[k] for k in reading.columns)}, and"
        f" {after:.0f} % {reading.said}; {reading.cure}"
    )


def unit_readings(
    log: Log,
    bad: np.ndarray,
    column: Mapping[str, str],
    wanted: Mapping[str, str] | None = None,
    alone: bool = True,
) -> Iterator[Reading]:
    """Yields other units of unexplained outputs, and of inputs that are wanted positions.

    Args:
        log: as it is read.
        bad: true where an output is not explained, shape (ny,).
        column: what an output or input is called in the log's file.
        wanted: SI unit by name of the inputs that a drive compares with its joint's own motion.
        alone: whether one column of several of a kind may be in another unit.
    """
    wanted, ny = wanted or {}, log.outputs.shape[1]
    names = [*log.output_names, *(n for n in log.input_names if n in wanted)]
    kinds = [(log.units.get(n, ""), False) for n in names[:ny]]
    kinds += [(wanted[n], True) for n in names[ny:]]
    for words in _units(kinds, alone):
        changed = [k for k, word in enumerate(words) if word]
        if not all(bad[k] for k in changed if k < ny):
            continue
        felt = changed if changed[-1] < ny else np.flatnonzero(bad).tolist()
        scale = {n: UNITS[word][1] for n, word in zip(names, words, strict=True) if word}
        other = replace(
            log,
            outputs=log.outputs * [scale.get(n, 1.0) for n in log.output_names],
            inputs=log.inputs * [scale.get(n, 1.0) for n in log.input_names],
        )
        told = unit_lines({column[names[k]]: words[k] for k in changed})
        said = f"were it in {' and '.join(dict.fromkeys(words[k] for k in changed))}"
        yield Reading(other, felt, said, told, ("units",))


def output_readings(
    log: Log, bad: np.ndarray, column: Mapping[str, str], mirrored: bool = True
) -> Iterator[Reading]:
    """Yields other signs and places of the outputs that are not explained; see `output_turns`."""
    yield from output_turns(log, bad, column, mirrored)
    yield from output_exchanges(log, bad, column)


def output_exchanges(log: Log, bad: np.ndarray, column: Mapping[str, str]) -> Iterator[Reading]:
    """Yields two outputs that are not explained, each in the other's place; see `unit_readings`."""
    y, out = log.outputs, [column[n] for n in log.output_names]
    for i, j in column_pairs(np.flatnonzero(bad).tolist()):
        yield Reading(replace(log, outputs=_exchanged(y, i, j)), [i, j], "were they exchanged",
                      how_to_exchange(out[i], out[j]))  # fmt: skip


def output_turns(
    log: Log, bad: np.ndarray, column: Mapping[str, str], mirrored: bool = True
) -> Iterator[Reading]:
    """Yields the other sign of each unexplained output, and of all of them; see `unit_readings`.

    Args:
        log: as it is read.
        bad: true where an output is not explained, shape (ny,).
        column: what an output or input is called in the log's file.
        mirrored: whether all outputs with the other sign look as all inputs with the other sign.
    """
    y, wrong = log.outputs, np.flatnonzero(bad).tolist()
    out, into = ([column[n] for n in names] for names in (log.output_names, log.input_names))
    factors = {column[n]: f for n, f in log.factors.items() if n in column}
    for k in [*([k] for k in wrong), *([wrong] if len(wrong) > 1 else [])]:
        mirror = f", or of {listed(into)}" if mirrored and len(k) == y.shape[1] else ""
        yield Reading(replace(log, outputs=turned(y, k)), k, "with the other sign",
                      how_to_turn([out[i] for i in k], factors, mirror))  # fmt: skip


def input_readings(log: Log, bad: np.ndarray, column: Mapping[str, str]) -> Iterator[Reading]:
    """Yields other signs and places of the inputs; see `unit_readings`."""
    yield from input_turns(log, bad, column)
    yield from input_exchanges(log, bad, column)


def input_exchanges(log: Log, bad: np.ndarray, column: Mapping[str, str]) -> Iterator[Reading]:
    """Yields two inputs, each in the other's place; see `unit_readings`."""
    u, wrong = log.inputs, np.flatnonzero(bad).tolist()
    into = [column[n] for n in log.input_names]
    for i, j in column_pairs(range(u.shape[1])):
        yield Reading(replace(log, inputs=_exchanged(u, i, j)), wrong, "were inputs exchanged",
                      how_to_exchange(into[i], into[j]))  # fmt: skip


def input_turns(log: Log, bad: np.ndarray, column: Mapping[str, str]) -> Iterator[Reading]:
    """Yields the other sign of each input; see `unit_readings`."""
    u, wrong = log.inputs, np.flatnonzero(bad).tolist()
    factors = {column[n]: f for n, f in log.factors.items() if n in column}
    for k, name in enumerate(column[n] for n in log.input_names):
        yield Reading(replace(log, inputs=turned(u, [k])), wrong,
                      "with the other sign of an input",
                      how_to_turn([name], factors))  # fmt: skip


def turned(signals: np.ndarray, columns: Sequence[int]) -> np.ndarray:
    """Returns signals, shape (n, m), with the other sign of some columns, in the same units."""
    return signals * np.where(np.isin(np.arange(signals.shape[1]), columns), -1.0, 1.0)


def unexplained_share(y: np.ndarray, error: np.ndarray) -> np.ndarray:
    """Returns ε of each output over W windows, shape (ny,), no unit; 0 where it does not move.

    Args:
        y: what was measured, shape (W, L, ny), in the outputs' units.
        error: of the model, the same shape and units; of a part of it, which leaves less.
    """
    moved = np.sum((y - y[:, :1]) ** 2, axis=(0, 1))
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio: np.ndarray = np.sum(error**2, axis=(0, 1)) / moved
    return np.where(moved > 0, ratio, 0.0)


def _units(columns: Sequence[tuple[str, bool]], alone: bool) -> Iterator[tuple[str, ...]]:
    """Yields other units of columns, "" for as it is: of all of a kind, and of one alone."""
    kinds = [*dict.fromkeys(columns)]
    words = {k: ["", *(w for w, (of, _) in UNITS.items() if of == k[0] != w)] for k in kinds}
    for chosen in product(*(words[kind] for kind in kinds)):
        if any(chosen):
            yield tuple(chosen[kinds.index(kind)] for kind in columns)
    for k, kind in enumerate(columns):
        if alone and columns.count(kind) > 1:
            yield from (tuple(w * (i == k) for i in range(len(columns))) for w in words[kind][1:])


def column_pairs(columns: Sequence[int]) -> list[tuple[int, int]]:
    """Returns the pairs of some columns in their order; of many pairs, those that are nearest."""
    every = list(combinations(columns, 2))
    return sorted(sorted(every, key=lambda pair: pair[1] - pair[0])[:MOST_PAIRS])


def _exchanged(signals: np.ndarray, i: int, j: int) -> np.ndarray:
    return signals[:, [{i: j, j: i}.get(k, k) for k in range(signals.shape[1])]]
