"""A profile agrees with the std on a parabola, and is flat where nothing is known."""

from dataclasses import replace

import numpy as np
import pytest
from estimation_plants import record, slider
from scipy.signal import lfilter

from identification import InputError
from identification.estimation.estimation import Options, estimate
from identification.estimation.fit import assess
from identification.estimation.profiles import _crossing, profile

ONCE = Options(horizons=(1.0,))


def test_a_profile_of_a_nearly_linear_problem_gives_the_interval_of_the_std():
    log = record(slider(), ("position",), noise=5e-4)
    found = estimate(slider(), log, ("damping", "stiffness"), options=ONCE)
    fit = assess(found)
    std = dict(zip(found.space.names, fit.std, strict=True))
    for name in found.space.names:
        known = profile(fit, name, points=5)
        value = found.values[name]
        wald = (value - 1.96 * std[name], value + 1.96 * std[name])
        np.testing.assert_allclose(known.interval, wald, atol=0.35 * std[name])
        assert not known.open
        assert (known.rise > -1e-3).all()
        assert known.rise[0] == pytest.approx(9, rel=0.1)
        assert known.rise[-1] == pytest.approx(9, rel=0.1)


@pytest.mark.parametrize("loss", ["huber", "cauchy", "soft_l1", "arctan"])
def test_a_profile_counts_outliers_as_the_loss_of_its_fit_does(loss):
    log = record(slider(), ("position",), noise=5e-4)
    rng, y = np.random.default_rng(1), log.outputs.copy()
    y[rng.integers(0, len(y), 10)] += 0.05 * rng.choice([-1, 1], (10, 1))
    agrees_with_the_std(replace(log, outputs=y), replace(ONCE, loss=loss))


def test_a_profile_weighs_relative_noise_as_its_fit_does():
    log = record(slider(), ("position",))
    grows = 1 + 0.05 * np.random.default_rng(1).standard_normal(log.outputs.shape)
    agrees_with_the_std(
        replace(log, outputs=grows * log.outputs), replace(ONCE, relative_noise=0.05)
    )


def agrees_with_the_std(log, options):
    """Near its optimum each criterion is a parabola."""
    fit = assess(estimate(slider(), log, ("damping", "stiffness"), options=options))
    for name, std in zip(fit.estimate.space.names, fit.std, strict=True):
        known = profile(fit, name, points=5)
        ends = (np.array(known.interval) - fit.values[name]) / std
        np.testing.assert_allclose(ends, [-1.96, 1.96], atol=0.35)


def test_the_profile_of_what_cannot_be_known_is_flat():
    log = record(slider(x0=0.0), ("position",), noise=5e-4)
    names = ("mass", "damping", "stiffness", "gear")
    found = estimate(slider(x0=0.0), log, names, options=ONCE)
    flat = profile(assess(found), "gear", points=[3.5, 4.5, 5.5, 6.5])
    assert flat.open
    assert np.abs(flat.rise).max() < 0.05
    np.testing.assert_allclose(flat.others["mass"] / flat.values, 0.4, rtol=0.02)


def test_only_what_was_estimated_has_a_profile():
    found = assess(estimate(slider(), record(slider(), ("position",), noise=1e-3), ("damping",)))
    with pytest.raises(InputError, match="profile one of damping"):
        profile(found, "stiffness")
    one = profile(found, "damping", points=5)
    assert one.interval[0] < 3.0 < one.interval[1]


def test_a_coloured_residual_widens_the_profile_as_it_widens_the_std():
    clean = record(slider(), ("position",), n=1000)
    rng = np.random.default_rng(3)
    drift = lfilter([1.0], [1.0, -0.9], 2e-4 * rng.normal(size=1000))
    log = replace(clean, outputs=clean.outputs + drift[:, None])
    fit = assess(estimate(slider(), log, ("damping", "stiffness"), options=ONCE))
    std = dict(zip(fit.found.names, fit.std, strict=True))
    white = fit.rms * fit.found.std * [*fit.estimate.values.values()]  # as if it were white
    assert (fit.std > 2 * white).all()
    low, high = profile(fit, "damping", points=5).interval
    assert high - low == pytest.approx(2 * 1.96 * std["damping"], rel=0.15)


def test_an_end_that_no_simulation_reaches_is_not_an_end():
    values, rise = np.array([0.9, 1.0, 1.1, 1.2]), np.array([np.inf, 0.0, 1.0, 9.0])
    assert _crossing(values, rise, 1.0, -1) == -np.inf
    assert 1.1 < _crossing(values, rise, 1.0, 1) < 1.2
