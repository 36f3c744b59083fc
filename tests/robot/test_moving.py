"""Forces of moving bodies are those of recursive Newton-Euler, body by body."""

import copy

import mujoco
import numpy as np
import pytest
import scipy.optimize

from identification.refusals.balance import solve_bounded
from identification.refusals.forces import inertial_force, point_force, weights
from identification.torques.equations.bodies import follow_bodies

ARM = """
<mujoco>
  <worldbody>
    <body name="a" pos="0 0 0.2" euler="10 20 30">
      <joint name="turn" axis="0.2 0.1 1"/>
      <inertial pos="0.1 0.02 0.3" mass="2" fullinertia="0.03 0.02 0.04 0.001 0.002 0.003"/>
      <body name="b" pos="0.3 0 0.1" euler="40 0 10">
        <joint name="slip" type="slide" axis="1 0.3 0"/>
        <inertial pos="0 0.1 0.05" mass="1" fullinertia="0.01 0.02 0.015 0.001 0 0.002"/>
        <body name="c" pos="0 0.2 0">
          <joint name="bend" axis="0 1 0.4" pos="0 0.01 0"/>
          <inertial pos="0.05 0 0.1" mass="0.5" diaginertia="0.004 0.003 0.002"/>
        </body>
      </body>
    </body>
  </worldbody>
</mujoco>
"""
MODEL = mujoco.MjModel.from_xml_string(ARM)
POINT = np.array([0.1, -0.2, 0.05])


def motion(seed):
    rng = np.random.default_rng(seed)
    return [rng.normal(0, size, (4, MODEL.nv)) for size in (1, 2, 5)]


def newton_euler(model, q, v, a):
    """Forces without gravity of a model whose other bodies weigh nothing."""
    data, force = mujoco.MjData(model), np.empty(v.shape)
    for k in range(len(q)):
        data.qpos, data.qvel, data.qacc = q[k], v[k], a[k]
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        mujoco.mj_rne(model, data, 1, force[k])
    return force


def alone(body, mass, inertia, ipos):
    model = copy.copy(MODEL)
    model.body_mass[:], model.body_inertia[:], model.opt.gravity[:] = 0, 0, 0
    model.body_mass[body], model.body_inertia[body], model.body_ipos[body] = mass, inertia, ipos
    return model


@pytest.mark.parametrize("body", [1, 2, 3])
def test_a_body_by_itself_and_a_point_of_it(body):
    q, v, a = motion(body)
    found = follow_bodies(MODEL, q, v, a, [1, 2, 3])[body]
    mass, inertia, ipos = (x[body] for x in (MODEL.body_mass, MODEL.body_inertia, MODEL.body_ipos))
    exact = newton_euler(alone(body, mass, inertia, ipos), q, v, a)
    np.testing.assert_allclose(inertial_force(found, mass, inertia), exact, atol=1e-10)
    exact = newton_euler(alone(body, 1.0, 0.0, ipos + POINT), q, v, a)
    np.testing.assert_allclose(point_force(found, POINT), exact, atol=1e-10)


@pytest.mark.parametrize("body", [1, 2, 3])
def test_a_weight_is_the_jacobian_of_its_point(body):
    q, v, a = motion(body)
    found = np.stack(weights(follow_bodies(MODEL, q, v, a, [body])[body], POINT), axis=1)
    data = mujoco.MjData(MODEL)
    for k in range(len(q)):
        data.qpos = q[k]
        mujoco.mj_forward(MODEL, data)
        at, J = data.xipos[body] + data.ximat[body].reshape(3, 3) @ POINT, np.zeros((3, MODEL.nv))
        mujoco.mj_jac(MODEL, data, J, None, at, body)
        np.testing.assert_allclose(found[k], J, atol=1e-12)


def test_all_bodies_together_are_the_robot():
    q, v, a = motion(7)
    bodies = follow_bodies(MODEL, q, v, a, [1, 2, 3])
    every = sum(
        inertial_force(body, MODEL.body_mass[b], MODEL.body_inertia[b])
        for b, body in bodies.items()
    )
    whole = copy.copy(MODEL)
    whole.opt.gravity[:] = 0
    np.testing.assert_allclose(every, newton_euler(whole, q, v, a), atol=1e-10)


SAME = 1e-6  # of what is left, to which the solver of bounds goes on


def problem(seed, free, bounded, rows=60, dependent=0):
    """Some columns of a problem are sums of its others, as the weights of bodies in a row are."""
    rng = np.random.default_rng(seed)
    A = rng.standard_normal((rows, free + bounded))
    for k in range(dependent):
        A[:, k] = A[:, dependent:free].sum(axis=1) * (1 + k)
    low = np.concatenate([np.full(free, -np.inf), rng.uniform(-0.2, 0.0, bounded)])
    high = np.concatenate([np.full(free, np.inf), rng.uniform(0.0, 0.2, bounded)])
    high[-1:] = np.inf  # a bound on one side only, where there is any
    return A, A @ rng.standard_normal(free + bounded) + rng.standard_normal(rows), low, high


@pytest.mark.parametrize(
    ("free", "bounded", "rows", "dependent"),
    [(8, 5, 60, 0), (8, 5, 60, 3), (30, 6, 20, 0), (0, 5, 60, 0), (40, 30, 60, 10)],
)
@pytest.mark.parametrize("seed", range(3))
def test_no_step_within_the_bounds_leaves_less(seed, free, bounded, rows, dependent):
    """Compared with a solver that goes from bound to bound until none can be left or reached."""
    A, b, low, high = problem(seed, free, bounded, rows, dependent)
    x = solve_bounded(A, b, low, high)
    assert (low <= x).all()
    assert (x <= high).all()
    exact = scipy.optimize.lsq_linear(A, b, (low, high), method="bvls", max_iter=1000).x
    assert np.linalg.norm(A @ x - b) <= np.linalg.norm(A @ exact - b) * (1 + SAME)


@pytest.mark.parametrize(("bounded", "scatter"), [(60, 1e-12), (80, 1e-12)])
def test_columns_that_are_nearly_sums_of_others_are_solved(bounded, scatter):
    """Without their bounds some unknowns would be huge, and a solver begins there."""
    rng = np.random.default_rng(bounded)
    few = rng.standard_normal((300, 6)) @ rng.standard_normal((6, bounded))
    A = few + scatter * rng.standard_normal(few.shape)
    A /= np.linalg.norm(A, axis=0)
    low, high = np.full(bounded, 0.5), np.where(np.arange(bounded) % 2, 8.0, np.inf)
    b = A @ rng.uniform(1.0, 2.0, bounded) + rng.standard_normal(300)
    x = solve_bounded(A, b, low, high)
    least = scipy.optimize.lsq_linear(few / np.linalg.norm(few, axis=0), b).cost
    assert np.sum((A @ x - b) ** 2) / 2 < 1.001 * least
