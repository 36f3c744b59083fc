"""The evidence for a law against others in its place: fitted windows, and unseen that decide.

    g_cb = mean_y g_cby
    E_c = n_y W mean_b g_cb - k_c ln W
    P_c = mean over resamples of the blocks of exp(E_c/2) / Σ_k exp(E_k/2)

g_cby: gains of blocks b and outputs y with the law c (`identification.windows.blocks`), W windows
of n_y outputs, k_c numbers that c adds. Each output has an error of its own, as in a likelihood
whose variances are found too: an output that a law predicts to its noise would else count for
nothing beside one whose noise is larger in units of s. E is twice the gain of a log likelihood with
the price that BIC puts on numbers (Schwarz 1978), so that exp(E/2) are the odds of a law in one
resample (Kass, Raftery 1995): two laws that predict alike share them, however surely one is a
little better. Blocks are drawn with replacement (bootstrap; Efron 1979).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification.discovery.options import DiscoveryOptions
from identification.discovery.passes import uses
from identification.prediction.fits.model import WindowModel
from identification.windows.blocks import output_gains

RESAMPLES = 2000  # of the blocks: a probability is then known to a hundredth


def all_gains(without: WindowModel, with_it: WindowModel, options: DiscoveryOptions) -> np.ndarray:
    """Returns g of the blocks of fitted windows, then of unseen ones that decide, shape (B,).

    Args:
        without: the first model.
        with_it: the second one.
        options: whether each output counts by itself.
    """
    before, after = (
        [*(np.mean((e / without.scale) ** 2, axis=1) for e in m.fit.errors),
         *m.unseen.select.of_outputs]
        for m in (without, with_it)
    )  # fmt: skip
    noise = without.unseen.noise
    if not uses(options, "gains_of_outputs"):
        before, after = ([x.mean(axis=1, keepdims=True) for x in each] for each in (before, after))
        noise = np.array([without.unseen.floor])
    return np.concatenate(output_gains(before, after, noise))


def count_windows(model: WindowModel) -> int:
    """Returns the number of windows of the horizon, fitted ones and unseen ones that decide."""
    fitted = sum(len(p.cut.starts) for p in model.fit.problem.parts)
    return fitted + sum(len(s) for s in model.unseen.select.at_horizon)


def evidence(
    gains: Sequence[np.ndarray], numbers: Sequence[int], windows: int, outputs: int
) -> np.ndarray:
    """Returns E of each law in each resample of the blocks, shape (k, R); the first is of all.

    Args:
        gains: of each law, by block, shape (B,).
        numbers: that each law adds to the model.
        windows: W.
        outputs: n_y.
    """
    g = np.array(gains)  # (k, B)
    rng = np.random.default_rng(0)  # a verdict repeats
    drawn = rng.integers(0, g.shape[1], (RESAMPLES, g.shape[1]))
    means = np.concatenate([g.mean(axis=1)[:, None], g[:, drawn].mean(axis=2)], axis=1)
    price = np.array(numbers)[:, None] * np.log(max(2, windows))
    return np.asarray(outputs * windows * means - price)


def compute_confidence(evidences: np.ndarray) -> np.ndarray:
    """Returns P of each law, shape (k,).

    Args:
        evidences: E, shape (k, R), of `evidence`.
    """
    odds = np.exp((evidences - evidences.max(axis=0))[:, 1:] / 2)
    return np.asarray((odds / odds.sum(axis=0)).mean(axis=1))
