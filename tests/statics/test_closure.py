"""Rank and closure: a linear program and the plane of the null space say the same."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import null_space
from statics_cases import EDGES, RADIAL, ROBOT, poses, random_poses

from identification.errors import InputError
from inca_mj.kinematics.cables import inverse
from inca_mj.robot.geometry import INCA
from inca_mj.statics.closure import closure, gap_margin, require_closure, split


def test_many_poses_are_split_as_one_is():
    W = inverse(random_poses(200), INCA).W
    plus, N, full = split(W)
    assert full.all()
    for k in range(len(W)):
        np.testing.assert_allclose(plus[k], np.linalg.pinv(W[k]), atol=1e-9)
        np.testing.assert_allclose(N[k] @ N[k].T, null_space(W[k]) @ null_space(W[k]).T, atol=1e-9)


def test_the_linear_program_and_the_largest_gap_agree():
    W = inverse(random_poses(200), INCA).W
    _, N, full = split(W)
    margin = gap_margin(N, full)
    for k in np.flatnonzero(np.abs(margin) > 1e-4):
        assert closure(W[k]).closed == (margin[k] > 0)
    assert 20 < (margin > 0).sum() < 180  # both kinds were met


@given(poses, st.floats(0.1, 10))
@settings(max_examples=30, deadline=None)
def test_an_internal_tension_balances_and_its_margin_is_the_best(pose, scale):
    W = inverse(pose, INCA).W
    found = closure(W)
    if not found.closed:
        return
    T = found.tensions
    np.testing.assert_allclose(W @ T, 0, atol=1e-9)
    assert T.max() == 1
    assert T.min() == pytest.approx(found.margin)
    assert closure(scale * W).margin == pytest.approx(found.margin, abs=1e-6)
    N = null_space(W)
    around = N @ np.array([np.cos(a := np.linspace(0, 2 * np.pi, 721)), np.sin(a)])
    ratio = around.min(axis=0) / around.max(axis=0)
    assert ratio[around.min(axis=0) > 0].max(initial=0) <= found.margin + 1e-6


def test_one_connector_for_each_edge_has_rank_6_and_no_closure():
    at = inverse(ROBOT.start, EDGES)
    found = closure(at.W)
    assert found.rank == 6
    assert not found.closed
    _, N, full = split(at.W[None])
    assert full[0]
    assert gap_margin(N, full)[0] <= 1e-9
    with pytest.raises(InputError, match="rank 6 without closure"):
        require_closure(found, ROBOT.start)


def test_cables_that_point_at_an_axis_lack_a_rank():
    at = inverse(ROBOT.start, RADIAL)
    found = closure(at.W)
    assert found.rank == 5
    assert np.isinf(found.condition)
    _, N, full = split(at.W[None])
    assert not full[0]
    assert gap_margin(N, full)[0] < 0
    with pytest.raises(InputError, match="rank 5 of 6"):
        require_closure(found, ROBOT.start)


def test_poses_that_are_none_are_refused():
    with pytest.raises(InputError, match="a pose is six finite numbers"):
        inverse(np.zeros(5), INCA)
