"""The share of a log that a mere replay of other logs explains, without any model.

    R = 1 - Σ_blocks min_s Σ_t ‖z(t) - z_f(t - s)‖² / Σ_blocks Σ_t ‖z(t)‖²      about block means

z are the inputs and outputs of a log, each divided by its std there, and z_f those of other logs,
without the mean of a block, because an axis that integrates drifts; twice the variance of the noise
is taken off the error. Each quarter of the log stands beside the most alike piece of the others.
Where R is above 0.95 a replay leaves as little as a model that is said to explain a log.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification.logs.log import Log
from identification.logs.noise import noise_floor

REPLAYED = 0.95  # R above which a log says little beside the others
BLOCKS = 4


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
    own = np.sum(power - sums**2 / size, axis=1)
    return float(np.min(own - 2 * across) + np.sum(block**2))
