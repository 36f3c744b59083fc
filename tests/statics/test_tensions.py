"""Tension distribution: null space, conditions of optimality, lockstep with a general solver."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import null_space
from scipy.optimize import LinearConstraint, linprog, minimize

from identification.errors import InputError
from inca_mj.kinematics.jacobians import length_jacobian
from inca_mj.kinematics.rotations import rotation
from inca_mj.robot.geometry import INCA
from inca_mj.statics.tensions import distribute, nearest

coordinate = st.floats(-0.7, 0.7)
small_angle = st.floats(-0.2, 0.2)
poses = st.tuples(coordinate, coordinate, st.floats(0.9, 2.2), small_angle, small_angle,
                  small_angle).map(np.array)  # fmt: skip
forces = st.tuples(*[st.floats(-6, 6)] * 3, *[st.floats(-0.2, 0.2)] * 3).map(np.array)


def wrench_matrix(pose):
    return -length_jacobian(pose[:3], rotation(*pose[3:]), INCA).T


def possible(W, w, low, high):
    """Whether a linear program finds tensions within the limits."""
    return linprog(np.zeros(8), A_eq=W, b_eq=w, bounds=[(low, high)] * 8, method="highs").success


@given(poses, forces, st.floats(0, 20))
@settings(max_examples=50, deadline=None)
def test_closed_form_balances_and_leaves_t_0_along_the_row_space_only(pose, w, t_0):
    W = wrench_matrix(pose)
    T, N = nearest(W, w, t_0), null_space(W)
    assert N.shape == (8, 2)
    np.testing.assert_allclose(W @ T, w, atol=1e-9)
    np.testing.assert_allclose(N.T @ (T - t_0), 0, atol=1e-8 * max(1, np.abs(T).max()))


@given(poses, forces)
@settings(max_examples=50, deadline=None)
def test_minimum_norm_is_the_pseudo_inverse(pose, w):
    W = wrench_matrix(pose)
    np.testing.assert_allclose(nearest(W, w, 0.0), np.linalg.pinv(W) @ w, atol=1e-8)


@given(poses, forces, st.floats(0.2, 3), st.floats(4, 25), st.floats(0, 20))
@settings(max_examples=80, deadline=None)
def test_limits_hold_and_the_conditions_of_optimality_too(pose, w, low, high, t_0):
    """KKT: along null-space directions, T − t₀ is balanced by multipliers of active limits ≥ 0."""
    W = wrench_matrix(pose)
    try:
        T = distribute(W, w, low, high, t_0)
    except InputError:
        assert not possible(W, w, low + 1e-6, high - 1e-6)
        return
    assert possible(W, w, low - 1e-6, high + 1e-6)
    scale = max(1.0, np.abs(T).max())
    np.testing.assert_allclose(W @ T, w, atol=1e-7 * scale)
    assert low <= T.min()
    assert T.max() <= high
    N = null_space(W)
    at_low, at_high = T - low < 1e-7 * scale, high - T < 1e-7 * scale
    # Nᵀ (T − t₀) = N_lowᵀ μ − N_highᵀ ν with μ, ν ≥ 0: a linear program says whether they exist.
    rows = np.hstack([N[at_low].T, -N[at_high].T])
    gradient = N.T @ (T - t_0)
    if rows.shape[1] == 0:
        np.testing.assert_allclose(gradient, 0, atol=1e-6 * scale)
        return
    left = linprog(np.r_[np.zeros(rows.shape[1]), np.ones(4)],
                   A_eq=np.hstack([rows, np.eye(2), -np.eye(2)]), b_eq=gradient)  # fmt: skip
    assert left.fun < 1e-6 * scale


def test_a_general_solver_finds_the_same():
    rng = np.random.default_rng(0)
    compared = 0
    for _ in range(30):
        pose = np.r_[rng.uniform(-0.5, 0.5, 2), rng.uniform(1, 2), rng.uniform(-0.2, 0.2, 3)]
        W, w = wrench_matrix(pose), np.r_[rng.normal(0, 3, 3), rng.normal(0, 0.05, 3)]
        if not possible(W, w, 1.01, 11.99):
            continue
        T = distribute(W, w, 1.0, 12.0, 4.0)
        slow = minimize(lambda T: ((T - 4.0) ** 2).sum(), T, jac=lambda T: 2 * (T - 4.0),
                        method="SLSQP", bounds=[(1.0, 12.0)] * 8,
                        constraints=LinearConstraint(W, w, w),
                        options={"ftol": 1e-14, "maxiter": 500})  # fmt: skip
        assert ((T - 4.0) ** 2).sum() <= slow.fun + 1e-8
        np.testing.assert_allclose(T, slow.x, atol=1e-4)
        compared += 1
    assert compared >= 10


def test_each_cable_has_its_own_limits():
    W, w = wrench_matrix(np.array([0, 0, 1.43, 0, 0, 0])), np.array([0, 0, 1.7, 0, 0, 0])
    low = np.array([6.0, 0, 0, 0, 0, 0, 0, 0])
    T = distribute(W, w, low, 30.0)
    assert T[0] == 6.0  # t₀ = 4 N, so its limit is active
    np.testing.assert_allclose(W @ T, w, atol=1e-9)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"low": 5.0, "high": 4.0}, "none above its upper limit"),
        ({"high": 0.1, "low": 0.0}, "no tensions between 0 and 0.1 N"),
        ({"W": np.zeros((6, 8))}, "rank 0 of 6"),
    ],
)
def test_refusals(change, sentence):
    usual = {"W": wrench_matrix(np.array([0, 0, 1.43, 0, 0, 0])), "low": 1.0, "high": 20.0,
             "w": np.array([0, 0, 1.7, 0, 0, 0])}  # fmt: skip
    with pytest.raises(InputError, match=sentence):
        distribute(**{**usual, **change})
