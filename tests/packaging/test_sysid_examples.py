"""The examples of docs/mujoco_sysid.md and docs/your_robot.md show what these pages say."""

import sys
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

from identification import InputError, assess, estimate, fit_verdict, read_robot, window_error

ROOT = Path(__file__).parents[2]
ELBOW = ROOT / "examples" / "elbow"


@pytest.fixture
def example(monkeypatch):
    """A function that imports a script of a folder by its name."""

    def load(name, folder="examples"):
        monkeypatch.syspath_prepend(ROOT / folder)
        monkeypatch.delitem(sys.modules, name, raising=False)
        return import_module(name)

    return load


def test_a_parameter_that_nothing_reads_is_refused_by_its_name(example):
    motor = example("silent_parameter")
    log = motor.record(100)
    with pytest.raises(InputError, match="tau_s has no effect on angle"):
        motor.fitted(motor.WITHOUT_SPEED, log)


def test_the_same_parameter_is_found_where_the_model_reads_it(example):
    motor = example("silent_parameter")
    fit = motor.fitted(motor.COMPLETE, motor.record())
    values = np.array([fit.estimate.values[name] for name in motor.NAMES])
    assert np.all(np.abs(values - motor.TRUTH) < 5 * fit.std)


def test_what_joints_cannot_tell_has_no_std_and_the_friction_keeps_its_own(example):
    arm = example("inertials_and_bounds")
    fit = arm.from_drawing(arm.record())
    std = dict(zip(arm.EVERY, fit.std, strict=True))
    assert all(np.isinf(std[name]) for name in arm.DRAWING)
    assert fit.found.rank == 5  # J₁, J₂, h and two frictions
    true = {p.name: p.value for p in arm.PARAMETERS.records}
    for name in arm.FRICTION:
        assert abs(fit.estimate.values[name] - true[name]) < 5 * std[name]
    told = " ".join(fit_verdict(fit))
    assert "only m_1 c_1^2 can be known" in told
    # what the joints do tell is right: the elbow's inertia and the coupling
    found = fit.estimate.values
    for combination in (
        lambda v: v["I_2"] + v["m_2"] * v["c_2"] ** 2,
        lambda v: v["m_2"] * v["c_2"],
    ):
        assert combination(found) == pytest.approx(combination(true), rel=1e-3)


def test_friction_is_found_from_far_below_and_a_start_on_its_bound_is_refused(example):
    arm = example("inertials_and_bounds")
    log = arm.record()
    found = arm.friction_from(1e-8, log).values
    true = {p.name: p.value for p in arm.PARAMETERS.records}
    for name in arm.FRICTION:
        assert found[name] == pytest.approx(true[name], rel=1e-3)
    with pytest.raises(InputError, match="a search that starts on a bound stays there"):
        arm.friction_from(0.0, log)


def test_a_free_run_that_ends_elsewhere_says_that_its_residual_is_more_than_noise(example):
    arm = example("inertials_and_bounds")
    log = arm.record()
    lost = assess(estimate(arm.arm(), log, arm.FRICTION, dict.fromkeys(arm.FRICTION, 1e-8)))
    assert any("That is more than noise" in sentence for sentence in fit_verdict(lost))


def test_the_logs_of_the_elbow_are_those_that_its_script_records(example, tmp_path):
    record = example("record", "examples/elbow")
    record.write(tmp_path)
    for name in ("first.csv", "second.csv"):
        kept, made = (np.loadtxt(p / name, delimiter=",", skiprows=1) for p in (ELBOW, tmp_path))
        np.testing.assert_allclose(made[:, :2], kept[:, :2], rtol=1e-5, atol=1e-6)
        # rounding of a sine may move a reading to the next count, on another processor
        assert np.abs(made[:, 2] - kept[:, 2]).max() < 1.1 * 2 * np.pi / record.COUNTS


def test_the_elbow_is_its_model_with_dry_friction_and_without_it_is_not(example):
    record = example("record", "examples/elbow")
    robot = read_robot(ELBOW / "elbow.toml", ELBOW / "first.csv")
    log, plant = robot.log, robot.plant
    values = {"mass": record.MASS, "damping": record.DAMPING}
    right = {**values, "coulomb_friction.f_c@elbow": record.FRICTION}
    rms = [np.sqrt(np.mean(window_error(plant, log, 0.3, v) ** 2)) for v in (right, values)]
    noise = np.hypot(record.NOISE, 2 * np.pi / record.COUNTS / np.sqrt(12))
    assert rms[0] < 1.1 * noise
    assert rms[1] > 3 * noise
