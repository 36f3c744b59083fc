"""The tests of a residual: right as often as they say, and awake when something is missing."""

import numpy as np
import pytest
from estimation_plants import steps
from scipy.signal import lfilter
from scipy.stats import kstest

from identification.estimation.residuals import residual_tests
from identification.logs.noise import noise_floor

N, SEEDS = 500, 200


def p_values(make, kind):
    return np.array(
        [getattr(residual_tests(make(s), steps(N, seed=s)), kind)[0] for s in range(SEEDS)]
    )


def white(seed):
    return np.random.default_rng(1000 + seed).standard_normal((N, 1))


def coloured(seed):
    return lfilter([1.0], [1.0, -0.8], white(seed), axis=0)


def test_white_noise_has_uniform_p_values():
    assert kstest(p_values(white, "white"), "uniform").pvalue > 1e-3


def test_coloured_noise_is_seen_not_to_be_white():
    assert (p_values(coloured, "white") < 1e-3).mean() > 0.95


@pytest.mark.parametrize("noise", [white, coloured])
def test_noise_of_any_colour_is_rarely_said_to_depend_on_the_input(noise):
    """At most the level asked for, with room for 3 std of a binomial count."""
    p = p_values(noise, "independent")
    for level in (0.01, 0.05):
        assert (p < level).mean() < level + 3 * np.sqrt(level * (1 - level) / SEEDS) + 0.01


@pytest.mark.parametrize("noise", [white, coloured])
def test_a_missing_effect_of_the_input_is_seen(noise):
    def missing(seed):
        effect = lfilter([0.5], [1.0, -0.7], steps(N, seed=seed), axis=0)
        return noise(seed) + effect

    assert (p_values(missing, "independent") < 0.01).mean() > 0.8


def test_the_noise_floor_of_a_smooth_signal_is_its_noise():
    t = np.linspace(0, 10, 4000)[:, None]
    for seed, sigma in enumerate((1e-4, 1e-2, 1.0)):
        noise = sigma * np.random.default_rng(seed).standard_normal(t.shape)
        assert noise_floor(np.sin(2 * t) + noise)[0] == pytest.approx(sigma, rel=0.1)


def test_the_noise_floor_is_consistent():
    """Its error falls as 1/√n."""
    errors = [
        np.std(
            [noise_floor(np.random.default_rng(s).standard_normal((n, 1)))[0] for s in range(50)]
        )
        for n in (200, 3200)
    ]
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.5)


def test_the_noise_floor_of_a_rough_signal_is_too_high_never_too_low():
    """A signal near half the sampling rate looks like noise: the floor is an upper bound."""
    n = np.arange(4000)[:, None]
    noise = 1e-3 * np.random.default_rng(0).standard_normal(n.shape)
    floors = [noise_floor(0.01 * np.sin(w * n) + noise)[0] for w in (0.05, 0.5, 1.5, 3.0)]
    assert floors[0] == pytest.approx(1e-3, rel=0.1)
    assert all(np.diff(floors) > 0)
    assert floors[-1] > 5e-3


def test_jumps_of_the_input_do_not_raise_the_noise_floor():
    n = np.arange(2000)[:, None]
    noise = 1e-3 * np.random.default_rng(0).standard_normal(n.shape)
    jumps = np.cumsum(np.where(n % 50 == 0, 0.1, 0.0), axis=0)
    assert noise_floor(jumps + noise)[0] == pytest.approx(1e-3, rel=0.25)


def test_a_still_input_and_a_still_residual_are_not_an_error():
    still = residual_tests(np.zeros((50, 2)), np.ones((50, 1)))
    assert (still.independent == 1).all()
    assert (still.white > 0.5).all()
