"""Tension distribution: null space, conditions of optimality, limits of each cable."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import null_space
from scipy.optimize import linprog
from statics_cases import ROBOT, poses, possible

from identification.errors import InputError
from inca_mj.kinematics.cables import inverse
from inca_mj.robot.geometry import INCA
from inca_mj.statics.tensions import distribute, nearest

W_START = inverse(ROBOT.start, INCA).W

forces = st.tuples(*[st.floats(-6, 6)] * 3, *[st.floats(-0.2, 0.2)] * 3).map(np.array)


@given(poses, forces, st.floats(0, 20))
@settings(max_examples=50, deadline=None)
def test_closed_form_balances_and_leaves_t_0_along_the_row_space_only(pose, w, t_0):
    W = inverse(pose, INCA).W
    T, N = nearest(W, w, t_0), null_space(W)
    assert N.shape == (8, 2)
    np.testing.assert_allclose(W @ T, w, atol=1e-9)
    np.testing.assert_allclose(N.T @ (T - t_0), 0, atol=1e-8 * max(1, np.abs(T).max()))


@given(poses, forces, st.floats(0.2, 3), st.floats(4, 25), st.floats(0, 20))
@settings(max_examples=80, deadline=None)
def test_limits_hold_and_the_conditions_of_optimality_too(pose, w, low, high, t_0):
    """KKT: along null-space directions, T − t₀ is balanced by multipliers of active limits ≥ 0."""
    W = inverse(pose, INCA).W
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


def test_each_cable_has_its_own_limits():
    W, w = W_START, np.array([0, 0, 1.7, 0, 0, 0])
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
    usual = {"W": W_START, "low": 1.0, "high": 20.0,
             "w": np.array([0, 0, 1.7, 0, 0, 0])}  # fmt: skip
    with pytest.raises(InputError, match=sentence):
        distribute(**{**usual, **change})
