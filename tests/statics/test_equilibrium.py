"""The rest with constant currents: the twin comes to it, and energy is least there."""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import minimize
from statics_cases import ROBOT

from inca_mj import build_twin, parameter_set, simulate
from inca_mj.kinematics.cables import inverse
from inca_mj.robot.geometry import INCA
from inca_mj.robot.parameters import GRAVITY
from inca_mj.statics.equilibrium import equilibrium
from inca_mj.statics.robot import pull, static_robot

CURRENT = np.array([0.3, 0.0, 0.1, 0.0, 0.2, 0.0, 0.0, -0.05])


def test_with_the_power_off_it_is_the_start():
    rest = equilibrium(ROBOT)
    np.testing.assert_allclose(rest.pose, ROBOT.start, atol=1e-9)
    np.testing.assert_allclose(rest.tension, ROBOT.tension, atol=1e-9)
    np.testing.assert_allclose(rest.angle, 0, atol=1e-9)
    assert rest.stable


def test_the_twin_comes_to_rest_there():
    rest = equilibrium(ROBOT, CURRENT)
    run = simulate(build_twin(), np.tile(CURRENT, (6000, 1)), 0.01)
    # the twin's path is not quasi-static: its strain, 1e-4, is wound in a little differently
    np.testing.assert_allclose(run.position[-1], rest.pose[:3], atol=2e-4)
    np.testing.assert_allclose(run.angles[-1], rest.pose[3:], atol=2e-3)
    np.testing.assert_allclose(run.motor_angle[-1], rest.angle, atol=2e-2)
    np.testing.assert_allclose(run.tension[-1], rest.tension, atol=2e-3)
    assert np.linalg.norm(rest.pose[:3] - ROBOT.start[:3]) > 0.01  # it moved


def test_the_energy_is_least_there():
    """Energy of weight, load, drum springs and cables, with d₀ to first order in the strain."""
    load = np.array([0.3, -0.2, -0.4, 0.0, 0.0, 0.0])
    rest = equilibrium(ROBOT, load=load)

    def energy(x):
        d = inverse(x[:6], INCA).lengths
        φ = x[6:]
        d_0 = ROBOT.no_load - ROBOT.R * φ / (1 + ROBOT.tension / ROBOT.lambda_)
        cable = (0.5 * ROBOT.lambda_ * (d - d_0) ** 2 / d_0).sum()
        spring = (ROBOT.R * (0.5 * ROBOT.drum * φ**2 - ROBOT.tension * φ)).sum()
        return cable + spring + ROBOT.m * GRAVITY * x[2] - load[:3] @ x[:3]

    begin = np.concatenate([rest.pose + 0.01, rest.angle + 0.1])
    scale = np.r_[np.full(6, 0.01), np.full(8, 0.01)]
    found = minimize(lambda y: energy(begin + scale * y), np.zeros(14), method="BFGS",
                     options={"gtol": 1e-9, "maxiter": 2000})  # fmt: skip
    x = begin + scale * found.x
    np.testing.assert_allclose(x[:3], rest.pose[:3], atol=1e-3)
    np.testing.assert_allclose(x[3:6], rest.pose[3:], atol=3e-3)


def test_pull_is_the_law_turned_slowly():
    """dφ by d as the differential equations of the thesis have it, integrated along a slow path."""
    d_start = inverse(ROBOT.start, INCA).lengths
    λ, κ, R = ROBOT.lambda_, ROBOT.drum, ROBOT.R

    def rates(share, y):
        d_0 = y[:8]
        d = d_start + 0.4 * share
        # T = λ (d/d₀ − 1) = T(0) − κ φ, ḋ₀ = −R φ̇ d₀/d; d grows by 0.4 over the path
        φ_rate = -(λ * 0.4 / d_0) / (κ + λ * R / d_0)
        return np.concatenate([-R * φ_rate * d_0 / d, φ_rate])

    y = solve_ivp(rates, (0, 1), np.r_[ROBOT.no_load, np.zeros(8)], rtol=1e-11, atol=1e-13).y[:, -1]
    found = pull(ROBOT, d_start + 0.4)
    np.testing.assert_allclose(found.no_load, y[:8], atol=1e-9)
    np.testing.assert_allclose(found.angle, y[8:], atol=1e-7)
    np.testing.assert_allclose(found.tension, λ * ((d_start + 0.4) / y[:8] - 1), atol=1e-6)


def test_pull_joins_the_unwound_spring_without_a_step():
    d = np.linspace(0.2, 2.6, 400)[:, None] * np.ones(8)
    for current in (0.0, 0.1):
        found = pull(ROBOT, d, current)
        least = ROBOT.K_t * current / ROBOT.R
        assert (found.tension >= least - 1e-12).all()
        assert (np.abs(np.diff(found.tension, axis=0)) < 0.02).all()  # κ/R = 1.9 N/m, 6 mm
        assert (np.diff(found.angle, axis=0) < 0).all()
        np.testing.assert_allclose(np.diff(found.angle, axis=0) * ROBOT.R, -np.diff(d, axis=0),
                                   rtol=1e-3)  # fmt: skip
        unwound = found.stiffness == 0
        assert unwound.any()
        np.testing.assert_allclose(found.tension[unwound], np.broadcast_to(least, d.shape)[unwound])


def test_friction_holds_it_in_a_band():
    rest = equilibrium(ROBOT)
    none = static_robot(parameter_set("trial", {"b_c": 0.0}), INCA)
    assert (equilibrium(none).friction_band == 0).all()
    # one drum that holds b_c/R more shifts the rest by no more than the band
    shifted = equilibrium(ROBOT, np.r_[ROBOT.b_c[0] / ROBOT.K_t[0], np.zeros(7)])
    assert (np.abs(shifted.pose - ROBOT.start) <= 1.05 * rest.friction_band + 1e-12).all()
