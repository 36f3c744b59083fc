"""One test of whiteness: its statistic as in the book, its chances as often as they say."""

import numpy as np
import pytest
from estimation_plants import steps
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy import stats
from scipy.signal import lfilter
from scipy.stats import chi2, kstest

from identification import chances, fit_percent, rms
from identification.estimation.metrics import loss
from identification.estimation.residuals import LAGS, autocorrelation, residual_tests, whiteness
from identification.logs.noise import SCATTER, noise_floor


def signal(seed, n=400, ny=3):
    return 2.0 + np.random.default_rng(seed).standard_normal((n, ny))


def test_the_statistic_is_the_one_of_ljung_and_box():
    """Sample by sample and lag by lag."""
    x = signal(0, 120, 2)
    for i, column in enumerate((x - x.mean(axis=0)).T):
        Q, n = 0.0, len(column)
        for k in range(1, LAGS + 1):
            r = sum(column[t] * column[t - k] for t in range(k, n)) / sum(column**2)
            Q += n * (n + 2) * r**2 / (n - k)
        found = whiteness(x)
        assert found.Q[i] == pytest.approx(Q, rel=1e-12)
        assert found.p_values[i] == pytest.approx(chi2.sf(Q, LAGS), rel=1e-9)
    assert found.p_value == pytest.approx(chi2.sf(found.Q.sum(), 2 * LAGS), rel=1e-12)


def test_chances_are_uniform_of_white_signals():
    found = [whiteness(signal(seed)) for seed in range(300)]
    assert kstest([p for w in found for p in w.p_values], "uniform").pvalue > 1e-3
    assert kstest([w.p_value for w in found], "uniform").pvalue > 1e-3


def test_a_silent_signal_is_not_called_coloured():
    found = whiteness(np.zeros((100, 2)))
    assert (found.p_values == 1).all()
    assert found.predictable == 0
    np.testing.assert_array_equal(autocorrelation(np.ones((9, 1)), 2), np.zeros((3, 1)))


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


def test_the_noise_floor_scatters_as_it_says():
    rng, n = np.random.default_rng(5), 1000
    square = noise_floor(rng.standard_normal((n, 2000))) ** 2
    assert n * square.var() == pytest.approx(SCATTER, rel=0.1)


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


signals = arrays(float, (12, 2), elements=st.integers(-1000, 1000).map(float))
scales = st.floats(1e-6, 1e6)


@given(y=signals)
def test_perfect_is_100_and_the_mean_is_0_and_a_constant_has_no_fit(y):
    moves = np.ptp(y, axis=0) > 0
    assert np.all(fit_percent(y, y)[moves] == 100)
    mean = np.broadcast_to(y.mean(axis=0), y.shape)
    assert fit_percent(y, mean)[moves] == pytest.approx(0, abs=1e-9)
    assert np.all(np.isnan(fit_percent(y, y)[~moves]))


@given(y=signals, y_hat=signals, scale=scales, offset=st.integers(-100, 100))
def test_fit_does_not_depend_on_unit_or_zero(y, y_hat, scale, offset):
    before = fit_percent(y, y_hat)
    after = fit_percent(scale * (y + offset), scale * (y_hat + offset))
    assert after == pytest.approx(before, rel=1e-6, abs=1e-6, nan_ok=True)


def test_fit_is_that_of_the_thesis():
    y = np.array([[0.0], [3.0], [0.0], [-3.0]])
    assert fit_percent(y, y + 0.3 * np.sqrt(18) / 2) == pytest.approx([70])


@given(residual=signals, scale=scales)
def test_loss_is_the_sum_of_mean_squares_and_scales_squared(residual, scale):
    assert loss(residual) == pytest.approx(np.sum(rms(residual) ** 2))
    assert loss(scale * residual) == pytest.approx(scale**2 * loss(residual))


X, M, P = st.floats(0, 1e3), st.integers(1, 60), st.floats(1e-12, 0.999)


@given(X, M, M)
def test_of_values_above(x, m, n):
    assert chances.chi2_above(x, m) == pytest.approx(stats.chi2.sf(x, m), rel=1e-9, abs=1e-300)
    assert chances.f_above(x, m, n) == pytest.approx(stats.f.sf(x, m, n), rel=1e-9, abs=1e-300)
    assert chances.f_above(-x, m, n) == 1
    for t in (x, -x):
        assert chances.student_above(t, m) == pytest.approx(stats.t.sf(t, m), rel=1e-9, abs=1e-300)
        assert chances.normal_above(t) == pytest.approx(stats.norm.sf(t), rel=1e-9, abs=1e-300)


@given(P, M)
def test_of_levels(p, m):
    assert chances.chi2_level(p, m) == pytest.approx(stats.chi2.isf(p, m), rel=1e-9)
    assert chances.normal_level(p) == pytest.approx(stats.norm.isf(p), rel=1e-9, abs=1e-12)


@given(st.integers(0, 2**32 - 1), st.integers(2, 20), st.integers(2, 20))
def test_of_means(seed, n, m):
    rng = np.random.default_rng(seed)
    x, other = rng.normal(0.3, 1, n), rng.normal(0, 2, m)
    one = stats.ttest_1samp(x, 0.0, alternative="greater")
    assert chances.mean_above_zero(x) == pytest.approx((one.statistic, one.pvalue), rel=1e-9)
    assert chances.stratified_mean_above_zero([x]) == pytest.approx(
        (one.statistic, one.pvalue), rel=1e-9
    )
    two = stats.ttest_ind(x, other, equal_var=False, alternative="greater")
    assert chances.mean_above_other(x, other) == pytest.approx(two.pvalue, rel=1e-9)
