"""The std of a robust fit is its spread, with outliers and without."""

import numpy as np
import pytest
from estimation_plants import measured, record, slider
from scipy.optimize import approx_fprime

from identification.estimation.estimation import Options, estimate
from identification.estimation.fit import assess
from identification.estimation.uncertainty import LOSSES, influence

RHO = {
    "linear": lambda z: z,
    "soft_l1": lambda z: 2 * ((1 + z) ** 0.5 - 1),
    "huber": lambda z: z if z <= 1 else 2 * z**0.5 - 1,
    "cauchy": lambda z: np.log1p(z),
    "arctan": lambda z: np.arctan(z),
}


@pytest.mark.parametrize("loss", RHO)
def test_the_slopes_are_those_of_the_loss(loss):
    _, first, second = LOSSES[loss]
    for z in (0.2, 0.7, 1.8, 9.0):
        at = np.array([z])
        assert first(at)[0] == pytest.approx(
            approx_fprime(at, lambda x: RHO[loss](x[0]))[0], rel=1e-6
        )
        slope = approx_fprime(at, lambda x: first(x)[0])[0]
        assert second(at)[0] == pytest.approx(slope, rel=1e-6, abs=1e-7)


def test_least_squares_pull_by_the_residual_itself():
    error = np.random.default_rng(0).standard_normal((5, 2))
    pull, share = influence(error, "linear")
    np.testing.assert_array_equal(pull, error)
    assert share == 1.0


@pytest.mark.parametrize("loss", ["cauchy"])
def test_claimed_and_seen_spread_agree_where_one_sample_in_twenty_is_wrong(loss):
    seeds, options = 30, Options(loss=loss, horizons=(1.0,), tolerance=1e-5)
    found, claimed = np.empty((seeds, 2)), np.empty((seeds, 2))
    for seed in range(seeds):
        log = record(slider(), ("position",), n=150, noise=1e-3, seed=seed)
        wrong = np.random.default_rng(100 + seed).choice(150, 7, replace=False)
        y = np.array(log.outputs)
        y[wrong] += 0.05
        fit = assess(
            estimate(slider(), measured(log, y), ("damping", "stiffness"), options=options)
        )
        found[seed], claimed[seed] = list(fit.estimate.values.values()), fit.std
    ratio = claimed.mean(axis=0) / found.std(axis=0, ddof=1)
    assert ((ratio > 0.6) & (ratio < 1.6)).all(), ratio
