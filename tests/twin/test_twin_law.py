"""A cable never pushes, currents have limits, and every parameter counts.

That the law is that of the equations is the cross-check's (`tests/reference/test_crosscheck.py`).
"""

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from twin_cases import every_step, forward, moving, random_state, seeds, sets

from identification.model.paths import read, resolve
from identification.model.rollout import State
from inca_mj.robot.parameters import parameter_set
from inca_mj.twin.twin import build_twin


@cache
def nominal():
    return build_twin()


@settings(deadline=None, max_examples=20)
@given(seeds, sets)
def test_a_cable_never_pushes(seed, name):
    robot = nominal().with_values(parameter_set(name).values())
    at, ctrl = random_state(seed, 100)
    (sensors,) = forward(robot.model, at, ctrl, ("sensordata",))
    T, no_load = (
        sensors[:, (a := robot.model.sensor(f"{name}_1").adr[0]) : a + 8]
        for name in ("tension", "no_load_length")
    )
    np.testing.assert_array_equal(no_load, at.act)
    assert T.min() == 0
    assert 0.2 < np.mean(T == 0) < 0.8


def test_the_control_range_clamps_the_current():
    at, _ = random_state(1)
    limited = build_twin()
    limited.model.actuator_ctrllimited[:] = 1
    limited.model.actuator_ctrlrange[:] = -1.5, 1.5
    ctrl = np.linspace(-3, 3, 8)[None]
    (driven,) = forward(limited.model, at, ctrl, ("qfrc_actuator",))
    np.testing.assert_array_equal(driven[0, 6:], 0.08 * np.clip(ctrl[0], -1.5, 1.5))


ALL = [p for p in parameter_set()]


@pytest.mark.parametrize("parameter", ALL, ids=lambda p: p.name)
def test_every_parameter_has_an_effect(parameter):
    robot = build_twin()
    shift = 1e-2 * (parameter.value or 1.0)
    other = robot.with_values({parameter.name: parameter.value + shift})
    ours, theirs = (
        every_step(r, State(r.state().qpos, moving(1).qvel, r.state().act), np.ones((51, 8)))
        for r in (robot, other)
    )
    assert np.abs(ours["qpos"] - theirs["qpos"])[-1].max() > 1e-9


@pytest.mark.parametrize("parameter", [p for p in ALL if p.where != "start"], ids=lambda p: p.name)
def test_every_path_resolves_to_its_value(parameter):
    model = build_twin().model
    slot = resolve(model, parameter.where)
    assert read(model, slot) == parameter.value
    assert len(slot.rows) == (1 if "platform" in parameter.where else 8)
