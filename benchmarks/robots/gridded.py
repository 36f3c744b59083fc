"""Columns of one record on an even grid, as a log."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from identification import Log, on_a_grid


def gridded(
    time: np.ndarray,
    inputs: Mapping[str, np.ndarray],
    outputs: Mapping[str, np.ndarray],
    *,
    units: Mapping[str, str],
    name: str,
    step: float,
    widest: float,
    means: bool = False,
) -> Log:
    """A log of columns whose time stamps are uneven, straight lines between samples.

    Args:
        time: stamps, shape (n,) [s].
        inputs: by name, shape (n,).
        outputs: by name, shape (n,).
        units: by name.
        name: of the log.
        step: of the grid [s].
        widest: gap that is bridged [s].
        means: whether an input is the mean over a step of the grid about each of its points, as a
            grid needs that is coarser than the record; outputs are never filtered.
    """
    columns = {**inputs, **outputs}
    t, on = on_a_grid(time, columns, step, widest)
    if means:
        begin = max(float(time[np.isfinite(x) & np.isfinite(time)].min()) for x in columns.values())
        on |= {n: _means(time, u, begin + t, step) for n, u in inputs.items()}
    return Log(
        time=t, inputs=np.column_stack([on[n] for n in inputs]),
        outputs=np.column_stack([on[n] for n in outputs]), input_names=tuple(inputs),
        output_names=tuple(outputs), units=dict(units), name=name, hold="foh",
    )  # fmt: skip


def _means(time: np.ndarray, u: np.ndarray, at: np.ndarray, step: float) -> np.ndarray:
    """Mean over [t - h/2, t + h/2] of the straight lines through samples, at times `at`, (m,)."""
    there = np.isfinite(u) & np.isfinite(time)
    t, v = time[there], u[there]
    areas = np.concatenate([[0.0], np.cumsum(0.5 * (v[1:] + v[:-1]) * np.diff(t))])
    slopes = np.diff(v) / np.diff(t)

    def area(x: np.ndarray) -> np.ndarray:
        k = np.clip(np.searchsorted(t, x, side="right") - 1, 0, len(t) - 2)
        return areas[k] + v[k] * (x - t[k]) + 0.5 * slopes[k] * (x - t[k]) ** 2

    low, high = np.maximum(at - step / 2, t[0]), np.minimum(at + step / 2, t[-1])
    return (area(high) - area(low)) / (high - low)
