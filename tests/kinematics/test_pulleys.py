"""The path over a pulley: against a slow minimisation, two other programs, and differences."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from identification.errors import InputError
from inca_mj.effects.cable import pulley_radius
from inca_mj.kinematics import Pulleys
from inca_mj.kinematics.cables import cables_along
from inca_mj.studies.worlds.equations import path as path_of_worlds

SPAN = st.tuples(st.floats(0.3, 2), st.floats(-2, 2), st.floats(0.3, 2), st.booleans()).map(
    lambda s: np.array([s[0], s[1], s[2] if s[3] else -s[2]])
)


def paths(spans, pulleys=None):
    return cables_along(spans, spans, pulleys)


class _State:
    def __init__(self, span):
        self.rx, self.ry, self.rz = span


def shortest(h, z, r):
    """The shortest string that leaves the pulley at some angle and does not cut through it."""
    low, high = 0.0, np.pi
    for _ in range(6):  # ever finer grids
        β = np.linspace(low, high, 2001)
        leave = r * np.column_stack([1 - np.cos(β), np.sin(β)])
        line = np.array([h, z]) - leave
        centre = np.array([r, 0]) - leave
        along = np.clip(np.sum(centre * line, 1) / np.sum(line**2, 1), 0, 1)
        distance = np.linalg.norm(centre - along[:, None] * line, axis=1)
        length = np.where(distance >= r * (1 - 1e-13), r * β + np.linalg.norm(line, axis=1), np.inf)
        best, step = int(length.argmin()), β[1] - β[0]
        low, high = max(0.0, β[best] - 2 * step), min(np.pi, β[best] + 2 * step)
    return length[best], β[best]


@pytest.mark.parametrize("r", [0.005, 0.03, 0.1])
@pytest.mark.parametrize("span", [(1.2, -0.7, 1.1), (0.4, 0.3, -1.4), (1.6, 1.5, 0.3)])
def test_the_path_is_the_shortest_one_around_the_pulley(span, r):
    spans = np.tile(np.array(span), (8, 1))
    found = paths(spans, Pulleys(r))
    length, β = shortest(np.hypot(*span[:2]), abs(span[2]), r)
    # the length grows with the third power beyond the tangent point, so its angle is less sharp
    assert found.lengths[0] == pytest.approx(length, abs=1e-10)
    assert found.wraps[0] == pytest.approx(β, abs=1e-5)


@settings(max_examples=30, deadline=None)
@given(SPAN, st.floats(0.001, 0.08), st.booleans())
def test_it_is_the_path_of_the_effect_and_of_the_hidden_robots(span, r, over):
    found = paths(np.tile(span, (8, 1)), Pulleys(r, over))
    longer = pulley_radius.py_func(_State(span), (r, float(over)))
    straight = np.linalg.norm(span)
    assert found.lengths[0] == pytest.approx(straight + longer[0], abs=1e-12)
    np.testing.assert_allclose(found.directions[0], span / straight + longer[1:], atol=1e-12)
    side = 1.0 if (span[2] >= 0) != over else -1.0
    d, s = path_of_worlds(tuple(span), r, side)
    assert found.lengths[0] == pytest.approx(d, abs=1e-12)
    np.testing.assert_allclose(found.directions[0], s, atol=1e-12)


@settings(max_examples=30, deadline=None)
@given(SPAN, st.floats(0.0, 0.08), st.booleans())
def test_directions_and_bends_are_derivatives(span, r, over):
    def at(b):
        return paths(np.tile(b, (8, 1)), Pulleys(r, over))

    found, h = at(span), 1e-5
    np.testing.assert_allclose(np.linalg.norm(found.directions, axis=1), 1, atol=1e-14)
    for k, e in enumerate(np.eye(3)):
        ahead, behind = at(span + h * e), at(span - h * e)
        d_rate = (ahead.lengths - behind.lengths) / (2 * h)
        s_rate = (ahead.directions - behind.directions)[0] / (2 * h)
        np.testing.assert_allclose(d_rate, found.directions[:, k], atol=1e-8)
        np.testing.assert_allclose(s_rate, found.bends[0, :, k], atol=1e-7)


@settings(max_examples=30, deadline=None)
@given(SPAN)
def test_without_a_radius_the_cable_is_straight(span):
    spans = np.tile(span, (8, 1))
    none, zero = paths(spans), paths(spans, Pulleys(0.0))
    np.testing.assert_allclose(zero.lengths, none.lengths, rtol=1e-15)
    np.testing.assert_allclose(zero.directions, none.directions, atol=1e-15)
    np.testing.assert_allclose(zero.bends, none.bends, atol=1e-14)


def test_pulleys_that_are_none_are_refused():
    with pytest.raises(InputError, match="0 or more"):
        Pulleys(-0.01)
