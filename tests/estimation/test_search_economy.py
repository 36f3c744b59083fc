"""A search simulates nothing twice and nothing that it does not use, and ends where it should."""

from dataclasses import replace

import numpy as np
import pytest
from estimation_plants import record, slider
from threadpoolctl import threadpool_info, threadpool_limits

from identification.estimation.estimation import Options, estimate
from identification.estimation.search import Slopes
from identification.model.coordinates import coordinates
from identification.model.predictor import Predictor
from identification.model.sensitivity import forward_sensitivity, sensitivity
from inca_mj.robot.inputs import make_input
from inca_mj.twin.logs import run_to_log
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import build_twin

NAMES = ("J", "b_c", "K_t", "x")
START = {"J": 1e-4, "b_c": 0.004, "K_t": 0.09, "x": 0.01}


@pytest.fixture(scope="module")
def robot():
    return build_twin()


@pytest.fixture(scope="module")
def log(robot):
    return run_to_log(simulate(robot, make_input("prbs", 1.0)))


@pytest.fixture(scope="module")
def noisy(log):
    error = np.random.default_rng(0).normal(0, 6.7e-4, log.outputs.shape)
    return replace(log, outputs=log.outputs + error)


def test_forward_sensitivities_are_the_central_ones(robot, log):
    q = np.array(list(START.values()))
    space = coordinates(robot.parameters, NAMES, q)
    predictor, q = Predictor(robot, log, NAMES), space.encode(q)
    predicted = predictor.predict(space.decode(q))[0]
    central = sensitivity(predictor, space, q)
    forward = forward_sensitivity(predictor, space, q, predicted)
    scale = np.abs(central).max(axis=(0, 1))
    assert (np.abs(forward - central).max(axis=(0, 1)) < 1e-4 * scale).all()


def test_rough_horizons_do_not_move_the_end(robot, noisy):
    grown = estimate(robot, noisy, NAMES, START)
    begun = estimate(robot, noisy, NAMES, grown.values, Options(horizons=(1.0,), tolerance=1e-12))
    np.testing.assert_allclose(grown.q, begun.q, rtol=0, atol=1e-6)


def test_kept_slopes_save_simulations_and_move_nothing(robot, noisy, monkeypatch):
    kept = estimate(robot, noisy, NAMES, START)
    monkeypatch.setattr("identification.estimation.search.SLOPE_ERROR", 0.0)
    fresh = estimate(robot, noisy, NAMES, START)
    assert kept.jacobians < 0.7 * fresh.jacobians
    np.testing.assert_allclose(kept.q, fresh.q, rtol=0, atol=1e-6)


def test_kept_slopes_have_the_change_that_was_seen_and_keep_what_was_not():
    rng = np.random.default_rng(4)
    J, q, step = rng.standard_normal((30, 5)), rng.standard_normal(5), rng.standard_normal(5)
    slopes = Slopes(q, np.zeros(30), J)
    change = J @ step
    change += 0.05 * np.linalg.norm(change) * np.eye(30)[3]
    moved = slopes.moved(q + step, change)
    np.testing.assert_allclose(moved.J @ step, change, rtol=1e-12)
    # Across the step, where a length is that of the outputs' change, the slopes are what they were.
    across = rng.standard_normal(5)
    weight = np.sum(J**2, axis=0)
    across -= (across * weight) @ step / (step * weight @ step) * step
    np.testing.assert_allclose(moved.J @ across, J @ across, rtol=1e-12)
    # Units of a parameter change nothing.
    unit = np.array([1.0, 1e3, 1e-4, 7.0, 1.0])
    scaled = Slopes(q / unit, np.zeros(30), J * unit).moved((q + step) / unit, change)
    np.testing.assert_allclose(scaled.J / unit, moved.J, rtol=1e-9)
    # A change that was not promised needs new slopes.
    assert slopes.moved(q + step, change + 0.2 * np.linalg.norm(change) * np.eye(30)[7]) is None
    assert slopes.moved(q + step, np.full(30, np.nan)) is None


def threads():
    return {each["num_threads"] for each in threadpool_info() if each["user_api"] == "blas"}


def test_a_fit_has_one_thread_and_finds_the_truth():
    log, seen = record(slider(), ("position",), n=80), []
    with threadpool_limits(2, "blas"):
        found = estimate(
            slider(damping=2.3), log, ("damping",), progress=lambda _: seen.append(threads())
        )
        assert threads() == {2}
    assert len(seen) > 0
    assert all(each == {1} for each in seen)
    np.testing.assert_allclose(
        found.values["damping"], slider().parameters.values()["damping"], rtol=1e-5
    )
