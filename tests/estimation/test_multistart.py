"""Several starts find what one start misses, and one start is enough where it finds it."""

import numpy as np
import pytest
from estimation_plants import record, slider
from unlike_cases import MODEL, PARAMETERS, TRUE, write_robot_and_logs

from identification import DivergenceError, InputError, joint_plant
from identification.estimation import multistart
from identification.estimation.estimation import Options, estimate
from identification.estimation.multistart import _cost, estimate_from
from identification.estimation.uncertainty import LOSSES
from identification.robot.file import read_robot_file
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


def test_starts_that_all_diverge_are_said_to():
    log = record(slider(), ("position",), n=20)
    with pytest.raises(DivergenceError):
        estimate_from(slider(), log, ("stiffness",), 2, 0, start={"stiffness": 1e9})
    with pytest.raises(InputError, match="give one or more"):
        estimate_from(slider(), log, ("stiffness",), 0, 0)


def test_a_start_that_the_plant_cannot_have_is_passed_over(monkeypatch):
    log = record(slider(), ("position",), noise=1e-3)
    search, seen = multistart.estimate, []

    def picky(plant, log, names, start, *rest):
        seen.append(start)
        if len(seen) == 2:
            raise InputError("no such start")
        return search(plant, log, names, start, *rest)

    monkeypatch.setattr(multistart, "estimate", picky)
    monkeypatch.setattr(multistart, "ENOUGH_NOISE_RATIO", 0.0)
    found = estimate_from(slider(stiffness=18.0), log, ("stiffness",), 3, 0)
    assert np.isfinite(found.rms).tolist() == [True, False, True]


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
