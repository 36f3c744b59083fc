"""Cables that run another way: length, gradient, and the direction of the pull."""

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest
from effect_cases import BY_NAME, bare, drive, forward, full, moving

from inca_mj.robot import law
from inca_mj.twin.twin import build_twin

PULLEY, ANCHOR = (BY_NAME[n].hooks["path"].py_func for n in ("pulley_radius", "anchor_offset"))
SPANS = [(1.2, -1.4, 1.3), (-1.5, 1.5, -1.6), (0.4, 1.9, 0.2), (0.05, 0.3, -2.0)]


def at(r) -> object:
    return drive(**dict(zip(("rx", "ry", "rz"), map(float, r), strict=True)))


@pytest.mark.parametrize("r", SPANS)
@pytest.mark.parametrize(
    ("path", "p"), [(PULLEY, (0.03, 0.0)), (PULLEY, (0.03, 1.0)), (ANCHOR, (0.01, -0.02, 0.03))]
)
def test_gradient_and_unit_length(path, p, r):
    r, h = np.array(r), 1e-6
    _, *gradient = path(at(r), p)
    differences = [
        (path(at(r + h * e), p)[0] - path(at(r - h * e), p)[0]) / (2 * h) for e in np.eye(3)
    ]
    assert gradient == pytest.approx(differences, abs=1e-8)
    direction = r / np.linalg.norm(r) + gradient
    assert np.linalg.norm(direction) == pytest.approx(1, abs=1e-12)


@pytest.mark.parametrize("r", SPANS)
@pytest.mark.parametrize("over", [0.0, 1.0])
def test_pulley_is_the_shortest_way_around_a_disc(r, over):
    """Wrapped arc and tangent, drawn point by point from where the cable enters."""
    r_p, (across, z) = 0.03, (sqrt(r[0] ** 2 + r[1] ** 2), abs(r[2]) * (-1 if over else 1))
    angle = np.linspace(0, pi, 20001)
    leave = np.stack([r_p * (1 - np.cos(angle)), r_p * np.sin(angle)], axis=1)
    to = np.array([across, z]) - leave
    heading = np.stack([np.sin(angle), np.cos(angle)], axis=1)
    turn = heading[:, 0] * to[:, 1] - heading[:, 1] * to[:, 0]
    ahead = np.sum(heading * to, axis=1) > 0
    k = np.argmin(np.where(ahead, np.abs(turn), np.inf))
    length = r_p * angle[k] + np.linalg.norm(to[k])
    assert PULLEY(at(r), (r_p, over))[0] + np.linalg.norm(r) == pytest.approx(length, abs=1e-6)


def test_a_pulley_is_the_same_for_high_and_low_drives():
    x, y, z = SPANS[0]
    high, low = PULLEY(at((x, y, -z)), (0.02, 0.0)), PULLEY(at((x, y, z)), (0.02, 0.0))
    assert high[:3] == pytest.approx(low[:3])
    assert high[3] == pytest.approx(-low[3])


def test_an_anchor_offset_is_a_robot_with_that_anchor():
    """Same accelerations as a robot built with the exit point there, in any state."""
    o = np.array([0.01, -0.02, 0.015])
    exits = bare().geometry.A.copy()
    exits[4] += o
    other = build_twin(geometry=replace(bare().geometry, exits=tuple(map(tuple, exits))))
    offset = full().with_values({f"anchor_offset.{n}@5": v for n, v in zip("xyz", o, strict=True)})
    state = moving(offset)
    a = forward(offset, state)
    d_0 = state.act[offset.model.actuator_actadr]
    other.model.actuator_user[:, law.T_0] = offset.start.balance
    b = forward(other, type(state)(state.qpos, state.qvel, d_0))
    assert a.qacc == pytest.approx(b.qacc, rel=1e-9, abs=1e-9)
