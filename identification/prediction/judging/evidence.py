"""The evidence for a law against others in its place: fitted windows, and unseen that decide.

    E_c = W Σ_y n_y mean_b g_cby - k_c ln(W n)
    P_c = mean over resamples of the blocks of exp(E_c/2) / Σ_k exp(E_k/2)

g_cby: gains of blocks b and outputs y with the law c (`identification.windows.blocks`), W windows,
each with n_y independent readings of output y (`fits.readings`), n: their mean over outputs, k_c
numbers that c adds. Each output has an error of its own, as in a likelihood whose variances are
found too: an output that a law predicts to its noise would else count for nothing beside one whose
noise is larger in units of s. E is twice the gain of a log likelihood with the price that BIC puts
on numbers (Schwarz 1978), so that exp(E/2) are the odds of a law in one resample (Kass, Raftery
1995): two laws that predict alike share them, however surely one is a little better. Blocks are
drawn with replacement (bootstrap; Efron 1979).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from identification.discovery.options import DiscoveryOptions
from identification.discovery.passes import uses
from identification.prediction.fits.model import WindowModel
from identification.prediction.fits.readings import independent_readings
from identification.windows.blocks import output_gains

RESAMPLES = 2000  # of the blocks: a probability is then known to a hundredth


@dataclass(frozen=True)
class Gains:
    """What one model predicts better than another, and how many readings tell it."""

    blocks: np.ndarray  # Σ_y n_y g_by/Σ_y n_y, shape (B,)
    readings: float  # W n, of one output


def all_gains(without: WindowModel, with_it: WindowModel, options: DiscoveryOptions) -> Gains:
    """Returns the gains of blocks of fitted windows, then of unseen ones that decide.

    Args:
        without: the first model.
        with_it: the second one.
        options: whether each output counts by itself, and by its independent readings.
    """
    before, after = (
        [*(np.mean((e / without.scale) ** 2, axis=1) for e in m.fit.errors),
         *m.unseen.select.of_outputs]
        for m in (without, with_it)
    )  # fmt: skip
    noise, windows = without.unseen.noise, sum(map(len, before))
    count = np.ones(len(noise))
    if uses(options, "independent_readings"):
        count = independent_readings(without.fit)
    weights = count / count.mean()
    if not uses(options, "gains_of_outputs"):
        before, after = ([x.mean(axis=1, keepdims=True) for x in each] for each in (before, after))
        noise, weights = np.array([without.unseen.floor]), np.ones(1)
    gains = output_gains(before, after, noise, weights)
    return Gains(np.concatenate(gains), windows * float(count.mean()))


def evidence(
    gains: Sequence[Gains], numbers: Sequence[int], outputs: int
) -> np.ndarray:  # fmt: skip
    """Returns E of each law in each resample of the blocks, shape (k, R); the first is of all.

    Args:
        gains: of each law.
        numbers: that each law adds to the model.
        outputs: their number.
    """
    g = np.array([each.blocks for each in gains])  # (k, B)
    readings = np.array([max(2.0, each.readings) for each in gains])[:, None]
    rng = np.random.default_rng(0)  # a verdict repeats
    drawn = rng.integers(0, g.shape[1], (RESAMPLES, g.shape[1]))
    means = np.concatenate([g.mean(axis=1)[:, None], g[:, drawn].mean(axis=2)], axis=1)
    price = np.array(numbers)[:, None] * np.log(readings)
    return np.asarray(outputs * readings * means - price)


def compute_confidence(evidences: np.ndarray) -> np.ndarray:
    """Returns P of each law, shape (k,).

    Args:
        evidences: E, shape (k, R), of `evidence`.
    """
    odds = np.exp((evidences - evidences.max(axis=0))[:, 1:] / 2)
    return np.asarray((odds / odds.sum(axis=0)).mean(axis=1))
