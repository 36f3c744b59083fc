"""The compiled law is the equations, written out slowly; a cable never pushes."""

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from twin_cases import every_step, forward, laws, moving, random_state, seeds, sets

from identification.model.paths import read, resolve
from identification.model.rollout import State
from inca_mj.robot.parameters import parameter_set
from inca_mj.twin.twin import build_twin


@cache
def nominal():
    return build_twin()


def slow_law(v, T_0, at, d, d_rate, J):
    """Tension, ḋ₀, and the generalized force beside the motors' viscous friction."""
    φ, ω, d_0 = at.qpos[0, 7:], at.qvel[0, 6:], at.act[0]
    d_0_rate = -v["R"] * ω * d_0 / d
    T = np.maximum(0, v["lambda"] * (d - d_0) / d_0 + v["b"] * (d_rate - d_0_rate))
    F_s = np.maximum(0, v["R"] / v["R_s"] * T_0 - v["k_s"] * v["R_s"] * φ)
    force = -T @ J
    force[6:] += -v["R"] * T + v["R_s"] * F_s - v["b_c"] * np.tanh(v["beta"] * ω)
    return T, d_0_rate, force


@settings(deadline=None, max_examples=50)
@given(seeds, laws)
def test_the_callbacks_are_the_equations(seed, values):
    robot = nominal().with_values(values)
    at, ctrl = random_state(seed)
    d, d_rate, sparse, passive, act_dot, sensors, driven = (
        a[0]
        for a in forward(
            robot.model,
            at,
            ctrl,
            ("ten_length", "ten_velocity", "ten_J", "qfrc_passive", "act_dot", "sensordata",
             "qfrc_actuator"),
        )
    )  # fmt: skip
    J = np.zeros((8, 14))
    m = robot.model
    for k in range(8):
        entries = slice(m.ten_J_rowadr[k], m.ten_J_rowadr[k] + m.ten_J_rownnz[k])
        J[k, m.ten_J_colind[entries]] = sparse[entries]
    T, d_0_rate, force = slow_law(robot.parameters.values(), robot.start.tension, at, d, d_rate, J)
    force[6:] -= values["b_v"] * at.qvel[0, 6:]  # MuJoCo's own joint damping
    tension, no_load = (
        sensors[(a := m.sensor(f"{n}_1").adr[0]) : a + 8] for n in ("tension", "no_load_length")
    )
    np.testing.assert_allclose(passive, force, rtol=1e-10, atol=1e-10)
    np.testing.assert_allclose(act_dot, d_0_rate, rtol=1e-14)
    np.testing.assert_allclose(tension, T, rtol=1e-9, atol=1e-9)
    np.testing.assert_array_equal(no_load, at.act[0])
    np.testing.assert_allclose(driven[6:], values["K_t"] * ctrl[0], rtol=1e-14)


@settings(deadline=None, max_examples=20)
@given(seeds, sets)
def test_a_cable_never_pushes(seed, name):
    robot = nominal().with_values(parameter_set(name).values())
    at, ctrl = random_state(seed, 100)
    (sensors,) = forward(robot.model, at, ctrl, ("sensordata",))
    first = robot.model.sensor("tension_1").adr[0]
    T = sensors[:, first : first + 8]
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
