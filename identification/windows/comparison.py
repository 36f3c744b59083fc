"""Comparison of the predictions of two models on records that no fit has seen.

Gains of blocks of neighbouring windows (`identification.windows.blocks`) are the sample of a
t-test and of a test of signed ranks, for windows of each length that both models predict. The gain
of a block is the mean over the outputs of the gain of each: in the mean square over all outputs,
the noise of one that was never wrong hides what another one gains. Records are
strata: a drag may gain nothing in a slow record and much in every block of a fast one, and that the
two differ does not make their mean gain less sure. What acts seldom gains much in few blocks and a
little in many: their scatter then hides their mean from the t-test, and their ranks show it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from identification.chances import ranks_above_zero, stratified_mean_above_zero
from identification.windows.blocks import LEAST_NOISE, output_gains
from identification.windows.unseen import Unseen


@dataclass(frozen=True, kw_only=True)
class Prediction:
    """The gain of one model's predictions over another's."""

    t: float  # of the mean gain over blocks, at the horizon
    chance: float  # of as much by luck, by Student's t
    rank_chance: float  # likewise, by the ranks of the gains
    gain: float
    gains: tuple[float, ...]  # mean gain over blocks, by length of the windows
    fall: float  # the one at the horizon, and `gain` likewise
    falls: tuple[float, ...]  # relative fall of the mean square over all records, by length
    # the same of each output of each record by itself, in the geometric mean: one that errs most,
    # whatever the model, does not decide alone
    typical_falls: tuple[float, ...]
    output_falls: tuple[float, ...]  # the same at the horizon, of each output
    # mean square of each output's error under the first model over that of its noise; inf without
    times_noise: tuple[float, ...]
    record_falls: tuple[float, ...]  # relative fall of the mean square by record, at the horizon
    # gain of each block of each record, at the horizon, shape (B,) a record
    blocks: tuple[np.ndarray, ...]
    # the same on windows on which a search does not decide; None where none are kept
    untouched: Prediction | None = None

    @property
    def told(self) -> Prediction:
        """The prediction whose numbers are told: on untouched windows, where some are kept."""
        return self.untouched or self

    @property
    def records(self) -> tuple[float, ...]:
        """Mean gain over blocks of each record, at the horizon."""
        return tuple(float(g.mean()) for g in self.blocks)

    @property
    def is_everywhere(self) -> bool:
        """Tells whether windows of every length are predicted better on average."""
        return min(self.gains) > 0 and min(self.typical_falls) > 0


def compare(
    without: Unseen, with_it: Unseen, *, by_outputs: bool = True, by_records: bool = True
) -> Prediction:
    """Returns what the second of two models predicts better, over lengths that both have.

    It is of the windows on which a search decides; what is to be told of it is its `told`.

    Args:
        without: errors of the first model.
        with_it: of the second one.
        by_outputs: whether each output counts by itself.
        by_records: whether blocks scatter about the mean of their record, or about that of all.
    """
    decided = _compare(without.select, with_it.select, by_outputs, by_records)
    if not any(with_it.parts):
        return decided
    told = _compare(without.report, with_it.report, by_outputs, by_records)
    return replace(decided, untouched=told)


def joined(one: Prediction, other: Prediction) -> Prediction:
    """Returns the first of two predictions, its test and its records those of both.

    Args:
        one: of some records.
        other: of other ones, which the fit of the first has seen and its own has not.
    """
    blocks = (*one.blocks, *other.blocks)
    t, chance = stratified_mean_above_zero(blocks)
    return replace(
        one, t=t, chance=chance, rank_chance=ranks_above_zero(np.concatenate(blocks)),
        record_falls=(*one.record_falls, *other.record_falls), blocks=blocks,
    )  # fmt: skip


def _compare(without: Unseen, with_it: Unseen, by_outputs: bool, by_records: bool) -> Prediction:
    """Returns the same of all windows of two models."""
    falls, of_outputs, gains = [], [], []
    lengths = [n for n in without.lengths if n in with_it.lengths]
    for length in lengths:
        a, b = (_powers(u, length, by_outputs) for u in (without, with_it))
        noise = without.noise if by_outputs else np.array([without.floor])
        falls.append(1 - float(np.concatenate(b).mean() / np.concatenate(a).mean()))
        of_outputs.append(_log_ratios(a, b))
        gains.append(output_gains(a, b, noise))
    at = lengths.index(1.0)
    blocks, means = gains[at], tuple(float(np.concatenate(g).mean()) for g in gains)
    every = np.concatenate(blocks)
    t, chance = 0.0, 1.0
    if len(every) > 2 and every.std() > 0:
        t, chance = stratified_mean_above_zero(blocks if by_records else [every])
    each = zip(without.at_horizon, with_it.at_horizon, strict=True)
    return Prediction(
        t=t, chance=chance, rank_chance=ranks_above_zero(every), gain=means[at], gains=means,
        fall=falls[at], falls=tuple(falls),
        typical_falls=tuple(1 - float(np.exp(logs.mean())) for logs in of_outputs),
        output_falls=tuple((1 - np.exp(of_outputs[at])).tolist()),
        times_noise=_times_noise(without, by_outputs),
        record_falls=tuple(1 - float(b.mean() / a.mean()) for a, b in each), blocks=tuple(blocks),
    )  # fmt: skip


def _times_noise(unseen: Unseen, by_outputs: bool) -> tuple[float, ...]:
    """Returns the mean square of each output, or of all together, over that of the noise."""
    squares = np.concatenate(_powers(unseen, 1.0, by_outputs)).mean(axis=0)
    noise = unseen.noise if by_outputs else np.array([unseen.floor])
    ratios = np.divide(squares, noise, out=np.full(len(squares), np.inf), where=noise > 0)
    return tuple(ratios.tolist())


def _powers(unseen: Unseen, length: float, by_outputs: bool) -> list[np.ndarray]:
    """Returns mean squares over windows, (W, ny) or of all outputs together (W, 1), by record."""
    each = unseen.powers[unseen.lengths.index(length)]
    return [x if by_outputs else x.mean(axis=1, keepdims=True) for x in each]


def _log_ratios(without: Sequence[np.ndarray], with_it: Sequence[np.ndarray]) -> np.ndarray:
    """Returns ln(mean square with it/mean square without) of each output, mean over records."""
    before, after = (
        np.array([x.mean(axis=0) for x in powers]) + LEAST_NOISE for powers in (without, with_it)
    )
    return np.asarray(np.mean(np.log(after / before), axis=0))


def rise(begun: Unseen, fitted: Unseen) -> float:
    """Returns the relative rise of the mean square at the horizon from before a fit to after it."""
    before, after = (float(np.mean(np.concatenate(u.at_horizon))) for u in (begun, fitted))
    return after / before - 1
