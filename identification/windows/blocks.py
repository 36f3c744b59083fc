"""Blocks of neighbouring windows of a record: the sample of every comparison of two models.

    g_b = ln(mean_w e_w²(without) + ε²) - ln(mean_w e_w²(with) + ε²),       w in block b

e_w² is the mean square of the errors of a window in units of s², over its samples and outputs.
Within a block windows count by their squares, so that those in which nothing happens do not decide;
blocks count by logarithms, so that no block and no record decides alone. ε is the sensors' noise.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

# Blocks of a record at most, of two windows where it has two; as `proof_blocks`.
MAX_BLOCKS_PER_RECORD = 20


# Of s²: what an output's noise is taken to be at least. An encoder that rests has none, and what is
# a thousandth of the error of the model without effects is no reason for a law.
LEAST_NOISE = 1e-6


def count_blocks(windows: int) -> int:
    """Returns how many blocks a record with so many windows has."""
    return min(MAX_BLOCKS_PER_RECORD, max(1, windows // 2))


def output_gains(
    without: Sequence[np.ndarray], with_it: Sequence[np.ndarray], noise: np.ndarray,
    weights: np.ndarray | None = None,
) -> list[np.ndarray]:  # fmt: skip
    """Returns the mean over the outputs of g of each, of the blocks of each record, shape (B,).

    Args:
        without: mean square of each output over each window under the first model, shape (W, ny),
            a record each, in units of s².
        with_it: the same under the second model.
        noise: ε² of each output, shape (ny,), in these units.
        weights: of each output, shape (ny,), 1 on average; ones where None.
    """
    each_weight = np.ones(len(noise)) if weights is None else weights
    each = [
        block_gains([x[:, y] for x in without], [x[:, y] for x in with_it], max(e, LEAST_NOISE))
        for y, e in enumerate(noise)
    ]
    return [each_weight @ np.array(of_record) / len(noise) for of_record in zip(*each, strict=True)]


def block_gains(
    without: Sequence[np.ndarray], with_it: Sequence[np.ndarray], floor: float
) -> list[np.ndarray]:
    """Returns g of the blocks of each record, shape (B,).

    Args:
        without: mean square of each window under the first model, shape (W,), a record each, in
            units of s².
        with_it: the same under the second model.
        floor: ε², in units of s².
    """
    out = []
    for a, b in zip(without, with_it, strict=True):
        before, after = (
            np.array([w.mean() for w in np.array_split(squares, count_blocks(len(a)))])
            for squares in (a, b)
        )
        out.append(np.log(before + floor) - np.log(after + floor))
    return out
