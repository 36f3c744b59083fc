"""Proof on unseen data: does an effect predict samples better that no fit has seen?

    Δ_b = ½ Σ_{k in b} ‖E_k(without)‖² - ‖E_k(with)‖²        over blocks b of unseen samples
    t = mean(Δ_b)/(std(Δ_b)/√B)

    share = (rms²(without) - rms²(with))/(rms²(without) - σ² - d²)

Both residuals pass the filter of the model without the effect, so that neither predictor follows
the data more closely than the other; d is what input errors do to a free run.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from threadpoolctl import threadpool_limits

from identification.discovery.result import Gap, Proof
from identification.kalman.noise_model import Whitener, whitener
from identification.kalman.point import beyond
from identification.kalman.refit import Refit
from identification.log import Log
from identification.metrics import fit_percent

BLOCKS = 20


@dataclass(frozen=True)
class Unseen:
    """A fit on the whole log, of which it has seen the beginning.

    Attributes:
        refit: the fit.
        e: free-run residual, shape (N, ny).
        innovations: whitened, in units of σ, shape (N, ny).
        filter: what whitened them.
        first: first unseen sample.
        disturbance: rms of what input errors do to the free run on the unseen samples.
    """

    refit: Refit
    e: np.ndarray
    innovations: np.ndarray
    filter: Whitener
    first: int
    disturbance: float

    @property
    def rms(self) -> float:
        """Of the free run on the unseen samples."""
        return float(np.sqrt(np.mean(self.e[self.first :] ** 2)))

    def gap(self, log: Log) -> Gap:
        """The free-run error on the unseen samples of a log."""
        measured = log.outputs[self.first :]
        return Gap(self.rms, fit_percent(measured, measured - self.e[self.first :]))


def unseen(fit: Refit, whole: Log) -> Unseen:
    """A fit, predicted over the whole log."""
    at = beyond(fit.at, whole)
    first = len(fit.at.log)
    with threadpool_limits(1, "blas"):
        filter_ = whitener(at.linear, fit.level.noise, whole.sampling_time)
        E = filter_(at.e) / fit.level.sigma
        moved = _disturbed(filter_.A, filter_.C, fit.level.noise.ratio, at.linear.B.shape[2])
    disturbance = fit.level.sigma * np.sqrt(moved[first:].mean()) if moved.size else 0.0
    return Unseen(fit, at.e, E, filter_, first, float(disturbance))


def _disturbed(A: np.ndarray, C: np.ndarray, ratio: float, nu: int) -> np.ndarray:
    """Variance that input errors put on the outputs of a free run, mean over them, shape (N,)."""
    if not A.size:
        return np.zeros(0)
    P = np.zeros(A.shape[1:])
    P[-nu:, -nu:] = ratio**2 * np.eye(nu)
    out = [0.0]
    for step in A:
        a = step[-1, -1]
        P = step @ P @ step.T
        P[-nu:, -nu:] += (1 - a**2) * ratio**2 * np.eye(nu)
        out.append(float(np.einsum("ij,jk,ik->", C, P, C)) / len(C))
    return np.array(out)


def prove(without: Unseen, with_it: Unseen) -> Proof:
    """What the second of two fits does for the unseen samples."""
    with threadpool_limits(1, "blas"):
        E = without.filter(with_it.e) / without.refit.level.sigma
    fewer = np.sum(without.innovations**2 - E**2, axis=1) / 2
    gain = fewer[with_it.first :]
    starts = np.linspace(0, len(gain), min(BLOCKS, len(gain) // 5), endpoint=False).astype(int)
    blocks = np.add.reduceat(gain, starts)
    scatter = blocks.std(ddof=1) / np.sqrt(len(blocks))
    t = float(blocks.mean() / scatter) if scatter > 0 else 0.0
    floor = with_it.refit.level.sigma**2 + with_it.disturbance**2
    above = without.rms**2 - min(floor, with_it.rms**2)
    closed = without.rms**2 - with_it.rms**2
    sensed = without.rms**2 - min(with_it.refit.level.sigma, with_it.rms) ** 2
    return Proof(
        float(gain.sum()),
        t,
        float(closed / above) if above > 0 else 0.0,
        float(closed / without.rms**2),
        float(closed / sensed) if sensed > 0 else 0.0,
    )
