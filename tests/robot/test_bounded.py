"""Least squares with bounds on some unknowns: the least there is, by a small solver of bounds."""

import numpy as np
import pytest
import scipy.optimize

from identification.robot.bounded import solve_bounded

SAME = 1e-6  # of what is left, to which the solver of bounds goes on


def problem(seed, free, bounded, rows=60, dependent=0):
    """Some columns of a problem are sums of its others, as the weights of bodies in a row are."""
    rng = np.random.default_rng(seed)
    A = rng.standard_normal((rows, free + bounded))
    for k in range(dependent):
        A[:, k] = A[:, dependent:free].sum(axis=1) * (1 + k)
    low = np.concatenate([np.full(free, -np.inf), rng.uniform(-0.2, 0.0, bounded)])
    high = np.concatenate([np.full(free, np.inf), rng.uniform(0.0, 0.2, bounded)])
    high[-1:] = np.inf  # a bound on one side only, where there is any
    return A, A @ rng.standard_normal(free + bounded) + rng.standard_normal(rows), low, high


@pytest.mark.parametrize(
    ("free", "bounded", "rows", "dependent"),
    [(8, 5, 60, 0), (8, 5, 60, 3), (30, 6, 20, 0), (0, 5, 60, 0), (40, 30, 60, 10)],
)
@pytest.mark.parametrize("seed", range(3))
def test_no_step_within_the_bounds_leaves_less(seed, free, bounded, rows, dependent):
    """Compared with a solver that goes from bound to bound until none can be left or reached."""
    A, b, low, high = problem(seed, free, bounded, rows, dependent)
    x = solve_bounded(A, b, low, high)
    assert (low <= x).all()
    assert (x <= high).all()
    exact = scipy.optimize.lsq_linear(A, b, (low, high), method="bvls", max_iter=1000).x
    assert np.linalg.norm(A @ x - b) <= np.linalg.norm(A @ exact - b) * (1 + SAME)


@pytest.mark.parametrize(("bounded", "scatter"), [(60, 1e-12), (80, 1e-12)])
def test_columns_that_are_nearly_sums_of_others_are_solved(bounded, scatter):
    """Without their bounds some unknowns would be huge, and a solver begins there."""
    rng = np.random.default_rng(bounded)
    few = rng.standard_normal((300, 6)) @ rng.standard_normal((6, bounded))
    A = few + scatter * rng.standard_normal(few.shape)
    A /= np.linalg.norm(A, axis=0)
    low, high = np.full(bounded, 0.5), np.where(np.arange(bounded) % 2, 8.0, np.inf)
    b = A @ rng.uniform(1.0, 2.0, bounded) + rng.standard_normal(300)
    x = solve_bounded(A, b, low, high)
    least = scipy.optimize.lsq_linear(few / np.linalg.norm(few, axis=0), b).cost
    assert np.sum((A @ x - b) ** 2) / 2 < 1.001 * least
