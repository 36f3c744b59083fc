"""Rates with their intervals, calibration of confidence, medians, and where a rate crosses a level.

Wilson 1927:   p̂ ± → (p̂ + z²/2n ± z √(p̂ (1 - p̂)/n + z²/4n²)) / (1 + z²/n)
calibration:   ECE = Σ_b n_b |mean confidence_b - share right_b| / n;   Brier = mean (c - r)²
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, TypeVar

import numpy as np

BINS = 10
T = TypeVar("T")


def wilson(hits: int, of: int, z: float = 1.96) -> dict[str, Any]:
    """Returns the rate of hits of so many, and its 95 % interval (Wilson 1927)."""
    if not of:
        return {"value": None, "low": 0.0, "high": 1.0, "hits": 0, "of": 0}
    p, w = hits / of, z * z / of
    half = z * math.sqrt(p * (1 - p) / of + w / (4 * of))
    low, high = ((p + w / 2 + sign * half) / (1 + w) for sign in (-1, 1))
    ends = {"low": low if hits else 0.0, "high": high if hits < of else 1.0}  # without rounding
    return {"value": p, **ends, "hits": hits, "of": of}


def rate(rows: Iterable[T], test: Callable[[T], bool]) -> dict[str, Any]:
    """Returns the share of rows that pass a test."""
    outcomes = [test(row) for row in rows]
    return wilson(sum(outcomes), len(outcomes))


def said(share: Mapping[str, Any]) -> str:
    """Returns a rate as a table shows it: 7 of 9 [45, 94 %]."""
    if not share["of"]:
        return "-"
    low, high = (100 * share[end] for end in ("low", "high"))
    return f"{share['hits']} of {share['of']} [{low:.0f}, {high:.0f} %]"


def median(values: Sequence[float]) -> float | None:
    """Returns the median of some values; None where there are none."""
    return statistics.median(values) if values else None


def calibration_of(pairs: Sequence[tuple[float, bool]]) -> dict[str, Any]:
    """Returns the expected calibration error and the Brier score."""
    if not pairs:
        return {"ece": None, "brier": None, "of": 0, "bins": []}
    bins: dict[int, list[tuple[float, bool]]] = {}
    for pair in pairs:
        bins.setdefault(min(BINS - 1, int(BINS * pair[0])), []).append(pair)
    means = [
        {"confidence": sum(c for c, _ in b) / len(b), "right": sum(r for _, r in b) / len(b),
         "of": len(b)}
        for _, b in sorted(bins.items())
    ]  # fmt: skip
    return {
        "ece": sum(m["of"] * abs(m["confidence"] - m["right"]) for m in means) / len(pairs),
        "brier": sum((c - r) ** 2 for c, r in pairs) / len(pairs),
        "of": len(pairs),
        "bins": means,
    }


def crossing(x: Sequence[float], share: Sequence[float], level: float) -> float | None:
    """Returns the smallest x where a rate that rises with x reaches a level; None if it never does.

    The x ascend. The rates are first made to rise (isotonic regression: Barlow et al. 1972, with
    equal weights); between two points x is interpolated, in its logarithm where all are positive.
    """
    from scipy.optimize import isotonic_regression

    rising = isotonic_regression(np.asarray(share, float)).x
    scale = np.log(x) if min(x) > 0 else np.asarray(x, float)
    if rising[-1] < level:
        return None
    k = int(np.argmax(rising >= level))
    if k == 0 or rising[k] == level:
        return float(x[k])
    part = (level - rising[k - 1]) / (rising[k] - rising[k - 1])
    at = scale[k - 1] + part * (scale[k] - scale[k - 1])
    return float(np.exp(at)) if min(x) > 0 else float(at)
