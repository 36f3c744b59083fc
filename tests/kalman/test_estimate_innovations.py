"""Estimation by innovations: exact laws on a slider whose input errs."""

import numpy as np
import pytest
from discovery_cases import FREE, SENSOR, record, slider, wander

from identification.errors import InputError
from identification.estimation.estimation import estimate
from identification.kalman.estimate import estimate_innovations

TRUE = {"mass": 2.4, "damping": 2.6, "x0": 0.02, "v0": -0.03}


def test_it_is_the_free_run_s_estimate_where_the_input_is_as_logged():
    log = record(slider(**TRUE), 400)
    found = estimate_innovations(slider(), log, FREE)
    free = estimate(slider(), log.part("estimation"), FREE).values
    for name, std in zip(FREE, found.fit.std, strict=True):
        assert abs(found.fit.estimate.values[name] - free[name]) < std, name


def test_where_the_input_errs_it_is_nearer_to_the_truth_than_a_free_run():
    off = []
    for seed in range(4):
        log = record(slider(**TRUE), 400, seed=seed, error=wander(400, 0.15, 0.1, seed=50 + seed))
        found = estimate_innovations(slider(), log, FREE).fit.estimate.values
        free = estimate(slider(), log.part("estimation"), FREE).values
        off.append([np.log(v["damping"] / TRUE["damping"]) for v in (found, free)])
    ours, theirs = np.sqrt(np.mean(np.square(off), axis=0))
    assert ours < theirs


def test_innovations_are_white_and_of_the_sensor_s_size_on_unseen_data_too():
    log = record(slider(**TRUE), 1000, seed=3, error=wander(1000, 0.1, 0.1, seed=4))
    found = estimate_innovations(slider(), log, FREE)
    assert found.fit.tests.white.min() > 1e-3
    assert found.level.sigma == pytest.approx(SENSOR, rel=0.15)
    assert found.validation_rms == pytest.approx(found.rms, rel=0.1)
    assert found.fit.rms > 2 * found.rms  # a free run adds up what disturbs it
    # A slow plant feels only the variance times the correlation time.
    felt = found.level.input_std**2 * found.level.noise.time / (0.1**2 * 0.1)
    assert 0.3 < felt < 3  # one draw of a slow error over some 100 correlation times


def test_a_prior_holds_what_it_names():
    log = record(slider(**TRUE), 300)
    found = estimate_innovations(slider(), log, FREE, priors={"mass": 1e-6})
    assert found.fit.estimate.values["mass"] == pytest.approx(2.0, rel=1e-4)


def test_an_interrupt_keeps_the_best_so_far():
    log = record(slider(**TRUE), 300)

    def stop(line: str) -> None:
        if line.startswith("step 1"):
            raise KeyboardInterrupt

    found = estimate_innovations(slider(), log, FREE, {"mass": 4.0}, progress=stop)
    assert found.fit.estimate.status == "stopped"
    assert abs(found.fit.estimate.values["mass"] - 2.4) < 1.6


@pytest.mark.parametrize(("steps", "status"), [(1, "iterations"), (30, "converged")])
def test_it_says_whether_the_steps_sufficed(steps, status):
    log = record(slider(**TRUE), 300)
    found = estimate_innovations(slider(), log, FREE, {"mass": 4.0}, steps=steps)
    assert found.fit.estimate.status == status


def test_a_short_log_is_refused():
    with pytest.raises(InputError, match="at least 50"):
        estimate_innovations(slider(), record(slider(), 60), FREE)
