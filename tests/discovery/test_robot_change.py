"""A robot that changes after the fitted samples is told from one that does not."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from discovery_cases import EFFECTS, SENSOR, SLIDER, STEP, base, record, slider, wander

from identification.discovery.findings.robot_change import _onset, find_robot_change
from identification.discovery.fitted_model import fit_model
from identification.discovery.search import discover
from identification.errors import DivergenceError

N = 800


def changing(damping, seed=11):
    """A log of the slider whose damping becomes another one after its first half."""
    log = record(slider(mass=2.2, damping=2.7), N, seed=seed)
    model = mujoco.MjModel.from_xml_string(SLIDER)
    model.body_mass[1], model.dof_damping[0] = 2.2, 2.7
    data = mujoco.MjData(model)
    mujoco.mj_setConst(model, data)
    y = np.zeros((N, 1))
    for k in range(1, N):
        model.dof_damping[0] = 2.7 if k < N // 2 else damping
        data.ctrl[:] = log.inputs[k - 1]
        mujoco.mj_step(model, data, round(STEP / model.opt.timestep))
        y[k] = data.qpos
    noise = SENSOR * np.random.default_rng(seed).standard_normal(y.shape)
    return replace(log, outputs=y + noise)


def far(said):
    """How many times as much is missed."""
    return float(said.split(" times as much as")[0].split()[-1])


@pytest.mark.parametrize("seed", range(4))
def test_a_robot_that_stays_as_it_is_has_not_changed(seed):
    error = wander(N, 0.03 * (seed % 2), 0.1, seed=seed)
    log = record(slider(mass=2.2, damping=2.7), N, seed=seed, error=error)
    assert find_robot_change(fit_model(base(), log, (), {})) == ()
    assert find_robot_change(fit_model(base(), changing(2.7, seed), (), {})) == ()


@pytest.mark.parametrize("first", [0, 100, 260])
def test_the_change_is_dated(first):
    rng = np.random.default_rng(first)
    power = rng.chisquare(8, (2, 400)) / 8
    power[1, first:] *= 3
    assert abs(_onset(*power) - first) <= 20  # a block


def test_a_robot_that_a_small_change_of_a_parameter_loses_is_judged_without_it(monkeypatch):
    step = fit_model(base(), changing(4.0), (), {})
    (said,) = find_robot_change(step)

    def lost(*_):
        raise DivergenceError("lost")

    monkeypatch.setattr(
        "identification.discovery.findings.robot_change.evaluate_sensitivities", lost
    )
    (other,) = find_robot_change(step)
    assert far(other) > far(said) > 2


def test_a_change_after_the_fitted_samples_is_never_called_nothing_missing():
    log = changing(4.0)
    (said,) = find_robot_change(fit_model(base(), log, (), {}))
    assert "times as much as those that were" in said
    answer = discover(base(), log, EFFECTS)
    assert answer.verdict == "unknown effect"
    assert said in answer.left
