"""The inverse of a twin: what it gives to the motors makes the twin move as asked."""

import mujoco
import numpy as np
import pytest
from effect_cases import full

from inca_mj.control.inverse import Inverse, Tensions
from inca_mj.control.paths import Motion
from inca_mj.kinematics.jacobians import length_jacobian
from inca_mj.robot.geometry import INCA
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import build_twin

CENTRE = np.array([0.0, 0.0, 1.43])
EFFECTS = {
    "load_dependent_friction": {"load_dependent_friction.mu": 0.1},
    "spring_hysteresis": {"spring_hysteresis.eta": 0.2},
    "drum_eccentricity": {"drum_eccentricity.a": 0.05, "drum_eccentricity.b": -0.03},
    "torque_constant_mismatch": {"torque_constant_mismatch.delta@3": -0.2},
    "current_crosstalk": {"current_crosstalk.a": 0.1},
    "pulley_radius": {"pulley_radius.r_p": 0.02},
    "external_force": {"external_force.x": 0.5},
    "cable_weight": {"cable_weight.rho": 2e-3},
}


def motion(velocity=(0, 0, 0), acceleration=(0, 0, 0)):
    return Motion(CENTRE, np.array(velocity, float), np.array(acceleration, float))


def robot_with(name):
    return full().with_values(EFFECTS[name])


def test_at_rest_with_the_springs_tension_no_current_is_needed():
    robot = build_twin()
    needed = Inverse(robot, Tensions(near=4.0)).needed(motion(), np.zeros(6), np.zeros(8))
    np.testing.assert_allclose(needed.currents, 0, atol=1e-9)
    np.testing.assert_allclose(needed.tension, robot.start.tension, atol=1e-6)


def test_the_nominal_twin_gives_the_equations_of_the_thesis():
    robot, v = build_twin(), np.array([0.2, -0.3, 0.1])
    p, J = robot.parameters.values(), length_jacobian(CENTRE, np.eye(3), INCA)
    φ = np.linspace(-2, 2, 8)
    needed = Inverse(robot).needed(motion(v), np.zeros(6), φ)
    np.testing.assert_allclose(-J.T @ needed.tension, [0, 0, p["m"] * 9.81, 0, 0, 0], atol=1e-6)
    ω = -J[:, :3] @ v / p["R"]
    strain = needed.tension / p["lambda"]
    np.testing.assert_allclose(needed.rate, ω, rtol=strain.max())
    F_s = p["R"] / p["R_s"] * robot.start.tension - p["k_s"] * p["R_s"] * φ
    friction = p["b_v"] * ω + p["b_c"] * np.tanh(p["beta"] * ω)
    d = np.linalg.norm(CENTRE + INCA.B - INCA.A, axis=1)
    swing = -p["J"] / p["R"] * (v @ v - (J[:, :3] @ v) ** 2) / d  # J ω̇ of the turning cables
    torque = p["R"] * needed.tension - p["R_s"] * F_s + friction + swing
    np.testing.assert_allclose(needed.currents, torque / p["K_t"], atol=1e-4)


@pytest.mark.parametrize("name", EFFECTS)
def test_a_robot_with_an_effect_accelerates_as_asked(name):
    """The law at the state that the inverse has solved for: M q̈ of the platform and the motors."""
    robot, asked = robot_with(name), np.array([0.5, -0.4, 0.3, 2.0, -1.0, 1.0])
    inverse, v = Inverse(robot), np.array([0.1, 0.2, -0.1])
    needed = inverse.needed(motion(v), asked, np.linspace(-1, 1, 8))
    data = inverse._data  # at the motion, with its no-load lengths and currents
    data.ctrl[:] = needed.currents
    mujoco.mj_forward(robot.model, data)
    scale = 1 / np.array([0.1725] * 3 + [1e-4] * 3)  # [1/kg], [1/(kg m²)]: 1e-5 N, 1e-6 N m
    assert (np.abs(data.qacc[:6] - asked) < scale * [1e-5] * 6).all()
    if name in ("drum_eccentricity", "pulley_radius"):
        return  # the motors' way is not that of the nominal geometry
    J = length_jacobian(CENTRE, np.eye(3), INCA)
    d = np.linalg.norm(CENTRE + INCA.B - INCA.A, axis=1)
    d_ddot = J @ asked + (v @ v - (J[:, :3] @ v) ** 2) / d  # (thesis 2.18)
    np.testing.assert_allclose(data.qacc[6:], -d_ddot / 0.0175, atol=0.1)  # 8e-6 N m


@pytest.mark.parametrize("name", ["load_dependent_friction", "torque_constant_mismatch"])
def test_currents_held_at_rest_keep_a_robot_at_rest(name):
    robot = robot_with(name)
    needed = Inverse(robot, Tensions(near=7.0)).needed(motion(), np.zeros(6), np.zeros(8))
    run = simulate(robot, np.tile(needed.currents, (100, 1)))
    # The tension rises from the springs' 4 N to 7 N: strains of 1e-4 over 2.2 m, evenly.
    assert np.abs(run.position - CENTRE).max() < 1e-4
    np.testing.assert_allclose(run.tension[-1], needed.tension, atol=0.02)


def test_limits_of_tension_and_current_are_kept_where_the_wrench_allows():
    robot, limits = build_twin(), Tensions(near=7.0, low=5.0, high=9.0)
    for force in ([3.0, 0, 0], [0, -3.0, 2.0], [-2.0, 2.0, -2.0]):
        more = np.concatenate([np.array(force) / 0.1725, np.zeros(3)])
        needed = Inverse(robot, limits).needed(motion(), 0.1 * more, np.zeros(8))
        assert (needed.tension > 5.0 - 1e-3).all()
        assert (needed.tension < 9.0 + 1e-3).all()
        assert (needed.currents > -1e-3).all()
        assert (needed.currents < 2.0 + 1e-3).all()
