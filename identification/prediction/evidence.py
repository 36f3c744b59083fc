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

A law that brings states z of joints, such as what a servo has summed up, finds them anew in each
window, unseen ones too. A state that is free there draws a constant force in each window, whatever
makes it. So each window pays for what its readings tell of such a state (Laplace; MacKay 1992):

    g_cb -> g_cb - 1/n_y Σ_z mean_w ln(1 + s_z² h_zw)
    h_zw = |Z⊥|²/(L σ²),    s_z² = max(0, Σ_w (h_zw d_zw² - 1)/Σ_w h_zw)

Z⊥: slope of the L n_y errors of a window along z without what its other states make up for, of mean
square σ², d_z: how far z was moved from where it was expected. A window is one sample here too, and
s_z is how far the windows show z to scatter: a state that is where it was expected costs nothing.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification.discovery.options import DiscoveryOptions
from identification.discovery.passes import uses
from identification.prediction.model import WindowModel
from identification.windows.blocks import output_gains
from identification.windows.shooting import Tangent

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
    price = states_price(without, with_it) if uses(options, "price_of_states") else 0.0
    return np.concatenate(output_gains(before, after, noise)) - price / len(noise)


def states_price(without: WindowModel, with_it: WindowModel) -> float:
    """Returns what a window pays for the states of joints that only the second model has.

    Args:
        without: the first model.
        with_it: the second one, of whose states the last may be new.
    """
    new = with_it.plant.model.na - without.plant.model.na
    if new <= 0:
        return 0.0
    each = zip(with_it.fit.problem.parts, with_it.fit.tangents, strict=True)
    told = [_told_of_states(part.cut.outputs[0].size, t, new) for part, t in each]
    squares = np.mean(np.concatenate([r.ravel() for r, _ in told]) ** 2)
    samples = with_it.fit.problem.parts[0].cut.outputs.shape[1]
    h = np.concatenate([information for _, information in told]) / (samples * squares)
    return price_of_states(h, np.concatenate([d[:, -new:] for d in with_it.fit.moves]))


def _told_of_states(readings: int, t: Tangent, new: int) -> tuple[np.ndarray, np.ndarray]:
    """Returns errors of windows (W, L ny), and |Z⊥|² of their last states, shape (W, new)."""
    X = (t.U * t.s[:, None]) @ t.Vt * t.size[:, None]
    H = np.swapaxes(X, 1, 2) @ X
    Z = X[:, :readings, -new:]
    others = X[..., :-new]
    along = np.linalg.solve(H[:, :-new, :-new], np.swapaxes(others[:, :readings], 1, 2) @ Z)
    told = np.sum(Z * (Z - others[:, :readings] @ along), axis=1)
    return t.r[:, :readings], np.maximum(0.0, told)


def price_of_states(h: np.ndarray, d: np.ndarray) -> float:
    """Returns Σ_z mean_w ln(1 + s_z² h_zw).

    Args:
        h: what a window tells of a state, shape (W, z).
        d: where the windows find the states, from where they were expected, shape (W, z).
    """
    total = h.sum(axis=0)
    scatter = np.divide(
        np.sum(h * d**2 - 1, axis=0), total, out=np.zeros_like(total), where=total > 0
    )
    return float(np.log1p(np.maximum(0.0, scatter) * h).mean(axis=0).sum())


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
