"""Other readings of the columns of a log: units, factors, signs and places, one or two at once.

A factor that the TOML of a log gives turns the numbers of a file into those of the right sign and
unit. A wrong one makes an output too large or too small, as a wrong unit does; but its cure is to
correct the factor, and not to write a unit beside it.

A log may have two mistakes: a turned sign together with a wrong unit, with exchanged columns, or
with another turned sign. Neither reading explains such a log by itself.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain, combinations, product
from typing import NamedTuple

import numpy as np

from identification.logs.cures import how_to_exchange, how_to_turn, unit_lines
from identification.logs.log import Log
from identification.logs.names import listed
from identification.logs.units import UNITS
from identification.refusals.readings import Reading

# Pairs of columns that are tried in each other's place, which are all of twelve columns. Each costs
# a simulation, and of 50 columns they would take an hour; columns side by side are confused first.
MOST_PAIRS = 66


@dataclass(frozen=True)
class Doubt:
    """A log, and which of its outputs are not explained as they are read."""

    log: Log  # as it is read
    bad: np.ndarray  # true where an output is not explained, shape (ny,)
    column: Mapping[str, str]  # what an output or input is called in the log's file

    @classmethod
    def of(cls, log: Log, column: Mapping[str, str]) -> Doubt:
        """Returns a log all of whose outputs are in doubt."""
        return cls(log, np.ones(log.outputs.shape[1], bool), column)

    @property
    def wrong(self) -> list[int]:
        """The outputs that are not explained."""
        return np.flatnonzero(self.bad).tolist()

    @property
    def outputs(self) -> list[str]:
        """The columns of the outputs in the log's file."""
        return [self.column[n] for n in self.log.output_names]

    @property
    def inputs(self) -> list[str]:
        """The columns of the inputs in the log's file."""
        return [self.column[n] for n in self.log.input_names]

    @property
    def factors(self) -> dict[str, float]:
        """The factors that the log's TOML gives, by column of its file."""
        return {self.column[n]: f for n, f in self.log.factors.items() if n in self.column}

    def how_to_turn(self, columns: Sequence[str], instead: str = "") -> str:
        """Says how to turn the sign of some columns of the log's file."""
        return how_to_turn(columns, self.factors, instead)


Readings = Callable[[Doubt], Iterator[Reading]]


def factor_readings(doubt: Doubt) -> Iterator[Reading]:
    """Yields the log without the factor of an unexplained output, and of all such outputs.

    A factor of 1 or -1 changes no size; `output_turns` tells of a wrong sign.
    """
    log, names = doubt.log, doubt.outputs
    each = [log.factors.get(n, 1.0) for n in log.output_names]
    given = [k for k in doubt.wrong if abs(each[k]) != 1.0]
    for some in [*([k] for k in given), *([given] if len(given) > 1 else [])]:
        divisors = np.where(np.isin(np.arange(len(each)), some), each, 1.0)
        yield Reading(
            replace(log, outputs=log.outputs / divisors), some,
            f"without the factor {listed(f'{each[k]:g} of {names[k]}' for k in some)} that the"
            " log's TOML gives",
            f"correct the factor of {listed(names[k] for k in some)} under [factors] there",
            ("units",),
        )  # fmt: skip


def unit_readings(
    doubt: Doubt, wanted: Mapping[str, str] | None = None, alone: bool = True,
    together: bool = False,
) -> Iterator[Reading]:  # fmt: skip
    """Yields other units of unexplained outputs, and of inputs that are wanted positions.

    The latter have SI units by name. One column of several of a kind may be in another unit if
    `alone`; wanted positions are in that of the measured ones if `together`.
    """
    log, wanted, ny = doubt.log, wanted or {}, len(doubt.bad)
    names = [*log.output_names, *(n for n in log.input_names if n in wanted)]
    kinds = [_Kind(si := log.units.get(n, ""), log.said_units.get(n, si)) for n in names[:ny]]
    kinds += [_Kind(wanted[n], log.said_units.get(n, wanted[n]), not together) for n in names[ny:]]
    for words in _units(kinds, alone):
        changed = [k for k, word in enumerate(words) if word]
        if not all(doubt.bad[k] for k in changed if k < ny):
            continue
        each = zip(names, words, kinds, strict=True)
        scale = {n: UNITS[word][1] / kind.factor for n, word, kind in each if word}
        other = replace(
            log,
            outputs=log.outputs * [scale.get(n, 1.0) for n in log.output_names],
            inputs=log.inputs * [scale.get(n, 1.0) for n in log.input_names],
        )
        units = {doubt.column[names[k]]: words[k] for k in changed}
        felt = changed if changed[-1] < ny else doubt.wrong
        text = f"were it in {' and '.join(dict.fromkeys(units.values()))}"
        yield Reading(other, felt, text, unit_lines(units), ("units",))


def input_unit_readings(doubt: Doubt, units: Mapping[str, str]) -> Iterator[Reading]:
    """Yields other units of the inputs that drives turn into forces, all of a kind at once."""
    log = doubt.log
    kinds = {n: _Kind(si, log.said_units.get(n, si)) for n, si in units.items()}
    every = dict.fromkeys(kinds.values())
    for kind, word in chain.from_iterable(product([kind], kind.others) for kind in every):
        some = [n for n in log.input_names if kinds.get(n) == kind]
        scale = [UNITS[word][1] / kind.factor if n in some else 1.0 for n in log.input_names]
        lines = unit_lines({doubt.column[n]: word for n in some})
        other = replace(log, inputs=log.inputs * scale)
        yield Reading(other, doubt.wrong, f"were its inputs in {word}", lines, ("units",))


def output_readings(doubt: Doubt, mirrored: bool = True) -> Iterator[Reading]:
    """Yields other signs and places of the outputs that are not explained; see `output_turns`."""
    return chain(output_turns(doubt, mirrored), output_exchanges(doubt))


def output_turns(doubt: Doubt, mirrored: bool = True) -> Iterator[Reading]:
    """Yields the other sign of each unexplained output, and of all of them.

    If that is `mirrored`, all outputs turned look as all inputs turned, and the cure says so.
    """
    log, wrong, names = doubt.log, doubt.wrong, doubt.outputs
    for some in [*([k] for k in wrong), *([wrong] if len(wrong) > 1 else [])]:
        is_mirror = mirrored and len(some) == len(names)
        mirror = f", or of {listed(doubt.inputs)}" if is_mirror else ""
        cure = doubt.how_to_turn([names[k] for k in some], mirror)
        other = replace(log, outputs=turned(log.outputs, some))
        yield Reading(other, some, "with the other sign", cure)


def output_exchanges(doubt: Doubt) -> Iterator[Reading]:
    """Yields two outputs that are not explained, each in the other's place."""
    names = doubt.outputs
    for i, j in column_pairs(doubt.wrong):
        other = replace(doubt.log, outputs=_exchanged(doubt.log.outputs, i, j))
        yield Reading(other, [i, j], "were they exchanged", how_to_exchange(names[i], names[j]))


def input_readings(doubt: Doubt) -> Iterator[Reading]:
    """Yields other signs and places of the inputs."""
    return chain(input_turns(doubt), input_exchanges(doubt))


def input_turns(doubt: Doubt) -> Iterator[Reading]:
    """Yields the other sign of each input."""
    for k, name in enumerate(doubt.inputs):
        other = replace(doubt.log, inputs=turned(doubt.log.inputs, [k]))
        cure = doubt.how_to_turn([name])
        yield Reading(other, doubt.wrong, "with the other sign of an input", cure)


def input_exchanges(doubt: Doubt) -> Iterator[Reading]:
    """Yields two inputs, each in the other's place."""
    names = doubt.inputs
    for i, j in column_pairs(range(len(names))):
        other, cure = _exchanged(doubt.log.inputs, i, j), how_to_exchange(names[i], names[j])
        yield Reading(replace(doubt.log, inputs=other), doubt.wrong, "were inputs exchanged", cure)


def turned_units(doubt: Doubt, wanted: Mapping[str, str] | None = None) -> Iterator[Reading]:
    """Yields another unit of a kind of columns with the other sign of an output or input."""
    for turn in _turns(doubt):
        for unit in unit_readings(replace(doubt, log=turn.log), wanted, alone=False):
            yield _both(unit, turn, "and", unit.log)


def turned_exchanges(doubt: Doubt) -> Iterator[Reading]:
    """Yields two outputs or inputs exchanged, with the other sign of an output or input.

    A sign belongs to a column as it is called after the exchange, as the TOML of a log reads it;
    which of its factors that column then has is not known here.
    """
    for exchange in chain(output_exchanges(doubt), input_exchanges(doubt)):
        for turn in _turns(replace(doubt, log=replace(exchange.log, factors={}))):
            yield _both(exchange, turn, "and, so named,", turn.log)


def two_turns(doubt: Doubt) -> Iterator[Reading]:
    """Yields the other sign of two columns: of unexplained outputs, and of inputs."""
    log, wrong, ny = doubt.log, doubt.wrong, len(doubt.bad)
    names = [*doubt.outputs, *doubt.inputs]
    for pair in combinations([*wrong, *range(ny, len(names))], 2):
        inputs = turned(log.inputs, [k - ny for k in pair])
        other = replace(log, outputs=turned(log.outputs, pair), inputs=inputs)
        felt = [*pair] if max(pair) < ny else wrong
        cure = doubt.how_to_turn([names[k] for k in pair])
        yield Reading(other, felt, "with the other sign of two columns", cure)


def turned(signals: np.ndarray, columns: Sequence[int]) -> np.ndarray:
    """Returns signals, shape (n, m), with the other sign of some columns, in the same units."""
    return signals * np.where(np.isin(np.arange(signals.shape[1]), columns), -1.0, 1.0)


def column_pairs(columns: Sequence[int]) -> list[tuple[int, int]]:
    """Returns the pairs of some columns in their order; of many pairs, those that are nearest."""
    every = list(combinations(columns, 2))
    return sorted(sorted(every, key=lambda pair: pair[1] - pair[0])[:MOST_PAIRS])


def _exchanged(signals: np.ndarray, i: int, j: int) -> np.ndarray:
    return signals[:, [{i: j, j: i}.get(k, k) for k in range(signals.shape[1])]]


def _turns(doubt: Doubt) -> Iterator[Reading]:
    return chain(output_turns(doubt), input_turns(doubt))


def _both(first: Reading, turn: Reading, then: str, log: Log) -> Reading:
    """Returns two readings as one."""
    return Reading(
        log, sorted({*turn.columns, *first.columns}), f"{first.words} and {turn.words}",
        f"{first.cure}, {then} {turn.cure}", tuple(dict.fromkeys((*first.kinds, *turn.kinds))),
    )  # fmt: skip


class _Kind(NamedTuple):
    """What columns have in common that may be in another unit together."""

    si: str  # their SI unit
    said: str  # that of the numbers in the log's file, as it was read
    is_wanted: bool = False  # whether they are set points, and not measured

    @property
    def factor(self) -> float:
        """From the numbers in the log's file to SI, as they were read."""
        return UNITS[self.said][1] if self.said else 1.0

    @property
    def others(self) -> list[str]:
        """Units in which the numbers might be instead."""
        return [w for w, (of, _) in UNITS.items() if of == self.si and w != self.said]


def _units(columns: Sequence[_Kind], alone: bool) -> Iterator[tuple[str, ...]]:
    """Yields other units of columns, "" for as it is: of all of a kind, and of one alone."""
    kinds = [*dict.fromkeys(columns)]
    words = {kind: ["", *kind.others] for kind in kinds}
    for chosen in product(*(words[kind] for kind in kinds)):
        if any(chosen):
            yield tuple(chosen[kinds.index(kind)] for kind in columns)
    for k, kind in enumerate(columns):
        if alone and columns.count(kind) > 1:
            yield from (tuple(w * (i == k) for i in range(len(columns))) for w in words[kind][1:])
