"""The elastic catenary against its differential equation, its limits, and the usual formulas."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from statics_cases import ROBOT

from inca_mj import build_twin, parameter_set, simulate
from inca_mj.effects.cable import cable_weight
from inca_mj.effects.catalogue import CATALOGUE
from inca_mj.effects.hooks import Drive
from inca_mj.kinematics.cables import inverse
from inca_mj.robot.geometry import INCA
from inca_mj.robot.parameters import GRAVITY
from inca_mj.statics.cable_mass import NOISE, line_errors
from inca_mj.statics.catenary import ernst_modulus, hang, pulled, sag, sag_length
from inca_mj.statics.equilibrium import equilibrium

LAMBDA = 25000.0
EXIT, CONNECTOR = np.array([1.5, 1.5, 3.0]), np.array([0.1, -0.05, 1.4])
LOW = np.array([1.5, 1.5, 0.1])
CHORD = float(np.linalg.norm(EXIT - CONNECTOR))

rhos = st.floats(0, 5e-3)
strains = st.floats(-0.05, 3e-3)  # d/d₀ − 1: from a deep sag to 75 N


@given(st.sampled_from([EXIT, LOW]), rhos, strains)
@settings(max_examples=60, deadline=None)
def test_it_solves_the_differential_equation(exit_point, rho, strain):
    """dr/ds = (1 + T/λ) t, d(T t)/ds = ρ g z: integrated from the upper end, it meets the lower."""
    if rho < 1e-5 and strain < 1e-6:
        return  # slack without mass, see the refusals
    chord = float(np.linalg.norm(exit_point - CONNECTOR))
    cable = hang(exit_point, CONNECTOR, chord / (1 + strain), rho, LAMBDA)
    upper, lower = (exit_point, CONNECTOR) if cable.from_exit else (CONNECTOR, exit_point)
    along = (lower - upper)[:2] / np.linalg.norm((lower - upper)[:2])
    pull = np.array([*(cable.H * along), -cable.V])

    def rates(s, y):
        F = pull + np.array([0, 0, rho * GRAVITY * s])
        T = np.linalg.norm(F)
        return (1 + T / LAMBDA) * F / T

    end = solve_ivp(rates, (0, cable.no_load), upper, rtol=1e-11, atol=1e-12, max_step=0.05).y[
        :, -1
    ]
    np.testing.assert_allclose(end, lower, atol=2e-8)
    points = cable.points(21)
    np.testing.assert_allclose(points[0], exit_point, atol=1e-8)
    np.testing.assert_allclose(points[-1], CONNECTOR, atol=1e-8)


@given(rhos.filter(lambda rho: rho > 1e-6), strains)
@settings(max_examples=30, deadline=None)
def test_both_ends_together_carry_the_weight(rho, strain):
    d_0 = CHORD / (1 + strain)
    forth, back = hang(EXIT, CONNECTOR, d_0, rho, LAMBDA), hang(CONNECTOR, EXIT, d_0, rho, LAMBDA)
    both = forth.force_on_connector() + back.force_on_connector()
    np.testing.assert_allclose(both, [0, 0, -rho * GRAVITY * d_0], atol=1e-9 * max(1, forth.H))
    np.testing.assert_allclose(forth.points()[::-1], back.points(), atol=1e-9)


def test_without_mass_it_is_the_straight_elastic_line_and_tends_to_it():
    d_0 = CHORD / 1.0004
    s = (CONNECTOR - EXIT) / CHORD
    straight = -LAMBDA * (CHORD / d_0 - 1) * s
    np.testing.assert_allclose(hang(EXIT, CONNECTOR, d_0, 0.0, LAMBDA).force_on_connector(),
                               straight, rtol=1e-8)  # fmt: skip
    errors = [
        np.linalg.norm(hang(EXIT, CONNECTOR, d_0, rho, LAMBDA).force_on_connector() - straight)
        for rho in (1e-4, 1e-5, 1e-6)
    ]
    # of order ρ, since half of the weight hangs on the connector
    np.testing.assert_allclose(np.array(errors[:-1]) / errors[1:], 10, rtol=0.05)


def test_a_cable_of_a_given_tension_is_the_one_of_its_length():
    for T in (1.0, 4.0, 20.0):
        cable = pulled(EXIT, CONNECTOR, T, 2e-3, LAMBDA)
        assert np.linalg.norm(cable.force_on_connector()) == pytest.approx(T)
        again = hang(EXIT, CONNECTOR, cable.no_load, 2e-3, LAMBDA)
        assert pytest.approx(cable.H, rel=1e-6) == again.H
        assert float(again.tension(cable.no_load)) == pytest.approx(T, rel=1e-6)


def test_a_plumb_cable_carries_its_weight_and_no_more():
    below = np.array([1.5, 1.5, 1.0])
    cable = hang(EXIT, below, 2.0 / 1.0002, 3e-3, LAMBDA)
    top, end = float(cable.tension(0.0)), float(cable.tension(cable.no_load))
    assert top - end == pytest.approx(3e-3 * GRAVITY * cable.no_load, rel=1e-9)
    stretched = cable.no_load * (1 + (top + end) / 2 / LAMBDA)
    assert stretched == pytest.approx(2.0, abs=1e-8)


def test_the_parabola_is_right_to_the_next_order():
    level = np.array([0.0, 0.0, 2.0]), np.array([2.2, 0.0, 2.0])
    for T, order in ((4.0, 0), (8.0, 1)):
        cable = pulled(*level, T, 3e-3, 1e12)  # cannot stretch, so that its length is the curve's
        longer = cable.no_load - 2.2
        assert longer == pytest.approx(sag_length(2.2, 2.2, cable.H, 3e-3), rel=1e-3 / 4**order)
        middle = 2.0 - cable.points(3)[1, 2]
        assert middle == pytest.approx(sag(2.2, cable.H, 3e-3), rel=1e-3 / 4**order)
    steep = pulled(EXIT, CONNECTOR, 4.0, 1e-3, LAMBDA)
    curve, T = steep.points(401), float(steep.tension(steep.no_load / 2))
    below = (EXIT + CONNECTOR)[2] / 2 - np.interp(-0.8, -curve[:, 0], curve[:, 2])  # x = 0.8 m
    assert below == pytest.approx(sag(CHORD, T, 1e-3), rel=0.01)


@pytest.mark.parametrize(("rho", "T"), [(1e-3, 4.0), (3e-3, 6.0)])
def test_ernst_has_the_slope_of_the_catenary(rho, T):
    level = np.array([0.0, 0.0, 2.0]), np.array([2.2, 0.0, 2.0])
    d_0 = pulled(*level, T, rho, LAMBDA).no_load
    step = np.array([1e-6, 0, 0])
    longer, shorter = (hang(level[0], level[1] + x, d_0, rho, LAMBDA).H for x in (step, -step))
    slope = (longer - shorter) / 2e-6 * d_0
    assert slope == pytest.approx(ernst_modulus(2.2, T, rho, LAMBDA), rel=5e-3)


@given(st.sampled_from([EXIT, LOW]), st.floats(1.0, 20.0))
@settings(max_examples=15, deadline=None)
def test_half_of_the_weight_hangs_on_the_connector(exit_point, T):
    """The twin's `cable_weight` is right to second order in ρ; without it the error is of first."""
    span = CONNECTOR - exit_point
    s = Drive(**dict.fromkeys(Drive._fields, np.nan))._replace(rx=span[0], ry=span[1], rz=span[2])
    wrong, without = [], []
    for rho in (2e-4, 1e-4):
        cable = pulled(exit_point, CONNECTOR, T, rho, LAMBDA)
        F = cable.force_on_connector()
        middle = float(cable.tension(cable.no_load / 2))
        line = -middle * span / np.linalg.norm(span)
        wrong.append(np.linalg.norm(F - line - np.array(cable_weight.py_func(s, (rho,)))))
        without.append(np.linalg.norm(F - line))
    assert wrong[0] < 0.02 * without[0]
    assert without[0] / without[1] == pytest.approx(2, rel=0.05)
    assert wrong[1] < wrong[0] / 1.9 or wrong[0] < 1e-6


def test_the_twin_with_cable_weight_rests_where_catenaries_balance():
    rho = 1e-3
    values = {"cable_weight.rho": rho}
    effects = tuple(e for e in CATALOGUE if e.name == "cable_weight")
    robot = build_twin(effects=effects).with_values(values)
    run = simulate(robot, np.zeros((6000, 8)), 0.01)
    pose = np.r_[run.position[-1], run.angles[-1]]
    at = inverse(pose, INCA)
    force, torque = np.zeros(3), np.zeros(3)
    for k in range(8):
        cable = hang(INCA.A[k], pose[:3] + at.arms[k], run.act[-1, k], rho, LAMBDA)
        F = cable.force_on_connector()
        force += F
        torque += np.cross(at.arms[k], F)
    weight = parameter_set("trial").values()["m"] * GRAVITY
    hanging = rho * GRAVITY * at.lengths.sum() / 2
    # sag shortens what is free: at 4 N by 3 µm, which is 0.04 N of tension in each cable
    assert abs(force[2] - weight) < 0.1 * hanging
    assert np.abs(force[:2]).max() < 0.02 * hanging
    assert np.abs(torque).max() < 0.02 * hanging * 0.08
    assert run.position[0, 2] - run.position[-1, 2] > 5e-3  # the weight moved it down


def test_errors_grow_with_the_mass_and_fall_with_the_tension():
    rows = line_errors(ROBOT, ROBOT.start, (3e-4, 1e-3), (1.0, 4.0))
    light_1, light_4, heavy_1, heavy_4 = rows
    assert [(e.rho, e.tension) for e in rows] == [(3e-4, 1), (3e-4, 4), (1e-3, 1), (1e-3, 4)]
    for more, less in ((light_1, light_4), (heavy_1, heavy_4), (heavy_1, light_1)):
        assert more.length > less.length
        assert more.force_half > less.force_half
        assert more.stiffness_lost > less.stiffness_lost
    # sag goes with (ρ/T)²
    assert heavy_1.length / light_1.length == pytest.approx((1 / 0.3) ** 2, rel=0.05)
    for e in rows:
        assert e.force_half < 0.02 * e.force
        assert e.line_is_enough == (e.length / ROBOT.R[0] < NOISE)
        assert not e.massless_is_enough


def test_the_weight_moves_the_handle_as_a_load_does():
    rho = 1e-5  # so light that the answer is linear
    (e,) = line_errors(ROBOT, ROBOT.start, (rho,), (4.0,))
    at = inverse(ROBOT.start, ROBOT.geometry)
    half = -rho * GRAVITY * at.lengths / 2
    load = np.zeros(6)
    for k in range(8):
        F = np.array([0, 0, half[k]])
        load += np.r_[F, np.cross(at.arms[k], F)]
    rest = equilibrium(ROBOT, load=load)
    assert e.moved == pytest.approx(np.linalg.norm(rest.pose[:3] - ROBOT.start[:3]), rel=1e-3)
    assert e.moved_angle == pytest.approx(np.abs(rest.angle).max(), rel=1e-2)
