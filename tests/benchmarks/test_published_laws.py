"""Models of others, made again: analytic cases, and the equations as their authors write them."""

import numpy as np
import pytest
from measured_cases import DATA, with_data
from robots import bam, double_pendulum
from robots.inverse_dynamics import Motion, gravity, torques
from robots.window_starts import best_errors

SPEED = np.linspace(-5, 5, 41)
MOTOR, LOAD = np.random.default_rng(0).uniform(-1, 1, (2, 41))
M1 = {"friction_base": 0.02, "friction_viscous": 0.004}
STRIBECK = {"friction_stribeck": 0.03, "dtheta_stribeck": 0.7, "alpha": 1.4}
M3 = {**M1, "load_friction_base": 0.2}


def test_m1_is_coulomb_and_viscous_friction_whatever_the_load():
    assert bam.friction(M1, MOTOR, LOAD, SPEED) == pytest.approx(0.02 + 0.004 * np.abs(SPEED))


def test_m2_is_m1_at_high_speed_and_the_peak_more_at_rest():
    p, zero = {**M1, **STRIBECK}, np.zeros(1)
    assert bam.friction(p, zero, zero, np.array([50.0])) == pytest.approx(0.02 + 0.2)
    assert bam.friction(p, zero, zero, zero) == pytest.approx(0.05)


def test_m3_grows_with_what_the_gears_transmit_and_is_m1_when_they_transmit_nothing():
    added = bam.friction(M3, MOTOR, LOAD, SPEED) - bam.friction(M1, MOTOR, LOAD, SPEED)
    assert added == pytest.approx(0.2 * np.abs(LOAD - MOTOR))
    assert bam.friction(M3, MOTOR, MOTOR, SPEED) == pytest.approx(
        bam.friction(M1, MOTOR, MOTOR, SPEED)
    )


def test_m5_with_equal_shares_is_m4_and_m6_without_its_squares_is_m5():
    m4 = {**M3, **STRIBECK, "load_friction_stribeck": 0.1}
    m5 = {
        **M1, **STRIBECK, "load_friction_motor": 0.2, "load_friction_external": 0.2,
        "load_friction_motor_stribeck": 0.1, "load_friction_external_stribeck": 0.1,
    }  # fmt: skip
    m6 = {**m5, "load_friction_motor_quad": 0.0, "load_friction_external_quad": 0.0}
    one, two, three = (bam.friction(p, MOTOR, LOAD, SPEED) for p in (m4, m5, m6))
    assert one == pytest.approx(two)
    assert two == pytest.approx(three)


SERVO = {"kt": 0.38, "R": 4.0, "armature": 0.002, "q_offset": 0.0}


def test_a_servo_whose_torque_is_below_its_friction_stays_where_it_is():
    volts = bam.measured_volts(np.full((1, 50), 0.3))  # 0.0285 N m
    still = np.zeros((1, 2))
    angles = bam.simulate({**SERVO, **M1, "friction_base": 0.03}, volts, still, 50, 0.01)
    assert np.all(angles == 0)
    angles = bam.simulate({**SERVO, **M1, "friction_base": 0.02}, volts, still, 50, 0.01)
    assert angles[0, -1] > 0.001


def test_without_motor_and_friction_the_arm_swings_with_the_period_of_a_pendulum():
    p = {**SERVO, "kt": 0.0}
    step, first = 0.001, np.array([[0.01, 0.0]])
    a = bam.simulate(p, bam.measured_volts(np.zeros((1, 3000))), first, 3000, step)[0]
    k = np.flatnonzero(a[1:] * a[:-1] < 0)
    crossings = (k + a[k] / (a[k] - a[k + 1])) * step
    inertia = bam.MASS * bam.ARM**2 + p["armature"]
    period = 2 * np.pi * np.sqrt(inertia / (bam.MASS * bam.G * bam.ARM))
    assert 2 * np.mean(np.diff(crossings)) == pytest.approx(period, rel=1e-4)


def test_the_servos_controller_brings_the_arm_to_its_goal_but_for_what_friction_holds():
    goals, supply = np.full((1, 300), 0.2), np.full((1, 300), 7.4)
    volts = bam.servo_volts(goals, supply, 400)
    end = bam.simulate({**SERVO, **M1}, volts, np.zeros((1, 2)), 300, 0.01)[0, -1]
    torque = SERVO["kt"] / SERVO["R"] * 7.4 * 400 * bam.DUTY  # for an error of one [N m/rad]
    held = bam.MASS * bam.G * bam.ARM * np.sin(end) - torque * (0.2 - end)
    assert abs(held) <= M1["friction_base"] + 1e-9
    assert volts(0.0, np.array([-10.0])) == pytest.approx(7.4)  # the bridge gives no more


def test_first_states_are_found_and_leave_the_noise_that_no_state_explains():
    t, rng = 0.01 * np.arange(30), np.random.default_rng(2)
    modes = np.stack([np.cos(3 * t), np.sin(3 * t) / 3], axis=-1)
    x = rng.standard_normal((6, 2))

    def simulate(first):
        return (first @ modes.T)[:, :, None]

    exact = best_errors(simulate, simulate(x), np.zeros((6, 2)), np.ones(2))
    assert np.abs(exact).max() < 1e-6
    noisy = simulate(x) + 0.1 * rng.standard_normal((6, 30, 1))
    left = best_errors(simulate, noisy, np.zeros((6, 2)), np.ones(2))
    assert np.abs(np.einsum("wl,ln->wn", left[:, :, 0], modes)).max() < 1e-4


MODEL_1_0 = {
    "I1": 0.05472, "I2": 0.02522, "Ir": 6.0719e-5, "gr": 6.0, "g": 9.81, "l1": 0.3, "m1": 0.608,
    "m2": 0.63, "r1": 0.275, "r2": 0.166,
}  # fmt: skip
MODEL_2_0 = {**MODEL_1_0, "I1": 0.0535, "I2": 0.0239, "Ir": 7.66e-5, "m1": 0.559, "r2": 0.184}


@pytest.mark.parametrize("p", [MODEL_1_0, MODEL_2_0], ids=["1.0", "2.0"])
def test_the_double_pendulum_moves_by_the_equations_of_its_authors(p):
    q, v, a = np.random.default_rng(1).uniform(-3, 3, (3, 20, 2))
    found = torques(double_pendulum.changed(p), Motion(0.01, q, v, a, a))
    I1, I2, Ir, n, g, l1, m1, m2, r1, r2 = p.values()
    c, s = np.cos(q[:, 1]), np.sin(q[:, 1])
    M11 = I1 + I2 + m2 * l1**2 + 2 * m2 * l1 * r2 * c + n**2 * Ir + Ir
    M12 = I2 + m2 * l1 * r2 * c - n * Ir
    M22 = I2 + n**2 * Ir
    G2 = m2 * g * r2 * np.sin(q[:, 0] + q[:, 1])
    G1 = (m1 * r1 + m2 * l1) * g * np.sin(q[:, 0]) + G2
    h = m2 * l1 * r2 * s
    tau1 = M11 * a[:, 0] + M12 * a[:, 1] - 2 * h * v[:, 1] * v[:, 0] - h * v[:, 1] ** 2 + G1
    tau2 = M12 * a[:, 0] + M22 * a[:, 1] + h * v[:, 0] ** 2 + G2
    assert found == pytest.approx(np.column_stack([tau1, tau2]), rel=1e-9, abs=1e-9)
    held = gravity(double_pendulum.changed(p), Motion(0.01, q, v, a, a))
    assert held == pytest.approx(np.column_stack([G1, G2]), rel=1e-9, abs=1e-9)


@with_data
def test_the_authors_parameters_of_the_ur10e_explain_its_torques():
    from robots.ur10e import read

    robot = read(DATA)
    e = robot.evidence(_outcome({p.name: p.value for p in robot.free}))
    for record in e["records"].values():
        share = np.array(record["left"]["the authors'"]) / np.array(record["torque"])
        assert np.all(share[1:3] < 0.12)  # the joints that carry the arm
    assert 0.03 < e["mu"][1] < 0.1


def _outcome(values):
    from robots.measured_robot import Outcome

    return Outcome(values=values, nominal=None, final=None)
