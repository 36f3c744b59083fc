"""Distances of cables: lockstep with a search, symmetric, zero where they cross."""

from itertools import combinations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import lsq_linear
from statics_cases import ROBOT

from inca_mj.kinematics.cables import inverse
from inca_mj.robot.geometry import GRIP, GRIP_RADIUS, INCA
from inca_mj.statics.interference import interference, point_distance, segment_distance

number = st.integers(-3, 3).map(float)  # whole numbers also make parallel and touching segments
vector = st.tuples(number, number, number).map(np.array)
direction = vector.filter(lambda v: bool(v.any()))


@given(vector, direction, vector, direction)
@settings(max_examples=100, deadline=None)
def test_segments_are_as_far_apart_as_a_bounded_least_squares_says(p, u, q, v):
    found = float(segment_distance(p, u, q, v))
    slow = lsq_linear(np.column_stack([u, -v]), q - p, bounds=(0, 1), tol=1e-14)
    # the search may stop early, never below the least
    assert found <= np.sqrt(2 * slow.cost) + 1e-6
    t = np.linspace(0, 1, 41)
    some = np.linalg.norm((p + t[:, None] * u)[:, None] - (q + t[:, None] * v)[None], axis=2)
    assert found <= some.min() + 1e-12
    assert found >= some.min() - 0.05 * (np.linalg.norm(u) + np.linalg.norm(v))
    assert abs(float(segment_distance(q, v, p, u)) - found) < 1e-12


def test_cables_with_a_common_connector_are_told_by_their_angle():
    found = interference(ROBOT.start, INCA)
    apart = {*combinations(range(1, 9), 2)} - {(1, 2), (3, 4), (5, 8), (6, 7)}
    assert found.pairs == tuple(sorted(apart))
    assert found.angle.shape == (1, 4)
    s = inverse(ROBOT.start, INCA).directions
    np.testing.assert_allclose(np.cos(found.angle[0]), [s[0] @ s[1], s[2] @ s[3], s[4] @ s[7],
                                                        s[5] @ s[6]])  # fmt: skip


def test_a_grip_that_is_turned_into_a_cable_is_found():
    """At some of many turns of the platform a cable runs inside its grip, and never upright."""
    turns = np.array([(0, 0, 1.43, roll, pitch, 0) for roll in np.linspace(0, np.pi, 25)
                      for pitch in np.linspace(-1.4, 1.4, 25)])  # fmt: skip
    assert interference(turns, INCA).platform.min() < 0
    upright = interference(ROBOT.start, INCA)
    cable, pose = upright.nearest_to_platform()
    assert pose == 0
    assert upright.platform[0, cable - 1] == upright.platform.min() > 0
    at = inverse(ROBOT.start, INCA)
    tip = ROBOT.start[:3] + np.array(GRIP[1])
    far = point_distance(tip, INCA.A, at.directions * at.lengths[:, None]) - GRIP_RADIUS
    assert (upright.platform[0] <= far + 1e-12).all()
