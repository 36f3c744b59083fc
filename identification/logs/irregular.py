"""Channels with uneven time stamps, interpolated onto one even grid.

    x_i(k h) = the straight line between the nearest samples of channel i on both sides

A bus that asks one device after the other gives uneven time stamps and empty cells (NaN). A
predictor needs an even grid, so each channel is interpolated between its own samples. The line
between two samples is a guess, so a gap that is longer than `widest` is refused.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from identification.errors import InputError
from identification.logs.sampling import FloatArray, grid


def on_a_grid(
    time: FloatArray,
    channels: Mapping[str, FloatArray],
    step: float,
    widest: float,
) -> tuple[FloatArray, dict[str, FloatArray]]:
    """Interpolate every channel, from the time when all have begun to the time when one ends.

    Args:
        time: time stamps, shape (n,) [s]; rows with equal stamps are adjacent.
        channels: by name, shape (n,), each in a unit of its own; NaN where nothing arrived.
        step: step of the grid [s].
        widest: largest gap between two samples of a channel that is interpolated [s].

    Returns:
        Time of the grid from zero, shape (m,) [s], and the channels on it.

    Raises:
        InputError: a channel has fewer than two samples or too wide a gap, or nothing is left.
    """
    if not (step > 0 and np.isfinite(step)):
        raise InputError(f"a grid needs a positive step, not {step:g} s")
    seen = {name: np.isfinite(x) & np.isfinite(time) for name, x in channels.items()}
    for name, there in seen.items():
        if there.sum() < 2:
            raise InputError(f"channel {name!r} has {there.sum()} samples; leave it out")
    order = np.argsort(time, kind="stable")
    begin = max(float(time[there].min()) for there in seen.values())
    end = min(float(time[there].max()) for there in seen.values())
    if end - begin < 2 * step:
        raise InputError("no three steps in which every channel was measured; leave one out")
    t = grid(begin, step, int((end - begin) / step + 1e-9) + 1)
    out = {}
    for name, x in channels.items():
        at = order[seen[name][order]]
        inside = (time[at] >= begin) & (time[at] <= end)
        gaps = np.diff(time[at][inside])
        if len(gaps) and gaps.max() > widest:
            k = int(gaps.argmax())
            raise InputError(
                f"channel {name!r} has no sample for {gaps[k]:.3g} s from"
                f" {time[at][inside][k]:.6g} s, more than {widest:g} s; cut the log there"
            )
        out[name] = np.interp(t, time[at], x[at])
    return t - begin, out
