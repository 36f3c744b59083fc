"""How far ahead a model must predict where nobody says it: over a part of a swing of its outputs.

    T_k = min { τ : mean_t (y_k(t + τ) - y_k(t))² ≥ 2 var y_k },    T = median of T_k

Of a sine this is a quarter of its period: there the autocorrelation becomes negative, so that where
the motion was says nothing any more of where it is. Over much less a force hardly moves the robot;
over much more the error at the end depends on all that happened, and no more on what is there.
"""

from __future__ import annotations

import numpy as np

SHORTEST, LONGEST = 0.1, 0.3  # [s]; rates of names were measured over 0.2 and 0.3 s
FEWEST = 10  # samples
MOST_SHARE = 0.1  # of a record


def part_of_swing(y: np.ndarray, sampling_time: float) -> float:
    """Returns the time of a part of a swing [s], to two digits.

    It is between `SHORTEST` and `LONGEST`, no more than a tenth of the record, and `FEWEST`
    samples at least where a quarter of the record has as many.

    Args:
        y: outputs, shape (n, ny), each in a unit of its own; those that stand still do not count.
        sampling_time: of the record [s].
    """
    moving = y[:, np.ptp(y, axis=0) > 0]
    most = max(1, int(MOST_SHARE * len(y)))
    each = [_turns(column, most) for column in moving.T]
    lasts = float(np.median(each)) * sampling_time if each else SHORTEST
    lasts = min(max(lasts, SHORTEST), LONGEST, most * sampling_time)
    least = min(FEWEST, max(1, len(y) // 4))
    return float(f"{max(lasts, least * sampling_time):.2g}")


def _turns(y: np.ndarray, most: int) -> int:
    """Returns the first lag at which a column differs from itself as much as at random; `most`."""
    twice = 2 * float(np.var(y))
    lags = (m for m in range(1, most) if np.mean((y[m:] - y[:-m]) ** 2) >= twice)
    return next(lags, most)
