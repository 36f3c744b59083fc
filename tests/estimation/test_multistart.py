"""Several starts find what one start misses, and one start is enough where it finds it."""

import numpy as np
import pytest
from estimation_plants import measured, record, slider
from scipy.optimize import approx_fprime
from unlike_cases import MODEL, PARAMETERS, TRUE, write_robot_and_logs

from identification import joint_plant
from identification.estimation import multistart
from identification.estimation.estimation import Options, estimate
from identification.estimation.fit import assess
from identification.estimation.multistart import _cost, estimate_from
from identification.estimation.uncertainty import LOSSES
from identification.robot.file.file import read_robot_file
from identification.robot.robot import read_robot_log

ONCE = Options(horizons=(1.0,), max_evaluations=20)


def test_several_starts_escape_a_local_minimum():
    log = record(
        slider(x0=1.0, damping=0.05, stiffness=200.0), ("position",), inputs=np.zeros((200, 1)),
        noise=1e-3,
    )  # fmt: skip
    far = slider(x0=1.0, damping=0.05, stiffness=110.0)
    found = estimate_from(far, log, ("stiffness",), 12, 0, spread=0.8, options=ONCE)
    assert found.rms[0] > 0.1
    assert found.rms.min() < 2e-3
    assert found.best.values["stiffness"] == pytest.approx(200.0, rel=1e-2)


def test_a_start_that_ends_at_the_noise_is_the_only_one():
    log = record(slider(), ("position",), noise=1e-3)
    assert len(estimate_from(slider(stiffness=18.0), log, ("stiffness",), 9, 0).rms) == 1


def test_the_best_start_is_that_of_the_weighted_criterion(monkeypatch, tmp_path):
    """An error of 1 mm is far more than noise of 20 µm, and a smaller number than one of 3 mrad."""
    folder = write_robot_and_logs(tmp_path)
    log = read_robot_log(read_robot_file(folder / "robot.toml"), folder / "first.csv")
    plant, names = joint_plant(MODEL, PARAMETERS, log, effects=()), tuple(TRUE)
    slide_is_off, hinge_is_off = [TRUE["d"], 1.2 * TRUE["b"]], [1.1 * TRUE["d"], TRUE["b"]]
    starts = np.array([slide_is_off, hinge_is_off])
    monkeypatch.setattr(multistart, "_around", lambda *_: starts)
    stay = Options(horizons=(1.0,), max_evaluations=1)
    found = estimate_from(plant, log, names, 2, 0, options=stay)
    assert found.rms[0] < found.rms[1]  # over numbers in SI units
    assert found.cost[1] < found.cost[0]
    assert [*found.best.values.values()] == pytest.approx(hinge_is_off)


@pytest.mark.parametrize("loss", LOSSES)
def test_the_criterion_is_that_which_the_search_lowers(loss):
    log = record(slider(), ("position", "rate"), noise=1e-3)
    far, ends = slider(stiffness=15.0), []
    for most in (1, 60):
        options = Options(
            horizons=(1.0,), loss=loss, priors={"stiffness": 0.1}, max_evaluations=most
        )
        found = estimate(far, log, ("stiffness",), options=options)
        ends.append(_cost(found, error_of(found), found.space.encode(found.start)))
    assert ends[1] < ends[0]


def error_of(found):
    predicted = found.predictor.predict(found.space.decode(found.q))[0]
    return found.predictor.log.outputs - predicted


def test_with_an_unknown_covariance_units_do_not_matter():
    log = record(slider(), ("position", "rate"), noise=1e-3)
    ends = []
    for stiffness in (18.0, 19.5):
        options = Options(criterion="det", horizons=(1.0,), max_evaluations=1)
        found = estimate(slider(stiffness=stiffness), log, ("stiffness",), options=options)
        units = (1.0, (1e3, 1.0))  # position in m, then in mm
        ends.append([_cost(found, error_of(found) * unit, found.q) for unit in units])
    (far, far_in_mm), (near, near_in_mm) = ends
    assert near < far
    assert near_in_mm - far_in_mm == pytest.approx(near - far, rel=1e-6)


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


def test_claimed_and_seen_spread_agree_where_one_sample_in_twenty_is_wrong():
    seeds, options = 30, Options(loss="cauchy", horizons=(1.0,), tolerance=1e-5)
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
