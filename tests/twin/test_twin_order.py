"""RK4 of order 4, where the motion is smooth; of order 2, where MuJoCo turns a quaternion."""

from dataclasses import fields

import mujoco
import numpy as np
import pytest
from effect_cases import full
from scipy.integrate import simpson
from twin_cases import every_step, forward, moving

from identification.model.rollout import State
from inca_mj.reference import derivative, pack, rest, simulate_reference
from inca_mj.reference import layout as at
from inca_mj.robot.geometry import INCA
from inca_mj.robot.inputs import make_input, prbs
from inca_mj.robot.parameters import GRAVITY, SETS, parameter_set
from inca_mj.twin.run import simulate
from inca_mj.twin.statics import start_from, starts_from
from inca_mj.twin.twin import build_twin
from inca_mj.verification.derivatives import to_mujoco
from inca_mj.verification.trajectories import slope

COARSE = (1e-3, 5e-4, 2.5e-4)
FINE = (2.5e-4, 1.25e-4, 6.25e-5)
TIME = np.arange(21) * 0.01
LIFT = np.tile([0.2] * 4 + [0.6] * 4, (21, 1))  # the same in all upper drives: it does not turn


def errors(start, steps, by):
    exact = simulate_reference(parameter_set(), INCA, TIME, LIFT, start=start)
    assert exact.tension.min() > 1
    return [float(np.abs(by(h) - exact.angles).max()) for h in steps]


def of_the_twin(start):
    state = to_mujoco(start)
    return lambda h: simulate(build_twin(timestep=h), LIFT, start=state).motor_angle


def of_the_reference(start):
    """Angles by the classic Runge-Kutta method with step h, as the twin's but in Euler angles."""
    q = pack(parameter_set(), INCA)

    def angles(h):
        rows, x = [start], start
        for current in LIFT[:-1]:
            for _ in range(round(0.01 / h)):
                k_1 = derivative(x, current, q)
                k_2 = derivative(x + h / 2 * k_1, current, q)
                k_3 = derivative(x + h / 2 * k_2, current, q)
                k_4 = derivative(x + h * k_3, current, q)
                x = x + h / 6 * (k_1 + 2 * k_2 + 2 * k_3 + k_4)
            rows.append(x)
        return np.array(rows)[:, at.ANGLES]

    return angles


def test_order_4_when_the_handle_moves_without_turning():
    start = rest(parameter_set(), INCA).state
    measured = slope(COARSE, errors(start, COARSE, of_the_twin(start)))
    assert measured == pytest.approx(4, abs=0.2)


@pytest.mark.skipif(
    int(mujoco.__version__.split(".")[0]) > 3, reason="MuJoCo 4 integrates turns to fourth order"
)
def test_order_2_is_left_when_it_turns_and_it_is_the_quaternions():
    start = rest(parameter_set(), INCA).state.copy()
    start[at.RATES] = 3.0, -2.0, 5.0
    ours = errors(start, FINE, of_the_twin(start))
    assert slope(FINE, ours) == pytest.approx(2, abs=0.4)
    # RK4 on the same motion in Euler angles knows no such error.
    assert errors(start, FINE[1:2], of_the_reference(start))[0] < ours[1] / 2


STEP = 2.5e-4
CURRENT = np.array([1.0, 0.5, 1.0, 0.5, 0.5, 1.0, 1.0, 0.5])


def ledger(p, start, T_0, steps=800):
    """Stored energy (N,), powers (5, N) and tensions (N, 8) along a run of the twin."""
    robot = build_twin(p, timestep=STEP)
    currents = np.tile(CURRENT, (steps + 1, 1))
    at = State(**every_step(robot, start, currents))
    d, d_rate, sensors = forward(
        robot.model, at, currents, ("ten_length", "ten_velocity", "sensordata")
    )
    first = robot.model.sensor("tension_1").adr[0]
    T = sensors[:, first : first + 8]
    v = p.values()
    φ, ω, d_0 = at.qpos[:, 7:], at.qvel[:, 6:], at.act
    ε = np.maximum(0, d / d_0 - 1)
    d_0_rate = -v["R"] * ω * d_0 / d

    inertia = np.array([v["m"]] * 3 + [v["I_x"], v["I_y"], v["I_z"]] + [v["J"]] * 8)
    s = v["R_s"] * φ
    stored = (
        0.5 * at.qvel**2 @ inertia
        + v["m"] * GRAVITY * at.qpos[:, 2]
        + np.sum(0.5 * v["lambda"] * ε**2 * d_0, axis=1)
        - np.sum((v["R"] / v["R_s"] * T_0 - 0.5 * v["k_s"] * s) * s, axis=1)
    )
    powers = np.array(
        [
            v["K_t"] * CURRENT * ω,
            -v["b_v"] * ω**2,
            -v["b_c"] * np.tanh(v["beta"] * ω) * ω,
            -(T - v["lambda"] * ε) * (d_rate - d / d_0 * d_0_rate),
            0.5 * v["lambda"] * ε**2 * d_0_rate,  # strain that is wound onto the rollers
        ]
    ).sum(axis=2)
    return stored, powers, T


@pytest.mark.parametrize("losses", [False, True])
def test_the_balance_closes(losses):
    p = parameter_set("trial", {} if losses else {"b": 0.0, "b_v": 0.0, "b_c": 0.0})
    stored, powers, T = ledger(p, moving(4), build_twin(p).start.tension)
    work = simpson(powers, dx=STEP, axis=1)
    exchanged = simpson(np.abs(powers).sum(axis=0), dx=STEP)
    assert T.min() > 0
    assert stored[-1] - stored[0] == pytest.approx(work.sum(), abs=1e-7 * exchanged)
    assert abs(work[4]) > 1e-6 * exchanged  # without the wound strain it would not close
    if losses:
        assert work[1:4].max() < 0
    else:
        np.testing.assert_allclose(work[1:4], 0, atol=1e-12 * exchanged)


def test_the_balance_closes_while_cables_turn_slack_and_taut():
    p, start = parameter_set(), build_twin().state()
    start.qvel[:3] = 0.5, 0.3, 0.4
    stored, powers, T = ledger(p, start, build_twin(p).start.tension, steps=400)
    work = simpson(powers, dx=STEP, axis=1).sum()
    assert (T == 0).any(axis=0).sum() >= 2
    # A kink within a step costs RK4 and Simpson their order.
    exchanged = simpson(np.abs(powers).sum(axis=0), dx=STEP)
    assert stored[-1] - stored[0] == pytest.approx(work, abs=1e-3 * exchanged)


# The sign of a polar vector's entries, and where each drive lands.
MIRRORS = {
    "x": (np.array([-1, 1, 1]), np.array([2, 1, 4, 3, 6, 5, 8, 7]) - 1),
    "y": (np.array([1, -1, 1]), np.array([4, 3, 2, 1, 8, 7, 6, 5]) - 1),
}


def mirrored(at, sign, drives):
    """p, v mirror; ω and a quaternion's vector part are axial and take det(M) M."""
    axial = np.prod(sign) * sign
    qpos, qvel = np.atleast_2d(at.qpos), np.atleast_2d(at.qvel)
    return State(
        np.hstack([sign * qpos[:, :3], qpos[:, 3:4], axial * qpos[:, 4:7], qpos[:, 7:][:, drives]]),
        np.hstack([sign * qvel[:, :3], axial * qvel[:, 3:6], qvel[:, 6:][:, drives]]),
        np.atleast_2d(at.act)[:, drives],
    )


@pytest.mark.parametrize("axis", MIRRORS)
def test_a_mirrored_start_and_input_give_the_mirrored_run(axis):
    sign, drives = MIRRORS[axis]
    robot, start, currents = build_twin(), moving(3), prbs(101, 0.01, seed=5)
    run = simulate(robot, currents, start=start)
    image = simulate(robot, currents[:, drives], start=mirrored(start, sign, drives))
    expected = mirrored(State(run.qpos, run.qvel, run.act), sign, drives)
    np.testing.assert_allclose(image.qpos, expected.qpos, atol=1e-10)
    np.testing.assert_allclose(image.tension, run.tension[:, drives], atol=1e-8)
    assert np.abs(run.motor_angle[-1]).max() > 1


OFF = {"x": 0.04, "y": -0.03, "z": 1.5, "roll": 0.1, "pitch": -0.05, "yaw": 0.15}


@pytest.mark.parametrize("values", [{}, OFF], ids=["nominal", "off-nominal"])
@pytest.mark.parametrize("name", SETS)
def test_at_rest_it_stays_for_ten_seconds(name, values):
    robot = build_twin(parameter_set(name, values))
    run = simulate(robot, make_input("zero", 10.0))
    assert np.abs(run.position - run.position[0]).max() < 1e-9
    assert np.abs(run.motor_angle).max() < 1e-7
    np.testing.assert_allclose(run.tension, np.tile(robot.start.tension, (1001, 1)), atol=1e-7)


def test_the_pretension_is_near_four_newton_and_carries_the_weight():
    tension = build_twin().start.tension
    assert np.linalg.norm(tension - 4.0) < 1.0
    # The upper cables carry the platform: they pull more than the lower ones.
    assert tension[4:].min() > tension[:4].max()


@pytest.mark.parametrize("seed", range(2))
def test_starts_that_are_shared_are_those_of_each_value_set(seed):
    robot = full(settled=True)
    rng, own = np.random.default_rng(seed), robot.parameters.values()
    names = [*own]
    values = np.tile(list(own.values()), (1 + len(names), 1))
    values[1 + np.arange(len(names)), np.arange(len(names))] += rng.uniform(1e-5, 1e-4, len(names))
    shared = starts_from(own, names, values, robot.geometry, robot.layout)
    assert len({id(start) for start in shared}) < 0.7 * len(shared)
    for row, start in zip(values, shared, strict=True):
        alone = start_from(dict(zip(names, row, strict=True)), robot.geometry, robot.layout)
        for field in fields(start):
            np.testing.assert_array_equal(getattr(start, field.name), getattr(alone, field.name))
