"""The start: at rest exactly, nearest to the wanted pretension, or refused by name."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from identification.errors import InputError
from inca_mj.kinematics import inverse
from inca_mj.reference import derivative, pack, rest
from inca_mj.robot.geometry import INCA
from inca_mj.robot.parameters import SETS, parameter_set


def imbalance(p):
    """The largest rate at rest, where 1 is what a force of λ (a cable's E S) would cause."""
    value = p.values()
    rate = derivative(rest(p, INCA).state, np.zeros(8), pack(p, INCA))
    λ = value["lambda"]
    scale = np.ones(36)
    scale[3:6], scale[9:12] = λ / value["m"], λ * 0.075 / value["I_x"]
    scale[20:28] = λ * value["R"] / value["J"]
    return np.abs(rate / scale).max()


@pytest.mark.parametrize("name", SETS)
def test_the_start_is_an_exact_equilibrium(name):
    assert imbalance(parameter_set(name)) < 1e-14


offset = st.floats(-0.1, 0.1)


@settings(deadline=None)
@given(st.tuples(offset, offset, offset), st.tuples(offset, offset, offset))
def test_so_is_a_start_off_the_nominal_pose(move, turn):
    pose = dict(zip(("x", "y", "z"), move + np.array([0, 0, 1.43]), strict=True))
    pose |= dict(zip(("roll", "pitch", "yaw"), turn, strict=True))
    assert imbalance(parameter_set("trial", pose)) < 1e-14


def test_the_pretension_is_the_balanced_one_nearest_to_4_newton():
    T = rest(parameter_set(), INCA).tension
    W = inverse([0, 0, 1.43, 0, 0, 0], INCA).W
    np.testing.assert_allclose(W @ T, [0, 0, 0.1725 * 9.81, 0, 0, 0], atol=1e-13)
    # Nearest: what was changed has no part along the tensions that balance each other.
    _, _, rows = np.linalg.svd(W)
    np.testing.assert_allclose(rows[6:] @ (T - 4), 0, atol=1e-13)


def test_the_no_load_length_gives_the_pretension():
    r = rest(parameter_set(), INCA)
    np.testing.assert_allclose(25000 * (r.length - r.no_load) / r.no_load, r.tension, rtol=1e-11)


def test_a_cable_that_would_push_is_named():
    with pytest.raises(InputError, match=r"drive [1-4] would need a tension of -.*lower m"):
        rest(parameter_set("trial", {"m": 20.0}), INCA)
