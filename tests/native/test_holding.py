"""Friction of joints that pull at each other: the complementarity problem and its solution."""

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from joint_cases import run
from numba import njit
from plain_logs import plain_log
from scipy.optimize import lsq_linear

from identification import joint_plant
from identification.native.joints.holding import hold, invert

SEEDS = st.integers(0, 10**6)


@njit
def held(M, g, low, high, r=None, p=None):
    """Friction that holds joints; r: share of it that its spring p carries, zero where None."""
    n = g.size
    A, f = np.empty((n, n)), np.zeros(n)
    share, spring = np.zeros(n), np.zeros(n)
    if r is not None:
        share[:] = r
    if p is not None:
        spring[:] = p
    invert(M.copy(), A, n)
    hold(A, A @ g, low, high, f, n, share, spring)
    return f


def drawn(seed, n):
    rng = np.random.default_rng(seed)
    L = rng.normal(size=(n, n)) + (1 + n) * np.eye(n)
    g = rng.normal(size=n) * 10 ** rng.uniform(-2, 2)
    return L @ L.T, g, *(np.abs(rng.normal(size=(2, n))) * rng.integers(0, 2, (2, n)))


@given(SEEDS, st.integers(1, 8))
@settings(max_examples=100, deadline=None)
def test_friction_solves_the_complementarity_problem(seed, n):
    M, g, low, high = drawn(seed, n)
    f = held(M, g, low, high)
    w = np.linalg.solve(M, g - f)
    near = 1e-7 * (1 + np.abs(g).max())
    assert np.all((-low - near <= f) & (f <= high + near))
    scale = near * np.linalg.norm(np.linalg.inv(M), 2)
    assert np.all(w[f > -low + near] > -scale)  # backward only against all that low gives
    assert np.all(w[f < high - near] < scale)


@given(SEEDS, st.integers(1, 6))
@settings(max_examples=50, deadline=None)
def test_friction_is_a_bounded_least_squares_problem(seed, n):
    M, g, low, high = drawn(seed, n)
    L = np.linalg.inv(np.linalg.cholesky(M))
    some, slow = low + high > 0, np.zeros(n)
    if some.any():
        bounds = (-low[some], high[some])
        slow[some] = lsq_linear(L[:, some], L @ g, bounds, method="bvls", tol=1e-15).x
    np.testing.assert_allclose(held(M, g, low, high), slow, atol=1e-6 * (1 + np.abs(g).max()))


@given(SEEDS, st.integers(1, 6))
@settings(max_examples=30, deadline=None)
def test_friction_that_gives_pulls_back_to_its_springs(seed, n):
    """w = r/(1 - r) A_ii (f - p) where it does not slip, and full friction where it does."""
    M, g, low, high = drawn(seed, n)
    rng = np.random.default_rng(seed + 1)
    r, p = rng.uniform(0.01, 0.99, n), rng.uniform(-low, high)
    f = held(M, g, low, high, r, p)
    A = np.linalg.inv(M)
    w = A @ (g - f) - r / (1 - r) * np.diag(A) * (f - p)
    near = 1e-7 * (1 + np.abs(g).max())
    scale = near * np.linalg.norm(A, 2) * (1 + np.max(r / (1 - r)))
    assert np.all((-low - near <= f) & (f <= high + near))
    assert np.all(w[f > -low + near] > -scale)
    assert np.all(w[f < high - near] < scale)
    np.testing.assert_array_equal(held(M, g, low, high, 0 * r, p), held(M, g, low, high))
    np.testing.assert_array_equal(
        held(M, g, low, high, 0 * r + 1, p), np.where(low + high > 0, p, 0)
    )


TWO = """<mujoco><option timestep="0.002" integrator="RK4"/><worldbody>
  <body><joint name="a" axis="0 1 0"/><inertial pos="0 0 -0.3" mass="1" diaginertia=".03 .03 .001"/>
    <body pos="0 0 -0.5"><joint name="b" axis="0 1 0"/>
      <inertial pos="0 0 -0.3" mass="1" diaginertia=".03 .03 .001"/></body></body></worldbody>
  <actuator><motor name="u" joint="a"/><motor name="w" joint="b"/></actuator>
  <sensor><jointpos name="qa" joint="a"/><jointpos name="qb" joint="b"/></sensor></mujoco>"""


@pytest.mark.parametrize("level", [8.0, 12.0])
def test_a_joint_that_friction_holds_does_not_creep_while_another_one_moves(level):
    t = 0.01 * np.arange(200)
    u = np.column_stack([8 * np.sin(6 * t), 0 * t])
    log = plain_log(u, np.sin(6 * t)[:, None] * [0.5, 0.1], "u w", "qa qb", time=t)
    plant = joint_plant(TWO, (), log)
    y = run(plant, log, **{"coulomb_friction.f_c@b": level})
    assert np.ptp(y[:, 0]) > 0.3
    free = run(plant, log)
    assert np.ptp(free[:, 1]) > 0.1
    assert np.ptp(y[:, 1]) < 1e-9
    stiff = mujoco.MjSpec.from_string(TWO)
    stiff.joint("b").armature = 1e6  # a joint that is held is a joint that is not there
    np.testing.assert_allclose(y, run(joint_plant(stiff.to_xml(), (), log), log), atol=2e-5)
