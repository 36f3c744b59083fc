"""Rotations against scipy's, and rates of angles against differences."""

import numpy as np
import pytest
from hypothesis import given, settings
from kinematics_cases import INSIDE
from scipy.spatial.transform import Rotation

from identification.errors import InputError
from inca_mj.kinematics import (
    body_rate_matrix,
    euler,
    euler_of,
    euler_rate_matrix,
    pose_rate_matrix,
    quaternion,
    rotation,
)
from inca_mj.kinematics.rotations import cross_matrix, turn


@settings(max_examples=30, deadline=None)
@given(INSIDE)
def test_rotations_are_those_of_scipy_and_give_their_angles_back(pose):
    R = rotation(*pose[3:])
    np.testing.assert_allclose(R, Rotation.from_euler("xyz", pose[3:]).as_matrix(), atol=1e-15)
    np.testing.assert_allclose(euler_of(R), pose[3:], atol=1e-14)
    np.testing.assert_allclose(euler(quaternion(*pose[3:])), pose[3:], atol=1e-14)


def test_turns_are_those_of_scipy_also_for_no_turn():
    vectors = np.vstack([np.zeros(3), np.random.default_rng(0).normal(0, 2, (20, 3))])
    np.testing.assert_allclose(turn(vectors), Rotation.from_rotvec(vectors).as_matrix(), atol=1e-14)


@settings(max_examples=30, deadline=None)
@given(INSIDE)
def test_the_euler_rate_matrix_inverts_the_body_rate_matrix(pose):
    np.testing.assert_allclose(
        euler_rate_matrix(pose) @ body_rate_matrix(pose), np.eye(3), atol=1e-14
    )


@settings(max_examples=30, deadline=None)
@given(INSIDE)
def test_pose_rates_move_the_pose_as_the_twist_says(pose):
    twist, h = np.array([0.3, -0.2, 0.5, 0.4, -0.7, 0.6]), 1e-5
    ahead, behind = (pose + sign * h * pose_rate_matrix(pose) @ twist for sign in (1, -1))
    R_rate = (rotation(*ahead[3:]) - rotation(*behind[3:])) / (2 * h)
    np.testing.assert_allclose(
        R_rate @ rotation(*pose[3:]).T, cross_matrix(twist[3:]), atol=1e-9
    )  # fmt: skip
    np.testing.assert_allclose((ahead - behind)[:3] / (2 * h), twist[:3], atol=1e-10)


def test_rates_of_angles_are_refused_where_roll_and_yaw_are_one():
    with pytest.raises(InputError, match="pitch of 90 degrees"):
        euler_rate_matrix(np.array([0, 0, 1, 0.3, np.pi / 2, 0]))
