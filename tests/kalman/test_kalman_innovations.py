"""White innovations pass, and what is not white is found where it is."""

import numpy as np
import pytest
from discovery_cases import STEP, linear_plant, point_of

from identification.estimation.priors import MIN_STD_SHARE, Priors
from identification.estimation.residuals import innovation_tests
from identification.kalman.linear import LinearPlant
from identification.kalman.noise_fit import NoiseLevel
from identification.kalman.noise_model import Noise
from identification.kalman.refit import Refit

H, N, NY = 0.01, 600, 8


def white(seed):
    return np.random.default_rng(seed).standard_normal((N, NY))


def test_chances_are_uniform_under_white_innovations():
    found = [innovation_tests(white(seed), H) for seed in range(300)]
    lines, correlation = (
        np.array([getattr(w, name) for w in found]) for name in ("p_line", "p_correlation")
    )
    for level in (0.02, 0.1):  # of the lines it is a bound
        assert np.mean(lines < level) < level + 3 * np.sqrt(level * (1 - level) / 300)
    assert np.mean(lines < 0.1) > 0.03
    # Sums of correlations over few samples are a little larger than their χ².
    assert 0.03 < np.mean(correlation < 0.1) < 0.25
    assert np.mean(correlation < 1e-3) < 0.015


def test_a_sine_is_found_at_its_frequency_and_channel():
    frequency = 7.0
    channel = 3
    E = white(1)
    E[:, channel] += 0.5 * np.sin(2 * np.pi * frequency * H * np.arange(N) + 1)
    w = innovation_tests(E, H)
    assert w.p_line < 1e-6
    assert w.channel == channel
    assert w.frequency == pytest.approx(frequency, abs=1 / (N * H))


@pytest.mark.parametrize("a", [0.1, 0.3, 0.6])
def test_the_predictable_share_of_a_first_order_process(a):
    rng = np.random.default_rng(5)
    E = rng.standard_normal((20000, 4))
    for k in range(1, len(E)):
        E[k] += a * E[k - 1]
    w = innovation_tests(E, H)
    assert w.predictable == pytest.approx(a**2, rel=0.1)
    assert w.p_correlation < 1e-4  # beyond chance in all three, but of the first too little
    assert w.is_correlated(1e-4, 0.03) == (a > 0.1)


P, ROWS, TABLE = 24, 600, 1.0


def fit_of(x, noise, seed):
    """A linear fit whose true parameters are x, shape (P,), at the prior mean."""
    rng = np.random.default_rng(seed)
    J = rng.standard_normal((ROWS, 2, P))
    e = J @ x + noise * rng.standard_normal((ROWS, 2))
    quiet = linear_plant(rng, samples=ROWS)
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


def test_values_that_the_data_hardly_tell_are_not_told_too_surely():
    """Of values that scatter as the table says, 95 % lie within 1.96 of the std that is told.

    The data alone tell each value to 1.4 times its scatter. With n in place of n - 1 the scatter is
    often almost zero, and 76 % lie inside.
    """
    inside = []
    for seed in range(60):
        x = TABLE * np.random.default_rng(300 + seed).standard_normal(P)
        fit = fit_of(x, noise := 1.4 * TABLE * np.sqrt(2 * ROWS), seed)
        s = fit.problem.scatter(groups())
        each = np.tile([s["even"], s["odd"]], P // 2)
        F = fit.point.J.reshape(-1, P) / noise
        V = np.linalg.inv(F.T @ F + np.diag(each**-2.0))
        error = V @ F.T @ (fit.point.e.ravel() / noise) - x
        inside.append(np.abs(error) <= 1.96 * np.sqrt(np.diag(V)))
    assert np.mean(inside) == pytest.approx(0.95, abs=0.03)
