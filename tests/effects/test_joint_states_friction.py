"""Friction of arms whose joints have states: it holds them together, gives, and slips."""

import copy

import mujoco
import numpy as np
import pytest
from arm_cases import FULL, LOG, Arm, arm_plant, elastic, gap, inertias, states_of, weighing
from joint_cases import run

from identification.effects.plant.joint_states import places_of
from identification.model.paths import write
from identification.model.rollout import State

B = np.array([0.5, 0.2])
FRICTION = {"coulomb_friction.f_c@shoulder": B[0], "coulomb_friction.f_c@elbow": B[1]}
GRIP = {**FRICTION, "presliding.c": 0.1}
BENT = np.array([0.05, 0.1])  # gravity is less than friction there
ELASTIC = elastic({"shoulder": 0.02, "elbow": 0.03})


@pytest.mark.parametrize("integrator", ["RK4", "Euler"])
@pytest.mark.parametrize("c", [0.02, 1e-4, 1e-8], ids=["soft", "stiff", "rigid"])
def test_friction_holds_both_joints_of_a_resting_arm_behind_elastic_gears(integrator, c):
    assert np.all(np.abs(weighing(BENT)) < 0.9 * B)
    u = np.tile(0.1 * B, (200, 1))
    values = {**elastic(dict.fromkeys(("shoulder", "elbow"), c), zeta=0.3), **FRICTION}
    start = State(BENT, np.zeros(2), np.array([BENT[0], 0, BENT[1], 0]))
    got = states_of(arm_plant(0.001, integrator), values, start, u)
    assert np.abs(got["qpos"] - BENT).max() < 1e-9
    np.testing.assert_allclose(got["act"][-1, ::2] - BENT, c * 0.1 * B, rtol=0.02)


@pytest.mark.parametrize("integrator", ["RK4", "Euler"])
def test_friction_stops_an_arm_inside_the_gaps_of_its_gears(integrator):
    values = {**gap({"shoulder": 0.01, "elbow": 0.01}), **FRICTION}
    start = State(BENT, np.array([0.3, -0.4]), np.array([BENT[0], 0, BENT[1], 0]))
    got = states_of(arm_plant(0.002, integrator), values, start, np.zeros((200, 2)))
    assert np.abs(got["qvel"][1:8]).max() > 0.01
    assert np.abs(got["qvel"][-50:]).max() < 1e-9


@pytest.mark.parametrize("gear", [{}, ELASTIC], ids=["rigid", "elastic"])
def test_friction_that_gives_converges_to_another_integration(gear):
    c, J = ((0.02, 0.03), tuple(inertias(0.3))) if gear else ((0.0, 0.0), (0.0, 0.0))
    expected = Arm(slip=0.1, f_c=tuple(B), c=c, J=J).moved(LOG.inputs, tight=1e-8)[:, :2]
    values = {**GRIP, **gear}
    coarse, fine = (
        np.abs(run(arm_plant(h).with_states_of(values), LOG, **values) - expected).max()
        for h in (0.005, 0.00125)
    )
    assert np.abs(run(arm_plant(0.00125), LOG, **FRICTION) - expected).max() > 0.01
    assert coarse < 2e-4
    assert fine < coarse / 10


def test_on_a_slope_both_joints_rest_on_springs_that_friction_is():
    """p carries gravity and the drive, and dp/dq = (1 - p/b)/c where joints go forward."""
    c, p = 0.01, -weighing(BENT)
    u = np.linspace(0, 1, 400)[:, None] * 0.3 * B
    values = {**FRICTION, "presliding.c": c}
    got = states_of(arm_plant(), values, State(BENT, np.zeros(2), p), np.zeros((100, 2)))
    np.testing.assert_allclose(got["qpos"], np.tile(BENT, (100, 1)), atol=1e-12)
    got = states_of(arm_plant(), values, State(BENT, np.zeros(2), p), u)
    gone, carried = got["qpos"][-1] - BENT, got["act"][-1]
    pull = u[-1] - weighing(got["qpos"][-1])
    np.testing.assert_allclose(carried, pull, atol=2e-3)
    assert np.all((p < carried) & (carried < 0))
    way = c * B * np.log((1 - p / B) / (1 - carried / B))  # dp/dq = (1 - p/b)/c, forward
    np.testing.assert_allclose(gone, way, rtol=0.02)


def test_in_gross_sliding_friction_that_gives_is_coulombs():
    start = State(np.zeros(2), np.array([3.0, 2.0]), np.zeros(2))
    u = np.tile(FULL, (30, 1))
    slid = states_of(arm_plant(), {**FRICTION, "presliding.c": 1e-3}, start, u)
    np.testing.assert_allclose(slid["act"][-1], B, rtol=1e-6)
    plain = State(np.zeros(2), start.qvel, np.zeros(0))
    coulomb = states_of(arm_plant(), FRICTION, plain, u)
    way = np.ptp(coulomb["qpos"], axis=0)
    assert np.abs(slid["qpos"] - coulomb["qpos"]).max() < 2e-3 * way.max()


@pytest.mark.parametrize(
    ("integrator", "near"), [("Euler", 1e-9), ("implicitfast", 1e-9), ("implicit", 2e-3)]
)  # the last one takes slopes of Coriolis forces into the rate, which is not foreseen
@pytest.mark.parametrize("gear", [{}, ELASTIC], ids=["rigid", "elastic"])
def test_a_semi_implicit_step_moves_friction_and_motors_by_the_rates_at_its_end(
    integrator, near, gear
):
    values = {**GRIP, **gear}
    plant = arm_plant(0.002, integrator, damped=False).with_states_of(values)
    model = copy.copy(plant.model)
    for slot, value in plant.settings(tuple(values), np.array([[*values.values()]]))[1]:
        write(model, slot, float(value[0]))
    data = mujoco.MjData(model)
    places = places_of(model, plant.states)
    motors = [x for x, s in zip(places, plant.states, strict=True) if s.kind == "motor"]
    grips = [x for x, s in zip(places, plant.states, strict=True) if s.kind == "grip"]
    data.qpos[:], data.qvel[:], data.ctrl[:2] = [0.3, -0.8], [0.5, -0.4], [1.0, 0.3]
    data.act[grips], data.act[motors] = [0.1, 0.02], [0.3, -0.8][: len(motors)]
    before = np.array(data.act)
    mujoco.mj_step(model, data)
    h, v, p = model.opt.timestep, data.qvel, before[grips]
    expected = p + h * (v - np.abs(v) * p / B) / 0.1
    np.testing.assert_allclose(data.act[grips], expected, rtol=near)
    omega = data.act[[x + 1 for x in motors]]
    np.testing.assert_allclose((data.act - before)[motors], h * omega, rtol=1e-9)
