"""Lengths, rates and accelerations against MuJoCo, the reference and differences."""

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from kinematics_cases import FLAT, INSIDE, TWIST

from inca_mj.kinematics import (
    Pulleys,
    accelerations,
    condition,
    inverse,
    jacobian,
    jacobian_rate,
    length_jacobian,
    pose_rate_matrix,
    quaternion,
    rank,
    rates,
    rotation,
)
from inca_mj.robot.geometry import INCA
from inca_mj.twin.twin import build_twin

PULLEYS = (None, Pulleys(0.03), Pulleys((0.01, 0.02, 0.03, 0.04) * 2, over=True))


@pytest.fixture(scope="module")
def model():
    return build_twin().model


def in_mujoco(model, pose, twist):
    """Lengths and their rates; MuJoCo turns the platform about its own axes."""
    data = mujoco.MjData(model)
    data.qpos[:7] = [*pose[:3], *quaternion(*pose[3:])]
    data.qvel[:6] = [*twist[:3], *(rotation(*pose[3:]).T @ twist[3:])]
    data.act[:] = model.key("start").act
    mujoco.mj_fwdPosition(model, data)
    mujoco.mj_fwdVelocity(model, data)
    return data.ten_length.copy(), data.ten_velocity.copy()


@settings(max_examples=25, deadline=None)
@given(INSIDE, TWIST)
def test_lengths_and_their_rates_are_those_of_the_twin(model, pose, twist):
    there = inverse(pose, INCA)
    d, d_rate = in_mujoco(model, pose, twist)
    np.testing.assert_allclose(there.lengths, d, rtol=1e-12)
    np.testing.assert_allclose(rates(there, twist).lengths, d_rate, atol=1e-11)
    np.testing.assert_allclose(jacobian(there) @ twist, d_rate, atol=1e-11)
    np.testing.assert_allclose(
        jacobian(there), length_jacobian(pose[:3], rotation(*pose[3:]), INCA), atol=1e-15
    )


def differences(function, pose, twist, h=2e-3):
    """Central differences of order 4 along a motion of constant twist."""

    def at(t):
        # a constant twist along O: the angles follow it, integrated by RK4 in ten steps
        now, n = pose.copy(), 10
        for _ in range(n):
            k = []
            for part in (0, 0.5, 0.5, 1):
                shifted = now + (part * t / n * k[-1] if k else 0)
                k.append(pose_rate_matrix(shifted) @ twist)
            now = now + t / n * (k[0] + 2 * k[1] + 2 * k[2] + k[3]) / 6
        return function(now)

    return (at(-2 * h) - 8 * at(-h) + 8 * at(h) - at(2 * h)) / (12 * h)


@settings(max_examples=10, deadline=None)
@given(INSIDE, TWIST)
def test_the_acceleration_of_lengths_is_the_difference_of_the_twins_rates(model, pose, twist):
    there = inverse(pose, INCA)
    numeric = differences(lambda p: in_mujoco(model, p, twist)[1], pose, twist)
    scale = 1 + np.abs(numeric).max()
    found = accelerations(there, twist, np.zeros(6))
    np.testing.assert_allclose(found.lengths, numeric, atol=1e-8 * scale)
    np.testing.assert_allclose(jacobian_rate(there, twist) @ twist, numeric, atol=1e-8 * scale)


@settings(max_examples=10, deadline=None)
@given(INSIDE)
def test_frames_turn_their_z_along_the_cables_and_angles_are_those_of_frames(pose):
    there = inverse(pose, INCA)
    along = pose[:3] + INCA.B @ rotation(*pose[3:]).T - INCA.A
    directions = along / np.linalg.norm(along, axis=1)[:, None]
    np.testing.assert_allclose(there.directions, directions, atol=1e-14)
    np.testing.assert_allclose(there.frames[:, :, 2], directions, atol=1e-13)
    φ, θ = there.angles.T
    expected = [rotation(0.0, *each) for each in zip(θ, φ, strict=True)]
    np.testing.assert_allclose(there.frames, expected, atol=1e-13)


def in_room(there, vectors):
    """Vectors in the frames of the cables, along the axes of O."""
    return np.einsum("nik,nk->ni", there.frames, vectors)


@settings(max_examples=10, deadline=None)
@given(INSIDE, TWIST)
def test_connectors_and_directions_move_at_their_rates_and_these_at_theirs(pose, twist):
    there = inverse(pose, INCA)

    def place(p):
        return p[:3] + inverse(p, INCA).arms

    def turning(p):
        return in_room(inverse(p, INCA), rates(inverse(p, INCA), twist).turns)

    moved, changed = rates(there, twist), accelerations(there, twist, np.zeros(6))
    near = {"atol": 1e-8 * (1 + np.abs(changed.turns).max() + np.abs(changed.connectors).max())}
    ω = in_room(there, moved.turns)
    np.testing.assert_allclose(moved.connectors, differences(place, pose, twist), **near)
    s_rate = differences(lambda p: inverse(p, INCA).directions, pose, twist)
    np.testing.assert_allclose(np.cross(ω, there.directions), s_rate, **near)
    np.testing.assert_allclose(np.sum(ω * there.directions, axis=1), 0, atol=1e-12)
    v_rate = differences(lambda p: rates(inverse(p, INCA), twist).connectors, pose, twist)
    np.testing.assert_allclose(changed.connectors, v_rate, **near)
    np.testing.assert_allclose(
        in_room(there, changed.turns), differences(turning, pose, twist), **near
    )


@settings(max_examples=30, deadline=None)
@given(INSIDE, TWIST, TWIST)
def test_a_change_of_the_twist_adds_what_a_twist_does(pose, twist, change):
    there = inverse(pose, INCA)
    found, still = (accelerations(there, twist, each) for each in (change, np.zeros(6)))
    added = rates(there, change)
    for name in ("connectors", "lengths", "turns"):
        more = getattr(found, name) - getattr(still, name)
        np.testing.assert_allclose(more, getattr(added, name), atol=1e-11)
    d_rate_rate = jacobian(there) @ change + jacobian_rate(there, twist) @ twist
    np.testing.assert_allclose(found.lengths, d_rate_rate, atol=1e-12)


@pytest.mark.parametrize("pulleys", PULLEYS)
def test_jacobian_and_its_rate_are_differences_also_over_pulleys(pulleys):
    rng = np.random.default_rng(3)
    for _ in range(5):
        pose = rng.uniform([-0.5, -0.5, 0.8, -0.4, -0.4, -0.4], [0.5, 0.5, 2.2, 0.4, 0.4, 0.4])
        twist = rng.normal(0, 1, 6)
        there = inverse(pose, INCA, pulleys)
        d_rate = differences(lambda p: inverse(p, INCA, pulleys).lengths, pose, twist)
        np.testing.assert_allclose(jacobian(there) @ twist, d_rate, atol=1e-8)
        L_rate = differences(lambda p: jacobian(inverse(p, INCA, pulleys)), pose, twist)
        np.testing.assert_allclose(jacobian_rate(there, twist), L_rate, atol=1e-8)


def test_many_poses_are_done_at_once_as_one_by_one():
    rng = np.random.default_rng(1)
    poses = rng.uniform(
        [-0.5, -0.5, 1, -0.4, -0.4, -0.4], 0.5 + np.array([0, 0, 1, 0, 0, 0]), (7, 6)
    )
    twists = rng.normal(0, 1, (7, 6))
    for pulleys in PULLEYS:
        together = inverse(poses, INCA, pulleys)
        for k, (pose, twist) in enumerate(zip(poses, twists, strict=True)):
            alone = inverse(pose, INCA, pulleys)
            np.testing.assert_allclose(together.lengths[k], alone.lengths, rtol=1e-15)
            np.testing.assert_allclose(
                rates(together, twists).turns[k], rates(alone, twist).turns, atol=1e-14
            )
            np.testing.assert_allclose(
                jacobian_rate(together, twists)[k], jacobian_rate(alone, twist), atol=1e-14
            )


def test_a_flat_robot_has_rank_three_and_no_condition():
    there = inverse(np.array([0.1, 0.2, 1.0, 0, 0, 0.3]), FLAT)
    assert rank(there) == 3
    assert condition(there) == np.inf
    assert rank(inverse(np.array([0, 0, 1.43, 0, 0, 0]), INCA)) == 6


def test_the_condition_does_not_depend_on_the_unit_of_length():
    from dataclasses import replace

    pose = np.array([0.1, -0.2, 1.2, 0.1, 0.2, 0.3])
    tenth = replace(
        INCA, exits=tuple(map(tuple, INCA.A / 10)), connectors=tuple(map(tuple, INCA.B / 10))
    )
    scaled = pose * [0.1, 0.1, 0.1, 1, 1, 1]
    assert condition(inverse(scaled, tenth)) == pytest.approx(condition(inverse(pose, INCA)))
