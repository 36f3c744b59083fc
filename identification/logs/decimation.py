"""A log with fewer samples: every n-th output, and the inputs that do the same work.

    u(t) = Σ_k c_k φ_k(t),     c = argmin ∫ (u_logged(t) - u(t))² dt

φ_k are the basis functions of the new hold. For "zoh" they are boxes between samples, and c_k is
the mean. For "foh" they are the hat functions of straight lines, which also keep the first moment
of the input between two samples. The outputs are not filtered: a filter would delay the outputs
against the inputs, and a fit would find this delay.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np
from scipy.linalg import solveh_banded

from identification.errors import InputError
from identification.logs.log import Log


def decimate(log: Log, every: int, hold: Literal["zoh", "foh"] = "foh") -> Log:
    """Every n-th sample of a log whose inputs were held between samples.

    Args:
        log: a log of hold "zoh"; its extras are sampled in the same way as its outputs.
        every: n.
        hold: the hold of the new inputs.

    Raises:
        InputError: the hold of the log is not "zoh", or fewer than 3 samples are left.
    """
    n = (len(log) - 1) // every if every >= 1 else 0
    if n < 2 or log.hold != "zoh":
        raise InputError(
            f"every {every}-th of {len(log)} samples of hold {log.hold!r} makes no log; take fewer"
            " away, from a log of hold 'zoh'"
        )
    rows = slice(0, n * every + 1, every)
    boxes = log.inputs[: n * every].reshape(n, every, log.inputs.shape[1])
    if hold == "zoh":
        inputs = np.concatenate([boxes.mean(axis=1), log.inputs[n * every][None]])
    else:
        inputs = _lines(boxes)
    return replace(
        log,
        time=log.time[rows],
        inputs=inputs,
        outputs=log.outputs[rows],
        extras={name: column[rows] for name, column in log.extras.items()},
        hold=hold,
    )


def _lines(boxes: np.ndarray) -> np.ndarray:
    """Corners of the straight lines nearest to held inputs (n, every, nu), shape (n + 1, nu)."""
    n, every, nu = boxes.shape
    rise = (np.arange(every) + 0.5) / every  # mean of the rising half of a hat over each box
    b = np.zeros((n + 1, nu))
    b[:-1] += np.einsum("i,kiu->ku", 1 - rise, boxes) / every
    b[1:] += np.einsum("i,kiu->ku", rise, boxes) / every
    diagonal = np.full(n + 1, 2 / 3)
    diagonal[[0, -1]] = 1 / 3
    return solveh_banded(np.vstack([np.full(n + 1, 1 / 6), diagonal]), b)
