"""The unseen samples of a log: how a fitted model predicts them, and whether an effect helps.

    cov(r) = G K Gᵀ        what errors of the inputs, of covariance K, do to a free run
    Δ_b = ½ Σ_{k in b} ‖E_k(without)‖² - ‖E_k(with)‖²        over blocks b of unseen samples
    t = mean(Δ_b)/(std(Δ_b)/√B)
    chance = P(Σ_b s_b Δ_b >= Σ_b Δ_b)        s_b = ±1, all choices equally likely
    share = (rms²(without) - rms²(with))/(rms²(without) - σ² - d²)

All of it is of one part of the unseen samples (`identification.logs.parts`): a search decides on
`select`, and `report` is told.

The chance decides, and not t: an effect that acts only at times gains much in few blocks and a
little in the others, and that skew makes t small although every block gains. Flips of the signs
need no normal distribution. Both residuals pass the filter of the model without the effect, so that
neither predictor follows the data more closely than the other. rms is that of the free run, and d
is what input errors do to it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from identification.chances import student_above
from identification.discovery.effect_results import Gap, Proof
from identification.discovery.options import DiscoveryOptions
from identification.discovery.passes import uses
from identification.estimation.metrics import fit_percent, rms_by_unit
from identification.kalman.noise_model import Whitener, build_whitener
from identification.kalman.point import extend_point
from identification.kalman.recursion import propagate
from identification.kalman.refit import Refit
from identification.logs.joined import records_of, rows_of
from identification.logs.log import Log
from identification.logs.parts import Part, Parts, autocorrelation_time, divide, join
from identification.runtime.pool import one_blas_thread

MIN_PROOF_SAMPLES = 5  # of a block of unseen samples
MAX_FLIPPED_BLOCKS = 32  # 2^16 sums of each half; of more blocks neighbours are added
ROUNDING = 1e-12  # of the blocks' sizes: sums that differ by less are one


@dataclass(frozen=True, kw_only=True, eq=False)
class Validation:
    """The prediction of a whole log by a model that was fitted on a part of it."""

    refit: Refit  # the fit
    log: Log  # the whole log, of N samples
    e: np.ndarray  # residual of the free run, shape (N, ny)
    innovations: np.ndarray  # whitened residual in units of σ, shape (N, ny)
    filter: Whitener  # the whitening filter
    seen: np.ndarray  # true for the samples that were fitted, shape (N,)
    parts: Parts  # the samples on which the search decides, and those that are told of
    moved: np.ndarray  # variance over σ² that input errors cause in the free run, shape (N, ny)

    def rms(self, part: Part) -> float:
        """Returns the rms of the free run's error on a part, over all outputs."""
        return float(np.sqrt(np.mean(self.e[self.parts.rows(part)] ** 2)))

    def disturbances(self, part: Part) -> np.ndarray:
        """Returns the rms of what input errors do to each output there, (ny,), in its unit."""
        share = self.moved[self.parts.rows(part)].mean(axis=0)
        return np.asarray(self.refit.level.sigma * np.sqrt(share))

    def disturbance(self, part: Part) -> float:
        """Returns the same over all outputs."""
        return float(np.sqrt(np.mean(self.disturbances(part) ** 2)))

    @property
    def noise(self) -> np.ndarray:
        """Rms of the fitted samples' innovations, of each output, shape (ny,), in its unit."""
        E = self.innovations[self.seen]
        return np.asarray(self.refit.level.sigma * self.filter.s * np.sqrt(np.mean(E**2, axis=0)))

    @property
    def gap(self) -> Gap:
        """The error of the free run on the samples that are told of."""
        told = self.parts.report
        y, e = self.log.outputs[told], self.e[told]
        return Gap(self.rms("report"), fit_percent(y, y - e), rms_by_unit(e, self.log))


def validate(fit: Refit, log: Log, parts: Parts | None = None) -> Validation:
    """Predict a whole log with a fit.

    Args:
        fit: of the log's part `estimation`.
        log: the whole log.
        parts: of the samples that are not fitted; None where nothing has been told apart.

    Raises:
        DivergenceError: the model cannot be simulated over the whole log.
    """
    point = extend_point(fit.point, log)
    seen = rows_of(log, "estimation")
    with one_blas_thread():
        filter_ = build_whitener(point.linear, fit.level.noise, log.sampling_time)
        E = filter_(point.e) / fit.level.sigma
        moved = np.zeros_like(point.e)
        if filter_.system is not None:
            moved[1:] = propagate(filter_.system)
    return Validation(
        refit=fit, log=log, e=point.e, innovations=E, filter=filter_, seen=seen,
        parts=parts or Parts(~seen, ~seen, 0),
        moved=moved,
    )  # fmt: skip


def divide_unseen(validation: Validation, options: DiscoveryOptions) -> Parts:
    """Returns the parts of the unseen samples of each record, by the memory of the fitted ones.

    Args:
        validation: of the model without effects.
        options: whether a part is kept that the search does not use, and the fewest samples that
            must decide.
    """
    squares, begun = np.sum(validation.innovations**2, axis=1), 0
    fitted, unseen = [], []
    for _, record in records_of(validation.log):
        rows = slice(begun, begun := begun + len(record))
        unseen.append(~validation.seen[rows])
        fitted.append(squares[rows][validation.seen[rows]])
    memory = autocorrelation_time([x for x in fitted if len(x)])
    every, *kept = (
        join([divide(rows, MIN_PROOF_SAMPLES, memory, keep) for rows in unseen])
        for keep in (False, True)[: 1 + uses(options, "untouched_part")]
    )
    # What decides must be as much as a search asks of unseen samples at least.
    return next((parts for parts in kept if parts.select.sum() >= options.min_samples), every)


def prove(without: Validation, with_it: Validation, options: DiscoveryOptions) -> Proof:
    """Returns how much better the second of two fits predicts the unseen samples that decide.

    What is to be told of it, on the other ones, is its `told`.

    Args:
        without: the model without an effect.
        with_it: the model with it.
        options: the number of blocks.
    """
    with one_blas_thread():
        E = without.filter(with_it.e) / without.refit.level.sigma
    fewer = np.sum(without.innovations**2 - E**2, axis=1) / 2
    decided = _prove_on("select", fewer, without, with_it, options)
    if np.array_equal(with_it.parts.select, with_it.parts.report):
        return decided
    return replace(decided, untouched=_prove_on("report", fewer, without, with_it, options))


def _prove_on(
    part: Part, fewer: np.ndarray, without: Validation, with_it: Validation,
    options: DiscoveryOptions,
) -> Proof:  # fmt: skip
    """Returns the proof on one part, from the gain of each sample of the log, (N,)."""
    gain = fewer[with_it.parts.rows(part)]
    blocks = _blocks(gain, options)
    least = 2 * MIN_PROOF_SAMPLES
    each = [(name, part) for name, part in _by_record(with_it, fewer, part) if len(part) >= least]
    floor = with_it.refit.level.sigma**2 + with_it.disturbance(part) ** 2
    before, after = (v.rms(part) ** 2 for v in (without, with_it))
    above = before - min(floor, after)
    closed = before - after
    sensed = before - min(with_it.refit.level.sigma**2, after)
    return Proof(
        gain=float(gain.sum()),
        t=_t(blocks),
        chance=flip_chance(blocks),
        blocks=len(blocks),
        share=float(closed / above) if above > 0 else 0.0,
        fall=float(closed / before),
        above=float(closed / sensed) if sensed > 0 else 0.0,
        agrees=tuple(name for name, part in each if part.sum() > 0),
        disagrees=tuple(name for name, part in each if is_beyond(-_blocks(part, options), options)),
    )


def _by_record(
    validation: Validation, gain: np.ndarray, part: Part
) -> Iterator[tuple[str, np.ndarray]]:
    """Yields the name of each record and the gains of a part of its unseen samples."""
    begun, inside = 0, validation.parts.rows(part)
    for _, record in records_of(validation.log):
        rows = slice(begun, begun := begun + len(record))
        yield record.name, gain[rows][inside[rows]]


def is_beyond(blocks: np.ndarray, options: DiscoveryOptions) -> bool:
    """Returns whether blocks gain beyond chance: beyond what Student's t allows at `min_proof_t`.

    Args:
        blocks: gain of each block, shape (B,).
        options: which t a normal distribution would need.
    """
    return flip_chance(blocks) < allowed_chance(len(blocks), options)


def allowed_chance(count: int, options: DiscoveryOptions) -> float:
    """Returns the chance of a t above `min_proof_t`, one-sided, for so many blocks."""
    return student_above(options.min_proof_t, count - 1)


def flip_chance(blocks: np.ndarray) -> float:
    """Returns the share of all flips of the blocks' signs whose sum is at least the sum itself.

    All 2^B sums are counted: those of one half of the blocks against those of the other half.
    (`scipy.stats.permutation_test` draws flips by chance beyond a dozen blocks.)

    Args:
        blocks: gain of each block, shape (B,); of more than `MAX_FLIPPED_BLOCKS`, neighbours are
            added.
    """
    while len(blocks) > MAX_FLIPPED_BLOCKS:
        blocks = np.add.reduceat(blocks, np.arange(0, len(blocks), 2))
    half = len(blocks) // 2
    one, other = (_signed_sums(part) for part in (blocks[:half], blocks[half:]))
    scale = np.abs(blocks).sum()
    least = blocks.sum() - ROUNDING * scale - one
    enough = len(other) - np.searchsorted(np.sort(other), least)
    return float(enough.sum() / (len(one) * len(other)))


def _signed_sums(blocks: np.ndarray) -> np.ndarray:
    """Returns the sums of the blocks with every choice of their signs, shape (2^B,)."""
    sums = np.zeros(1)
    for gain in blocks:
        sums = np.concatenate([sums + gain, sums - gain])
    return sums


def _blocks(gain: np.ndarray, options: DiscoveryOptions) -> np.ndarray:
    """Returns the gains of blocks of neighbouring samples, shape (B,)."""
    count = min(options.proof_blocks, len(gain) // MIN_PROOF_SAMPLES)
    starts = np.linspace(0, len(gain), count, endpoint=False).astype(int)
    return np.add.reduceat(gain, starts)


def _t(blocks: np.ndarray) -> float:
    """Returns Student's t of the gain by blocks."""
    scatter = blocks.std(ddof=1) / np.sqrt(len(blocks))
    return float(blocks.mean() / scatter) if scatter > 0 else 0.0
