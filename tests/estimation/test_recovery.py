"""What went into data comes out of a fit, and its uncertainty is true."""

from dataclasses import replace

import numpy as np
import pytest
from estimation_plants import pendulum, record, slider
from scipy.signal import lfilter
from scipy.stats import binom

from identification.estimation.estimation import Options, estimate
from identification.estimation.fit import assess
from identification.estimation.profiles import profile
from inca_mj.robot.parameters import parameter_set
from inca_mj.thesis.trials import TRIALS, trial_data
from inca_mj.twin.twin import build_twin

SMALL = TRIALS[2].start  # 5 % off

TRUTH = {"mass": 2.0, "damping": 3.0, "stiffness": 20.0}
FAR = {"mass": 2.6, "damping": 2.1, "stiffness": 26.0}


@pytest.mark.parametrize("method", ["trf", "dogbox", "lm"])
def test_a_slider_is_recovered_from_starts_30_percent_off(method):
    found = estimate(
        slider(), record(slider(), ("position",)), tuple(FAR), FAR, Options(method=method)
    )
    np.testing.assert_allclose([found.values[n] for n in TRUTH], list(TRUTH.values()), rtol=1e-6)
    assert found.status == "converged"


def test_a_pendulum_is_recovered_from_starts_30_percent_off():
    names = ("upper_mass", "lower_mass", "upper_damping", "lower_damping")
    far = dict(zip(names, (1.3, 0.35, 0.26, 0.07), strict=True))
    log = record(pendulum(), ("q1", "q2"))
    found = estimate(pendulum(), log, names, far, Options(method="trf"))
    np.testing.assert_allclose(list(found.values.values()), (1.0, 0.5, 0.2, 0.1), rtol=1e-6)


def test_a_start_that_is_not_known_is_recovered():
    log = record(slider(x0=0.25, v0=-0.4), ("position",))
    found = estimate(slider(), log, ("stiffness", "x0", "v0"))
    np.testing.assert_allclose(list(found.values.values()), (20.0, 0.25, -0.4), rtol=1e-6)


def test_uncertainty_covers_the_truth_as_often_as_it_says():
    """Per parameter binomial bounds at 1e-3 each side; and all within 4 std or so."""
    seeds = 40
    plant, options = slider(mass=2.1, stiffness=19.0), Options(horizons=(1.0,), tolerance=1e-4)
    z = np.empty((seeds, len(TRUTH)))
    for seed in range(seeds):
        log = record(slider(), ("position",), n=70, noise=1e-3, seed=seed)
        fit = assess(estimate(plant, log, tuple(TRUTH), options=options))
        z[seed] = [
            (fit.estimate.values[n] - t) / s
            for (n, t), s in zip(TRUTH.items(), fit.std, strict=True)
        ]
    assert np.abs(z).max() < 4.5
    covered = (np.abs(z) < 1.96).sum(axis=0)
    assert (covered >= binom.ppf(1e-3, seeds, 0.95)).all(), covered
    assert 0.7 < z.std() < 1.3


def test_the_residual_of_a_right_model_is_its_noise():
    log = record(slider(), ("position",), n=2000, noise=2e-3)
    fit = assess(estimate(slider(**FAR), log, tuple(TRUTH)))
    assert fit.rms == pytest.approx(2e-3, rel=0.1)
    assert fit.rms / float(np.sqrt(np.mean(fit.floor**2))) == pytest.approx(1, abs=0.1)
    assert (fit.tests.white > 1e-3).all()
    assert (fit.tests.independent > 1e-3).all()


def test_the_six_parameters_of_trial_3_are_recovered_from_one_second():
    robot = build_twin(parameter_set("trial"))
    log = replace(trial_data(robot).between(0.0, 1.0), name="one second")
    found = estimate(robot, log, tuple(SMALL), SMALL)
    true = parameter_set("trial").values()
    np.testing.assert_allclose(
        [found.values[n] for n in SMALL], [true[n] for n in SMALL], rtol=1e-6
    )


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


def test_the_profile_of_what_cannot_be_known_is_flat():
    log = record(slider(x0=0.0), ("position",), noise=5e-4)
    names = ("mass", "damping", "stiffness", "gear")
    found = estimate(slider(x0=0.0), log, names, options=ONCE)
    flat = profile(assess(found), "gear", points=[3.5, 4.5, 5.5, 6.5])
    assert flat.open
    assert np.abs(flat.rise).max() < 0.05
    np.testing.assert_allclose(flat.others["mass"] / flat.values, 0.4, rtol=0.02)


@pytest.mark.long
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
