"""Chances under the usual distributions, and tests of means.

`scipy.stats` has them too; it takes most of a second to import. `scipy.special` takes a fifth of
one: `scipy` imports it when a chance is first asked for.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import scipy

LEAST_OF_STRATUM = 3  # numbers, from which the scatter of a stratum is told


def chi2_above(x: Any, freedom: float) -> Any:
    """Returns the chance that χ² of some degrees of freedom exceeds x; elementwise."""
    return scipy.special.chdtrc(freedom, x)


def chi2_level(chance: float, freedom: float) -> float:
    """Returns the x that χ² of some degrees of freedom exceeds with a chance."""
    return float(scipy.special.chdtri(freedom, chance))


def f_above(x: Any, numerator: float, denominator: float) -> Any:
    """Returns the chance that F of two degrees of freedom exceeds x; elementwise."""
    return scipy.special.fdtrc(numerator, denominator, np.maximum(x, 0.0))


def student_above(t: float, freedom: float) -> float:
    """Returns the chance that Student's t of some degrees of freedom exceeds t."""
    return float(scipy.special.stdtr(freedom, -t))


def noncentral_student_above(t: float, freedom: float, moved: Any) -> Any:
    """Returns the chance that Student's t of a noncentrality `moved` exceeds t; elementwise."""
    # beyond 30 the chance is 0 or 1 for any t that a test asks for, and scipy has no number
    return 1.0 - scipy.special.nctdtr(freedom, np.clip(moved, -30.0, 30.0), t)


def student_level(chance: float, freedom: float) -> float:
    """Returns the t that Student's t of some degrees of freedom exceeds with a chance."""
    return -float(scipy.special.stdtrit(freedom, chance))


def normal_above(z: Any) -> Any:
    """Returns the chance that a standard normal number exceeds z; elementwise."""
    return scipy.special.ndtr(-np.asarray(z))


def normal_level(chance: float) -> float:
    """Returns the z that a standard normal number exceeds with a chance."""
    return -float(scipy.special.ndtri(chance))


def mean_above_zero(x: np.ndarray) -> tuple[float, float]:
    """Tests whether the mean of normal numbers is above zero (Student 1908).

    Args:
        x: shape (n,).

    Returns:
        t, and the chance of as large a one where the mean is zero; NaN where all are zero, and of
        one number, whose scatter is not known.
    """
    if len(x) < 2:
        return np.nan, np.nan
    with np.errstate(divide="ignore", invalid="ignore"):
        t = float(x.mean() / np.sqrt(x.var(ddof=1) / len(x)))
    return t, student_above(t, len(x) - 1)


def stratified_mean_above_zero(strata: Sequence[np.ndarray]) -> tuple[float, float]:
    """Tests whether the mean of numbers from several strata is above zero (Cochran 1977, ch. 5).

    Strata may have means and scatters of their own: that their means differ is no uncertainty of
    the mean over all. Degrees of freedom are those of Satterthwaite (1946); one stratum is
    Student's test. Strata too small to tell their scatter count as one.

    Args:
        strata: numbers of each, shape (n_r,).

    Returns:
        t, and the chance of as large a one where the mean is zero; NaN where nothing scatters, and
        of one number.
    """
    large = [x for x in strata if len(x) >= LEAST_OF_STRATUM]
    small = [x for x in strata if len(x) < LEAST_OF_STRATUM]
    if small:
        rest = np.concatenate(small)
        if len(rest) < LEAST_OF_STRATUM and large:
            large.sort(key=len)
            rest = np.concatenate([rest, large.pop(0)])
        large.append(rest)
    if len(large) == 1:
        return mean_above_zero(large[0])
    n = sum(map(len, large))
    each = np.array([len(x) * x.var(ddof=1) for x in large]) / n**2
    with np.errstate(divide="ignore", invalid="ignore"):
        t = sum(float(x.sum()) for x in large) / n / np.sqrt(each.sum())
        freedom = each.sum() ** 2 / sum(each**2 / (np.array([*map(len, large)]) - 1))
    return float(t), student_above(float(t), float(freedom))


def ranks_above_zero(x: np.ndarray) -> float:
    """Tests whether numbers that scatter evenly about their middle lie above zero (Wilcoxon 1945).

    Where they lie below it or about it, each sign is as likely for any rank of |x|. Large numbers
    count by their rank only, so that a few of them do not hide that nearly all are positive.

    Args:
        x: shape (n,).

    Returns:
        The chance of as large a sum of the ranks of the positive ones.
    """
    x = x[x != 0]
    ranks = np.argsort(np.argsort(np.abs(x), kind="stable"), kind="stable") + 1
    of_sum = np.ones(1)  # chance of each sum of ranks that have been seen, 0, 1, ...
    for rank in range(1, len(x) + 1):
        of_sum = 0.5 * (np.pad(of_sum, (0, rank)) + np.pad(of_sum, (rank, 0)))
    return min(1.0, float(of_sum[ranks[x > 0].sum() :].sum()))


def mean_above_other(x: np.ndarray, other: np.ndarray) -> float:
    """Tests whether the mean of normal numbers is above that of others (Welch 1947).

    Args:
        x: shape (n,).
        other: shape (m,), of another variance.

    Returns:
        The chance of as large a difference where the means are equal; NaN where nothing scatters.
    """
    a, b = (v.var(ddof=1) / len(v) for v in (x, other))
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (x.mean() - other.mean()) / np.sqrt(a + b)
        freedom = (a + b) ** 2 / (a**2 / (len(x) - 1) + b**2 / (len(other) - 1))
    return student_above(t, freedom)
