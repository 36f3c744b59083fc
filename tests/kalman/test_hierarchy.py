"""The scatter of a group of parameters, from data: a linear model of which all is known."""

import numpy as np
import pytest
from discovery_cases import STEP, linear_plant, point_of

from identification.estimation.priors import MIN_STD_SHARE, Priors
from identification.kalman.linear import LinearPlant
from identification.kalman.noise_fit import NoiseLevel
from identification.kalman.noise_model import Noise
from identification.kalman.refit import Refit

P, N, TABLE = 24, 600, 1.0


def fit_of(x, noise, seed):
    """A linear fit whose true parameters are x, shape (P,), at the prior mean."""
    rng = np.random.default_rng(seed)
    J = rng.standard_normal((N, 2, P))
    e = J @ x + noise * rng.standard_normal((N, 2))
    quiet = linear_plant(rng, samples=N)
    point = point_of(LinearPlant(quiet.A, 0 * quiet.B, quiet.C), e, J)
    level = NoiseLevel(Noise(0.0, STEP), noise, 0.0)
    zero = np.zeros(P)
    priors = Priors(point.space, zero, np.full(P, 1 / TABLE))
    return Refit(point=point, level=level, std=zero, priors=priors, steps=0)


def groups():
    names = [f"p{j}" for j in range(P)]
    return {"even": names[::2], "odd": names[1::2]}


def test_scatters_of_two_groups_are_found():
    """The std of an s² from 12 values is √(2/12) of it; from 40 draws a sixth of that."""
    found = []
    for seed in range(40):
        rng = np.random.default_rng(100 + seed)
        x = rng.standard_normal(P) * np.tile([0.2, 0.5], P // 2)
        found.append([*fit_of(x, 0.1, seed).problem.scatter(groups()).values()])
    mean = np.mean(np.square(found), axis=0)
    expected = np.array([0.2**2, 0.5**2]) * 12 / 11  # a sum of 12 squares over 12 - 1
    np.testing.assert_allclose(mean, expected, rtol=5 * np.sqrt(2 / 12 / 40))


def test_parts_that_are_alike_have_no_scatter():
    found = [fit_of(np.zeros(P), 0.1, seed).problem.scatter(groups()) for seed in range(10)]
    assert np.median([s["even"] for s in found]) <= 2 * MIN_STD_SHARE * TABLE
    assert min(s["odd"] for s in found) >= MIN_STD_SHARE * TABLE


def test_what_the_data_do_not_tell_keeps_what_is_usual():
    """With noise that hides everything the likelihood is flat, and s hardly moves."""
    s = fit_of(np.zeros(P), 1e4, 3).problem.scatter(groups())
    assert s["even"] == pytest.approx(TABLE, rel=0.02)


def test_more_than_the_table_is_not_believed():
    s = fit_of(np.full(P, 5.0), 0.1, 4).problem.scatter(groups())
    assert s == {"even": TABLE, "odd": TABLE}


def test_one_value_alone_tells_no_scatter():
    fit = fit_of(np.zeros(P), 0.1, 5)
    assert fit.problem.scatter({"alone": ["p0"]}) == {"alone": TABLE}


def test_the_order_of_groups_changes_nothing():
    x = np.random.default_rng(7).standard_normal(P) * 0.3
    fit = fit_of(x, 0.1, 8)
    turned = dict(reversed([(g, names[::-1]) for g, names in groups().items()]))
    once, again = fit.problem.scatter(groups()), fit.problem.scatter(turned)
    for g in once:
        assert once[g] == pytest.approx(again[g], rel=1e-9)


def test_values_that_the_data_hardly_tell_are_not_told_too_surely():
    """Of values that scatter as the table says, 95 % lie within 1.96 of the std that is told.

    The data alone tell each value to 1.4 times its scatter. With n in place of n - 1 the scatter is
    often almost zero, and 76 % lie inside.
    """
    inside = []
    for seed in range(60):
        x = TABLE * np.random.default_rng(300 + seed).standard_normal(P)
        fit = fit_of(x, noise := 1.4 * TABLE * np.sqrt(2 * N), seed)
        s = fit.problem.scatter(groups())
        each = np.tile([s["even"], s["odd"]], P // 2)
        F = fit.point.J.reshape(-1, P) / noise
        V = np.linalg.inv(F.T @ F + np.diag(each**-2.0))
        error = V @ F.T @ (fit.point.e.ravel() / noise) - x
        inside.append(np.abs(error) <= 1.96 * np.sqrt(np.diag(V)))
    assert np.mean(inside) == pytest.approx(0.95, abs=0.03)
