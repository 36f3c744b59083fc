"""Elastic gears, gaps and presliding against analytic cases and against scipy's integration."""

from dataclasses import replace

import numpy as np
import pytest
from joint_cases import run
from records_cases import record
from state_cases import (
    DRAG,
    F_C,
    PRESLIDING,
    STEP,
    WHOLE,
    Truth,
    elastic,
    gap,
    moved,
    pendulum,
    with_values,
)

from identification import InputError
from identification.model.predictor import Predictor
from identification.model.rollout import State, rollout

LOG = record(3, samples=100)
EACH = [(elastic(0.03), 0.0), (gap(0.01), 0.0), ({PRESLIDING: 0.1}, F_C)]
NAMES = ("joint_elasticity", "gear_backlash", "presliding")


def states_of(plant, values, start, samples, u=0.0, sampling=STEP):
    """q, v, θ, ω of a plant from states as MuJoCo integrates them, shape (samples, 4)."""
    names, row = tuple(values), np.array([[*values.values()]])
    _, numbers = plant.settings(names, row)
    made = rollout(
        plant.model, start, np.full((samples, 1), u), sampling, numbers=numbers,
        record=("qpos", "qvel", "act"),
    )  # fmt: skip
    return np.hstack([made["qpos"][0], made["qvel"][0], made["act"][0]])


@pytest.mark.parametrize("hidden", [0.0, F_C])
def test_sizes_of_zero_keep_the_model_without_states_to_the_bit(hidden):
    plain = pendulum(hidden)
    every = plain.with_states_of([*elastic(0.0), *gap(0.0), PRESLIDING])
    assert every.model.na == 3
    np.testing.assert_array_equal(run(every, LOG), run(plain, LOG))
    rows = np.array([[0.0], [0.03], [0.0]])
    batch = Predictor(every, LOG, (next(iter(elastic(0.0))),)).predict(rows)
    np.testing.assert_array_equal(batch[0], run(plain, LOG))
    np.testing.assert_array_equal(batch[2], run(plain, LOG))
    assert not np.array_equal(batch[1], batch[0])


@pytest.mark.parametrize(("values", "f_c"), EACH, ids=NAMES)
def test_what_tends_to_zero_tends_to_the_model_without_it_in_proportion(values, f_c):
    size = next(iter(values))
    plant = with_values(values, f_c, 0.005)
    plain = run(pendulum(f_c), LOG)

    def apart(x):
        return np.abs(run(plant, LOG, **{**values, size: x}) - plain).max()

    far = apart(1e-5)
    assert 0 < far < 1e-4
    assert apart(1e-6) == pytest.approx(far / 10, rel=0.1)
    assert apart(1e-9) < 1e-8


@pytest.mark.parametrize("link", [0.0, 1.0])
def test_an_elastic_gear_is_that_of_another_integration_with_order_4(link):
    truth, values = Truth(c=0.03), elastic(0.03, link=link)
    expected = moved(truth, LOG, "link" if link else "motor")
    errors = [
        np.abs(run(with_values(values, step=h), LOG, **values) - expected).max()
        for h in (0.005, 0.0025, 0.00125)
    ]
    assert np.abs(run(pendulum(0.0), LOG) - expected).max() > 5e-3
    assert errors[0] < 1e-3
    assert errors[0] / errors[1] > 12
    assert errors[1] / errors[2] > 12


@pytest.mark.parametrize("c", [0.03, 1e-6])
def test_a_motor_that_is_damped_is_that_of_another_integration(c):
    """Behind a gear that is as good as rigid, the damping is the joint's own."""
    values = {**elastic(c), DRAG: 0.02}
    truth = Truth(c=c, d_m=0.02) if c > 1e-3 else Truth(d=0.04)
    damped = run(with_values(values, step=0.00125), LOG, **values)
    expected = moved(truth, LOG)
    plain = moved(replace(truth, d=0.02, d_m=0.0), LOG)
    assert np.abs(plain - expected).max() > 0.05
    assert np.abs(damped - expected).max() < 1e-4
    alone = {DRAG: 0.02}
    rigid = run(pendulum(0.0), LOG)
    np.testing.assert_array_equal(run(pendulum(0.0).with_states_of(alone), LOG, **alone), rigid)


def test_friction_that_gives_and_teeth_that_meet_converge_to_another_integration():
    for truth, values, f_c, least in (
        (Truth(slip=0.1, f_c=F_C), {PRESLIDING: 0.1}, F_C, 20.0),
        (Truth(c=1e-5, gap=0.01, zeta=1.0), gap(0.01), 0.0, 3.0),
    ):
        expected = moved(truth, LOG, tight=1e-7)
        coarse, fine = (
            np.abs(run(with_values(values, f_c, h), LOG, **values) - expected).max()
            for h in (0.005, 0.0005)
        )
        assert np.abs(run(pendulum(f_c, 0.0005), LOG) - expected).max() > 5e-3
        assert fine < coarse / least
        assert fine < 2e-3


def test_two_masses_swing_with_their_frequency_and_keep_energy_and_momentum():
    c, J = 0.05, 2e-3
    M = WHOLE - J
    values = {**elastic(c, J, zeta=1e-3), "d": 0.0, "joint_elasticity.zeta": 1e-3}
    plant = with_values(values, step=0.001, weight=False)
    begun = 0.02  # [rad]
    start = State(np.zeros(1), np.zeros(1), np.array([begun, 0.0]))
    q, v, theta, omega = states_of(plant, values, start, 100).T
    reduced = 1 / (1 / J + 1 / M)
    w = np.sqrt(1 / (c * reduced))
    fade = 1e-3 * np.sqrt(J / c) / reduced  # of the damper, ζ = 1e-3
    t = STEP * np.arange(100)
    expected = begun * np.exp(-fade * t) * (np.cos(w * t) + fade / w * np.sin(w * t))
    np.testing.assert_allclose(theta - q, expected, atol=2e-3 * begun)
    np.testing.assert_allclose(M * v + J * omega, 0.0, atol=1e-15)
    np.testing.assert_allclose(M * q + J * theta, J * begun, atol=1e-15)
    energy = M * v**2 / 2 + J * omega**2 / 2 + (theta - q) ** 2 / (2 * c)
    shrinks = np.exp(-2 * fade * t)
    np.testing.assert_allclose(energy, energy[0] * shrinks, rtol=5e-3)


def test_inside_its_gap_the_motor_is_free_and_momentum_is_kept_when_teeth_meet():
    eps, J = 0.02, 2e-3
    M, values = WHOLE - J, {**gap(eps, J), "d": 0.0}
    plant = with_values(values, step=0.001, weight=False)
    start = State(np.zeros(1), np.zeros(1), np.array([0.0, 0.5]))
    q, v, theta, omega = states_of(plant, values, start, 40).T
    before = slice(0, int(np.argmax(theta > 0.9 * eps)))
    assert before.stop > 2
    np.testing.assert_array_equal(q[before], 0.0)
    np.testing.assert_allclose(omega[before], 0.5, rtol=1e-15)
    np.testing.assert_allclose(M * v + J * omega, J * 0.5, rtol=1e-12)
    assert abs(v[-1] - omega[-1]) < 0.3 * 0.5  # teeth rebound by little
    rest = State(np.zeros(1), np.zeros(1), np.zeros(2))
    q, v, theta, omega = states_of(plant, values, rest, 100, u=0.1).T
    assert (theta - q)[-1] == pytest.approx(eps, rel=1e-3)  # under a load they touch
    assert v[-1] == pytest.approx(omega[-1], rel=1e-4)


def test_presliding_has_the_slope_and_the_break_away_force_of_dahl():
    """Under a force that grows by little, v is slow: p = b (1 - exp(-q/(c b)))."""
    c, values = 0.2, {PRESLIDING: 0.2}
    plant = with_values(values, F_C, 0.001, weight=False)
    _, numbers = plant.settings((PRESLIDING, "d"), np.array([[c, 0.1]]))
    u = np.concatenate([np.linspace(0, 0.9, 400), np.linspace(0.9, 0.0, 400)]) * F_C
    made = rollout(plant.model, State(np.zeros(1), np.zeros(1), np.zeros(1)), u[:, None], STEP,
                   numbers=numbers, record=("qpos", "act"))  # fmt: skip
    q, p = made["qpos"][0, :, 0], made["act"][0, :, 0]
    up = slice(1, 400)
    np.testing.assert_allclose(p[up], F_C * -np.expm1(-q[up] / (c * F_C)), rtol=1e-3, atol=1e-5)
    np.testing.assert_allclose(p[up], u[:399], atol=0.05 * F_C)
    slope = (p[5] - p[1]) / (q[5] - q[1])
    assert slope == pytest.approx(1 / c, rel=0.03)
    assert q[-1] > 0.1 * q.max()  # what slipped does not come back
    back = c * F_C * np.log((1 + p[450] / F_C) / (1 + p[700] / F_C))  # dp/dq = (1 + p/b)/c
    assert q[450] - q[700] == pytest.approx(back, rel=0.05)
    pushed = rollout(plant.model, State(np.zeros(1), np.zeros(1), np.zeros(1)),
                     np.full((200, 1), 1.2 * F_C), STEP, numbers=numbers,
                     record=("qpos", "act"))  # fmt: skip
    assert pushed["act"][0, -1, 0] == pytest.approx(F_C, rel=1e-3)


def test_a_plant_without_the_states_refuses_the_size_and_one_that_is_told_it_gets_them():
    values = elastic(0.03)
    with pytest.raises(InputError, match="with_states_of"):
        run(pendulum(0.0), LOG, **values)
    told = pendulum(0.0).with_values(values)
    assert told.states
    np.testing.assert_array_equal(
        run(told, LOG), run(with_values(values, step=0.005), LOG, **values)
    )
    assert told.without_states().states == ()
    np.testing.assert_array_equal(run(told.without_states(), LOG), run(pendulum(0.0), LOG))


def test_states_of_windows_are_the_measured_ones_behind_the_encoder():
    plant = with_values(elastic(0.03))
    names, row = tuple(elastic(0.0)), np.array([[*elastic(0.03).values()]])
    known = State(np.array([[0.4]]), np.array([[1.0]]), np.array([[0.5, 2.0]]))
    begun = plant.begun(names, row, known)
    assert begun.act[0] == pytest.approx([0.4, 1.0])
    assert begun.qpos[0, 0] == pytest.approx(0.4 - 0.03 * 0.5)
    assert begun.qvel[0, 0] == pytest.approx(1.0 - 0.03 * 2.0)
    run_ = {f: getattr(begun, f)[:, None] for f in ("qpos", "qvel", "act")}
    shown = plant.shown(names, row, run_)
    assert (shown["qpos"].item(), shown["qvel"].item()) == pytest.approx((0.4, 1.0))
