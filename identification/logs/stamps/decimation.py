"""A log with fewer samples: every n-th output, and the inputs that do the same work.

    u(t) = Σ_k c_k φ_k(t),     c = argmin ∫ (u_logged(t) - u(t))² dt

φ_k are the basis functions of the new hold. For "zoh" they are boxes between samples, and c_k is
the mean. For "foh" they are the hat functions of straight lines; c_k is a weighted mean over the
samples on both sides of the stamp, which also keeps the first moment of the input between two
samples, so that nothing is shifted in time. The outputs are not filtered: a mean would take away
from their curvature, and from the inputs another part.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np

from identification.errors import InputError
from identification.logs.log import Log


def decimate(log: Log, every: int, hold: Literal["zoh", "foh"] = "foh") -> Log:
    """Returns every n-th sample of a log, with inputs that do the same work between them.

    Args:
        log: its inputs are held (hold "zoh") or straight lines between samples ("foh"); its extras
            are sampled in the same way as its outputs.
        every: n.
        hold: the hold of the new inputs.

    Raises:
        InputError: fewer than 3 samples are left.
    """
    n = (len(log) - 1) // every if every >= 1 else 0
    if n < 2:
        raise InputError(
            f"every {every}-th of {len(log)} samples makes no log of 3 samples; take fewer away"
        )
    rows = slice(0, n * every + 1, every)
    shape = n, every, log.inputs.shape[1]  # a log of a free swing has no inputs
    first = log.inputs[: n * every].reshape(shape)  # inputs where the short steps begin
    last = first  # and where they end: the same, where they are held
    if log.hold == "foh":
        last = log.inputs[1 : n * every + 1].reshape(shape)
    if hold == "zoh":
        means = ((first + last) / 2).mean(axis=1)
        inputs = np.concatenate([means, log.inputs[n * every][None]])
    else:
        inputs = _lines(first, last)
    return replace(
        log,
        time=log.time[rows],
        inputs=inputs,
        outputs=log.outputs[rows],
        extras={name: column[rows] for name, column in log.extras.items()},
        hold=hold,
    )


def _lines(first: np.ndarray, last: np.ndarray) -> np.ndarray:
    """Computes the corners of the straight lines nearest to inputs, shape (n + 1, nu).

    The inputs are given where each of the `every` short steps of a long one begins and where it
    ends, each of shape (n, every, nu); between both they are a straight line.
    """
    n, every, nu = first.shape
    middle = (np.arange(every) + 0.5) / every  # of each short step, on the rising half of a hat
    mean, rise = (first + last) / 2, (last - first) / (12 * every)
    b = np.zeros((n + 1, nu))
    # The integral of the product of two straight lines is that of their means, and a twelfth of
    # the product of their rises.
    b[:-1] += (np.einsum("i,kiu->ku", 1 - middle, mean) - rise.sum(axis=1)) / every
    b[1:] += (np.einsum("i,kiu->ku", middle, mean) + rise.sum(axis=1)) / every
    diagonal = np.full(n + 1, 2 / 3)
    diagonal[[0, -1]] = 1 / 3
    from scipy.linalg import solveh_banded  # slow to import

    return solveh_banded(np.vstack([np.full(n + 1, 1 / 6), diagonal]), b)
