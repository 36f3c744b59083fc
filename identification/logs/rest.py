"""Whether a record hardly moves beside others: it then shows nothing of what acts in motion.

    D(y) = mean_t (y(t + m) - y(t))² - c         motion over a lag of m samples
    V(y) = mean_t (y(t) - ȳ)² - c'               travel; of a rate ȳ = 0
    share = max_k max(√(D(y_k)/D(z_k)), √(V(y_k)/V(z_k)))      z: the same output of other records

c and c' are a little more than what the noise of the sensors alone makes, so that a robot at rest
has the share 0. The lag is the shortest one over which the other records move by far more than
that. Both D and V must be small: a slow creep travels far, and a small vibration is fast. Units
and the size of the robot do not count.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification.logs.log import Log
from identification.logs.noise import noise_floor

RESTING = 0.03  # of the motion of other records: a record that moves by less hardly moves
NOISE = 1.2  # times the variance of the noise, that a robot at rest may show
CLEAR = (NOISE - 1) / RESTING**2  # such variances, from which on a motion is judged
FEWEST = 8  # lags in a record


def is_at_rest(fitted: Sequence[Log], log: Log) -> bool:
    """Tells whether a log hardly moves beside those that were fitted."""
    return motion_share(fitted, log) < RESTING


def motion_share(fitted: Sequence[Log], log: Log) -> float:
    """Returns how much a log moves beside those that were fitted, no unit.

    It is infinite where these do not move far beyond their noise, or none was fitted.
    """
    if not fitted:
        return np.inf
    units = [log.units.get(name, "") for name in log.output_names]
    return share_of_motion([f.outputs for f in fitted], log.outputs, units)


def share_of_motion(fitted: Sequence[np.ndarray], y: np.ndarray, units: Sequence[str]) -> float:
    """Returns the share by which outputs move beside those that were fitted; see `motion_share`.

    Args:
        fitted: outputs of each record, shape (n, ny), each column in a unit of its own.
        y: of the other record, likewise.
        units: of the columns; "" where it is not known.
    """
    # A rate that stays what it is moves its joint; what has no unit may be a rate.
    is_rate = (not unit or unit.endswith("/s") for unit in units)
    shares = [_share([z[:, k] for z in fitted], y[:, k], rate) for k, rate in enumerate(is_rate)]
    known = [share for share in shares if share is not None]
    return max(known, default=np.inf)


def _share(fitted: Sequence[np.ndarray], y: np.ndarray, is_rate: bool) -> float | None:
    """Returns the share of one output; None where it is nothing but noise in all records."""
    noise = max(float(noise_floor(z[:, None])[0]) for z in fitted) ** 2
    lag, fewest = 1, min(map(len, (*fitted, y)))
    while 2 * FEWEST * lag <= fewest and _moved(fitted, lag) < 2 * CLEAR * noise:
        lag *= 2
    moved, travelled = _moved(fitted, lag), _travelled(fitted, is_rate)
    own_moved, own_travelled = _moved([y], lag), _travelled([y], is_rate)
    if travelled <= NOISE * noise:
        return None if own_travelled <= NOISE * noise else np.inf
    if moved >= 2 * CLEAR * noise:  # else noise may hide a part of a motion, and counts as one
        own_moved = max(0.0, own_moved - 2 * NOISE * noise)
        own_travelled = max(0.0, own_travelled - NOISE * noise)
    return float(np.sqrt(max(_ratio(own_moved, moved), _ratio(own_travelled, travelled))))


def _ratio(new: float, known: float) -> float:
    """Returns a ratio of two motions; 0 where there is none in either."""
    return new / known if known > 0 else np.inf if new > 0 else 0.0


def _moved(each: Sequence[np.ndarray], lag: int) -> float:
    """Returns the mean square of differences over a lag."""
    return float(np.mean(np.concatenate([z[lag:] - z[:-lag] for z in each]) ** 2))


def _travelled(each: Sequence[np.ndarray], is_rate: bool) -> float:
    """Returns the mean square about the mean of each record, of rates about zero."""
    away = [z if is_rate else z - z.mean() if np.ptp(z) else 0 * z for z in each]  # no rounding
    return float(np.mean(np.concatenate(away) ** 2))
