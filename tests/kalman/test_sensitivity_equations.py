"""The sensitivity equations against simulations with each parameter moved."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from effect_cases import full
from estimation_plants import SLIDER_PARAMETERS, slider
from plain_logs import plain_log

from identification import Parameter, ParameterSet, Predictor
from identification.discovery.candidates import list_common
from identification.effects.effect import Candidate
from identification.innovations.scoring.sensitivities import compute_beside, compute_sensitivities
from identification.kalman.linear import linearise_records, state_derivatives
from identification.kalman.point import do_equations_hold, evaluate_point
from identification.kalman.sensitivity_equations import can_solve, solve_sensitivities
from identification.kalman.trajectory import COARSE_POINTS, FINE_POINTS, follow
from identification.logs.joined import join_logs
from identification.model.coordinates import coordinates
from identification.model.parameter import with_own
from identification.model.plant import ModelPlant
from inca_mj.effects.catalogue import CATALOGUE
from inca_mj.robot.inputs import make_input
from inca_mj.twin.logs import ANGLES, CURRENTS

H = 0.02


def solve(predictor, values, moves, points=COARSE_POINTS):
    records = linearise_records(predictor, values, points=points)
    assert can_solve(predictor, records)
    return solve_sensitivities(
        predictor, records, values, values + np.diag(moves), np.asarray(moves)
    )


def simulate(predictor, values, moves):
    """Central differences, shape (N, ny, p)."""
    each = [predictor.predict(values + sign * np.diag(moves)) for sign in (1, -1)]
    return np.moveaxis((each[0] - each[1]) / (2 * np.asarray(moves)[:, None, None]), 0, -1)


def miss(S, expected):
    """Share of each column that is missed, shape (p,)."""
    return np.linalg.norm(S - expected, axis=(0, 1)) / np.linalg.norm(expected, axis=(0, 1))


def slider_log(n, seed, hold="zoh", h=H):
    u = np.random.default_rng(seed).standard_normal((n, 1))
    return plain_log(u, np.zeros((n, 2)), "force", "position rate", h, name=f"{seed}", hold=hold)


@pytest.mark.parametrize("hold", ["zoh", "foh"])
def test_of_a_slider_they_are_those_of_the_simulation(hold):
    names = ("mass", "damping", "x0", "v0")
    predictor = Predictor(slider(), slider_log(80, 0, hold), names)
    values = np.array([slider().parameters[n].value for n in names])
    moves = np.full(len(names), 1e-5)
    S = solve(predictor, values, moves)
    assert miss(S, simulate(predictor, values, moves)).max() < 2e-3


def test_the_error_falls_with_the_square_of_the_interval():
    """The midpoint rule: a friction that turns with the position varies within an interval."""
    model = """<mujoco><option timestep="0.0005" integrator="RK4"/><worldbody>
      <body name="bob"><joint name="swing" axis="0 1 0" damping="0.05"/>
        <inertial pos="0 0 -0.5" mass="0.5" diaginertia="0.01 0.01 0.01"/></body></worldbody>
      <actuator><motor name="torque" joint="swing"/></actuator>
      <sensor><jointpos name="angle" joint="swing"/></sensor></mujoco>"""
    mass = Parameter(name="mass", value=0.5, unit="kg", where="body/bob.mass", lower=0)
    plant = ModelPlant(mujoco.MjModel.from_xml_string(model), ParameterSet("pendulum", (mass,)))
    missed = []
    for h in (0.04, 0.02, 0.01):
        t = h * np.arange(round(4 / h))
        u = np.sin(3 * t)[:, None]
        log = plain_log(u, np.zeros_like(u), "torque", "angle", time=t, hold="foh")
        predictor, at, move = Predictor(plant, log, ("mass",)), np.array([0.5]), [1e-5]
        missed.append(miss(solve(predictor, at, move), simulate(predictor, at, move))[0])
    rates = np.log2(np.array(missed[:-1]) / missed[1:])
    assert np.all(rates > 1.6), missed


def test_records_have_columns_of_their_own():
    plant = replace(slider(), parameters=with_own(SLIDER_PARAMETERS, ("x0",), 2))
    names = ("mass", "x0", "x0 [2]")
    both = Predictor(plant, join_logs([slider_log(60, 1), slider_log(45, 2)]), names)
    values, moves = np.array([2.0, 0.1, -0.2]), np.full(3, 1e-5)
    S = solve(both, values, moves)
    assert miss(S, simulate(both, values, moves)).max() < 2e-3
    assert not S[:60, :, 2].any()
    assert not S[60:, :, 1].any()


def test_where_a_joint_hits_its_limit_they_are_not_believed():
    """A stop acts for less time than lies between two points."""
    model = mujoco.MjModel.from_xml_string(
        """<mujoco><option timestep="0.002"/><worldbody><body name="b">
        <joint name="j" type="slide" axis="1 0 0" limited="true" range="-0.05 0.05"
          solreflimit="-100000 -1"/>
        <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body></worldbody>
        <actuator><motor name="force" joint="j"/></actuator>
        <sensor><jointpos name="position" joint="j"/></sensor></mujoco>"""
    )
    mass = Parameter(name="mass", value=1.0, unit="kg", where="body/b.mass", lower=0)
    plant = ModelPlant(model, ParameterSet("stopped", (mass,)))
    log = slider_log(200, 3)
    log = plain_log(log.inputs, log.outputs[:, :1], "force", "position", time=log.time)
    predictor = Predictor(plant, log, ("mass",))
    space = coordinates(plant.parameters, ("mass",), np.array([1.0]))
    point = evaluate_point(predictor, space, space.encode(np.array([1.0])))
    records = linearise_records(predictor, space.decode(point.q))
    assert not do_equations_hold(predictor, space, point.q, records, point.J)
    moved = predictor.predict(np.array([[1.0], [np.exp(1e-4)]]))
    np.testing.assert_allclose(point.J[..., 0], (moved[1] - moved[0]) / 1e-4, atol=1e-9)


def inca_log(seconds=2.0):
    u = make_input("prbs", seconds)
    return plain_log(u, np.zeros_like(u), CURRENTS, ANGLES)


NAMES = ("R", "k_s", "lambda", "J", "b_v", "b_c", "K_t", "m", "x", "pitch")


@pytest.fixture(scope="module")
def robot():
    """A point of the cable robot with all its candidate effects absent."""
    plant = full()
    first = np.array([plant.parameters[name].value for name in NAMES])
    space = coordinates(plant.parameters, NAMES, first)
    return evaluate_point(Predictor(plant, inca_log(), NAMES), space, space.encode(first))


def test_of_the_cable_robot_they_are_those_of_the_simulation(robot):
    predictor, space = robot.predictor, robot.space
    records = linearise_records(predictor, space.decode(robot.q), points=FINE_POINTS)
    assert do_equations_hold(predictor, space, robot.q, records, robot.J)
    h = 1e-4 * np.eye(len(NAMES))
    ahead, behind = (predictor.predict(space.decode(robot.q + s * h)) for s in (1, -1))
    expected = np.moveaxis((ahead - behind) / 2e-4, 0, -1)
    missed = dict(zip(NAMES, miss(robot.J, expected), strict=True))
    # The stiffness of the cables acts through oscillations of 100 Hz, which a sample cannot follow.
    assert missed.pop("lambda") < 0.3
    assert max(missed.values()) < 0.02


def test_the_derivatives_are_those_of_mujoco(robot):
    along = follow(robot.predictor, robot.space.decode(robot.q), FINE_POINTS).some(4)
    along = replace(along, steps=np.arange(5), begins=np.arange(4))
    F = state_derivatives(along)[0]
    model = along.model
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_EULER
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_EULERDAMP
    model.opt.timestep = h = 1e-6
    data, nx, moved = mujoco.MjData(model), F.shape[1], 2 * model.nv
    for k in range(4):
        data.time, data.qpos, data.qvel = along.time[k], along.qpos[k], along.qvel[k]
        data.act, data.ctrl = along.act[k], along.inputs[k]
        A = np.zeros((nx, nx))
        mujoco.mjd_transitionFD(model, data, 1e-6, 1, A, None, None, None)
        expected = (A - np.eye(nx)) / h
        # MuJoCo moves positions with the new velocities: these rows err by h times the others.
        expected[: model.nv] -= h * expected[model.nv : moved]
        scale = np.abs(expected).max(axis=1, keepdims=True) + 1
        missed = np.abs((F[k] - expected) / scale)[:, :moved]
        assert missed.max() < 2e-3


USUAL = full().parameters["cable_creep.tau"].value


def test_candidates_are_those_of_simulations(robot, monkeypatch):
    """Those that change the course of a state which they alone read are simulated, to the bit."""
    names = {"cogging", "anchor_offset", "encoder_lag", "current_lag", "cable_creep",
             "drum_spring_drift", "torque_constant_drift", "load_dependent_friction"}  # fmt: skip
    candidates = [c for c in list_common([e for e in CATALOGUE if e.name in names])
                  if c.probe == 1 and c.shape.get("n", 6) == 6]  # fmt: skip
    solved = compute_sensitivities(robot, candidates)
    monkeypatch.setattr(f"{compute_sensitivities.__module__}.do_equations_hold", lambda *at: False)
    expected = compute_sensitivities(robot, candidates)
    assert {s.candidate.effect.name for s in solved} == names
    for one, other in zip(solved, expected, strict=True):
        assert one.candidate is other.candidate
        if one.candidate.effect.name == "cable_creep" and one.candidate.shape["tau"] != USUAL:
            np.testing.assert_array_equal(one.S, other.S)
        else:
            assert miss(one.S, other.S).max() < 0.1, one.candidate


def test_of_another_kind_they_go_along_the_trajectory_with_the_effect():
    """Under ±0.3 A a motor's heat is 0.09 of the time, and so is what a drift with heat does."""
    plant, u = full(), np.where(np.random.default_rng(5).integers(0, 2, (100, 8)), 0.3, -0.3)
    log = plain_log(u, np.zeros_like(u), CURRENTS, ANGLES)
    names, first = ("b_c", "torque_constant_drift.alpha"), np.array([0.02, 0.03])
    space = coordinates(plant.parameters, names, first, linear=names[1:])
    predictor = Predictor(plant, log, names, {"torque_constant_drift.kind": 0.0})
    point = evaluate_point(predictor, space, space.encode(first))
    (drift,) = (e for e in CATALOGUE if e.name == "torque_constant_drift")
    kinds = [Candidate(drift, "all drives", {"kind": kind}) for kind in (0.0, 1.0)]
    aged, heated = compute_beside(point, kinds)
    assert miss(aged.S, point.J[..., 1:] / space.slope(point.q)[1:]).max() < 0.05
    np.testing.assert_allclose(heated.S, 0.09 * aged.S, rtol=0, atol=1e-6 * np.abs(aged.S).max())
