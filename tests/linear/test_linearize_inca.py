"""The linearised robot against the thesis' equations, the nonlinear twin, and itself."""

from functools import cache

import numpy as np
import pytest
from plain_logs import plain_log

from identification.linear.modes import minimal, modes
from identification.model.rollout import State
from inca_mj.linear.accuracy import interpolation_errors, run_error
from inca_mj.linear.linearization import held_at, linearize, linearize_along, linearize_grid
from inca_mj.linear.thesis_states import STATES
from inca_mj.reference import derivative, pack
from inca_mj.reference import layout as at
from inca_mj.robot.inputs import make_input, prbs
from inca_mj.robot.parameters import parameter_set
from inca_mj.robot.spread import with_spread
from inca_mj.twin.logs import ANGLES, CURRENTS
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import build_twin

H = 1e-6
POSES = {
    "start": [0, 0, 1.43, 0, 0, 0],
    "aside": [0.3, -0.2, 1.2, 0.1, -0.2, 0.3],
    "turned": [-0.1, 0.25, 1.6, -0.3, 0.25, -0.4],
}
F = np.geomspace(0.01, 200, 40)


@cache
def twin():
    return build_twin(visual=False)


def prbs_log(seconds, seed=0):
    u = make_input("prbs", seconds, seed=seed)
    return plain_log(u, np.zeros_like(u), CURRENTS, ANGLES)


def of_the_reference(x, i, q):
    """Central differences of the thesis' equations, (36, 36) and (36, 8)."""
    steps = H * np.eye(at.STATES)
    A = [(derivative(x + s, i, q) - derivative(x - s, i, q)) / (2 * H) for s in steps]
    more = 1e-2 * np.eye(8)  # the currents enter linearly
    B = [(derivative(x, i + s, q) - derivative(x, i - s, q)) / 2e-2 for s in more]
    return np.array(A).T, np.array(B).T


def assert_equal(model, robot):
    """Each entry to 1e-6 of itself, and to the rounding of the largest one of its row."""
    q = pack(robot.parameters, robot.geometry)
    s = model.system
    A, B = of_the_reference(s.x, s.u, q)
    for ours, theirs in ((s.A, A), (s.B, B)):
        size = np.abs(theirs).max(axis=1, keepdims=True)
        assert (np.abs(ours - theirs) <= 1e-6 * np.abs(theirs) + 1e-9 * size + 1e-9).all()
    rate = derivative(s.x, s.u, q)
    np.testing.assert_allclose(s.rate, rate, rtol=1e-9, atol=1e-6)


@pytest.mark.parametrize("pose", POSES.values(), ids=POSES)
def test_at_a_pose_it_is_the_derivative_of_the_thesis_equations(pose):
    model = linearize(twin(), pose)
    s = model.system
    assert s.states == STATES
    assert_equal(model, twin())
    at_rest = derivative(s.x, s.u, pack(twin().parameters, twin().geometry))
    np.testing.assert_allclose(at_rest, 0, atol=1e-6)


def test_so_it_is_for_a_robot_whose_drives_and_points_differ():
    spread = with_spread(parameter_set())
    rng = np.random.default_rng(0)
    small = {p.name: 0.05 * rng.uniform(-1, 1) for p in spread if p.where == "drive"}
    robot = build_twin(spread.with_values(small), visual=False)
    assert small
    assert_equal(linearize(robot, POSES["aside"]), robot)


def test_along_a_log_it_is_too_where_the_robot_moves_and_turns():
    models = linearize_along(twin(), prbs_log(1.0), [0.2, 0.55, 1.0])
    assert [m.time for m in models] == [0.2, 0.55, 1.0]
    assert all(np.abs(m.system.x[at.RATES]).max() > 1e-2 for m in models)
    for model in models:
        assert_equal(model, twin())


def test_the_friction_has_the_slope_that_is_told():
    """∂ω̇_m/∂ω_m = -(slope + R² b d₀/d)/J, of which the second part is the cable's damping."""
    for model in (linearize(twin()), *linearize_along(twin(), prbs_log(0.5), [0.4])):
        p, x = twin().parameters.values(), model.system.x
        cable = p["R"] ** 2 * p["b"] * x[at.NO_LOAD] / model.lengths.y
        slope = -np.diag(model.system.A[at.SPEEDS, at.SPEEDS]) * p["J"] - cable
        np.testing.assert_allclose(model.friction_slope, slope, rtol=1e-6)
    p = twin().parameters.values()
    at_rest = linearize(twin()).friction_slope
    np.testing.assert_allclose(at_rest, p["b_v"] + p["b_c"] * p["beta"], rtol=1e-12)


@pytest.mark.parametrize("pose", POSES.values(), ids=POSES)
def test_eight_states_are_not_reached_and_the_rest_has_the_same_transfer_function(pose):
    """At rest R d₀ δφ + d δd₀ cannot change, of each drive: 28 states are left."""
    s = linearize(twin(), pose).system
    small = minimal(s)
    assert (len(small.system.A), small.unreached, small.unfelt) == (28, 8, 0)
    G = s.response(F)
    error = np.linalg.norm(G - small.system.response(F), axis=(1, 2))
    assert (error < 1e-6 * np.linalg.norm(G, axis=(1, 2))).all()
    assert sum(m.eigenvalue == 0 for m in modes(s)) == 8


def test_tensions_are_other_coordinates_of_the_same_system():
    model = linearize(twin(), POSES["aside"])
    other = model.with_tensions
    np.testing.assert_allclose(other.x[at.NO_LOAD], model.tension, rtol=1e-9)
    G = model.system.response(F)
    error = np.linalg.norm(G - other.response(F), axis=(1, 2))
    assert (error < 1e-8 * np.linalg.norm(G, axis=(1, 2))).all()
    assert np.abs(other.A).max() < 0.1 * np.abs(model.system.A).max()


def test_the_twin_answers_a_small_input_as_the_model_says():
    """The relative error falls with the square of the input: at rest friction is odd."""
    held, s = held_at(twin(), [POSES["aside"]]), linearize(twin(), POSES["aside"]).system
    errors = []
    for size in (4e-3, 2e-3):
        u = s.u + prbs(101, 0.01, seed=1, low=-size, high=size)
        run = simulate(twin(), u, 0.01, start=State(held.qpos, held.qvel, held.act))
        moved = run.motor_angle - run.motor_angle[0]
        _, y = s.discrete(100).simulate(u)
        errors.append(np.linalg.norm(y - run.motor_angle) / np.linalg.norm(moved))
    assert errors[0] < 0.01
    assert errors[1] < 0.6 * errors[0]


def grid(robot, n, method="linear"):
    return linearize_grid(robot, {"x": np.linspace(-0.3, 0.3, n), "z": np.linspace(1.1, 1.7, n)},
                          method)  # fmt: skip


def test_a_grid_is_the_twins_own_linearisation_on_its_points():
    g = grid(twin(), 3)
    for x in g.axes["x"]:
        for z in g.axes["z"]:
            own = linearize(twin(), [x, 0, z, 0, 0, 0]).with_tensions
            other = g.at({"x": x, "z": z})
            for name in ("A", "B", "C", "x", "u", "y"):
                one, two = getattr(other, name), getattr(own, name)
                np.testing.assert_allclose(one, two, atol=1e-9 * np.abs(two).max())


@pytest.mark.parametrize(("method", "order"), [("linear", 2), ("cubic", 3)])
def test_between_them_the_error_falls_with_the_spacing(method, order):
    errors = [
        np.sqrt(np.mean([e.matrix**2 for e in interpolation_errors(twin(), g, 8)]))
        for g in (grid(twin(), 5, method), grid(twin(), 9, method))
    ]
    assert np.log2(errors[0] / errors[1]) > order - 0.4


def test_without_coulomb_friction_the_scheduled_model_follows_where_the_fixed_one_does_not():
    robot = twin().with_values({"b_c": 0.0})
    axes = {n: np.linspace(*span, 4) for n, span in
            {"x": (-0.2, 0.3), "y": (-0.2, 0.3), "z": (1.2, 1.6)}.items()}  # fmt: skip
    g = linearize_grid(robot, axes)
    point = {"x": 0.1, "y": 0.05, "z": 1.35}
    error = run_error(robot, g, point, amplitude=0.1, duration=2.5)
    assert error.travel > 0.03
    assert error.scheduled < error.fixed < 0.1
