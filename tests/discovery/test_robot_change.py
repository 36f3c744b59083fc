"""A robot that changes after the fitted samples is told from one that does not."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from discovery_cases import (
    EFFECTS,
    OPTIONS,
    SENSOR,
    SLIDER,
    STEP,
    nominal_model,
    record,
    slider,
    task,
    wander,
)

from identification.discovery.findings.finding import FindingKind
from identification.innovations.discovery import discover
from identification.innovations.findings import find_onset, find_robot_change, has_changed
from identification.innovations.fitted_model import fit_model

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


def changes(log):
    """What is found of a change by the nominal model that is fitted to a log."""
    return find_robot_change(fit_model(task(log), (), {}).validation, OPTIONS)


@pytest.mark.parametrize("seed", [0, 1])
def test_a_robot_that_stays_as_it_is_has_not_changed(seed):
    error = wander(N, 0.03 * (seed % 2), 0.1, seed=seed)
    log = record(slider(mass=2.2, damping=2.7), N, seed=seed, error=error)
    assert changes(log) == ()
    assert changes(changing(2.7, seed)) == ()


def rate(trials, options=OPTIONS, last=0, times=1.0):
    """How often power of which the last samples are so many times as large is called larger."""
    rng, hits = np.random.default_rng(1), 0
    for _ in range(trials):
        power = rng.chisquare(8, (2, 400)) / 8
        power[1, 400 - last :] *= times
        hits += has_changed(*power, options)
    return hits / trials


def test_a_change_shortly_before_the_end_is_seen():
    assert rate(100, last=40, times=2.0) > 0.9  # a tenth of what no fit has seen


def test_every_block_in_which_a_change_may_begin_is_paid_for():
    """Without the price 6.6 % are called changed."""
    assert rate(1000, replace(OPTIONS, structure_level=0.01)) <= 0.025


@pytest.mark.parametrize("first", [0, 260])
def test_the_change_is_dated(first):
    rng = np.random.default_rng(first)
    power = rng.chisquare(8, (2, 400)) / 8
    power[1, first:] *= 3
    assert abs(find_onset(*power, OPTIONS.proof_blocks) - first) <= 20  # a block


def test_a_change_after_the_fitted_samples_is_never_called_nothing_missing():
    log = changing(4.0)
    (found,) = changes(log)
    assert found.kind is FindingKind.ROBOT_CHANGE
    answer = discover(nominal_model(), log, EFFECTS)
    assert answer.verdict == "unknown effect"
    times = [f.evidence.time for f in answer.findings if f.kind is FindingKind.ROBOT_CHANGE]
    assert times == [found.evidence.time]
