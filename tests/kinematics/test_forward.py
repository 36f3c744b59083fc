"""The pose from lengths: round trips, covariance, what is not unique, refusals."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from kinematics_cases import FLAT, INSIDE

from identification.errors import InputError
from inca_mj.kinematics import Pulleys, inverse, pose_from_lengths
from inca_mj.robot.geometry import INCA

START = np.array([0, 0, 1.43, 0, 0, 0])


@settings(max_examples=40, deadline=None)
@given(INSIDE, st.sampled_from([None, Pulleys(0.03)]))
def test_lengths_give_their_pose_back(pose, pulleys):
    found = pose_from_lengths(inverse(pose, INCA, pulleys).lengths, INCA, START, pulleys=pulleys)
    np.testing.assert_allclose(found.pose, pose, atol=1e-8)
    np.testing.assert_allclose(found.residual, 0, atol=1e-10)
    assert found.rank == 6


def test_the_covariance_is_the_scatter_of_poses_from_noisy_lengths():
    pose = np.array([0.2, -0.1, 1.2, 0.2, -0.3, 0.4])
    d, rng = inverse(pose, INCA).lengths, np.random.default_rng(0)
    std = 1e-4 * np.arange(1, 9)
    found = pose_from_lengths(d, INCA, START, std=std)
    noisy = (
        pose_from_lengths(d + std * rng.normal(size=8), INCA, pose, std=std) for _ in range(200)
    )
    error = np.array([n.pose for n in noisy]) - pose
    # 200 squared distances of six degrees of freedom: their mean is 6 ± 0.25
    distance = np.einsum("ni,ij,nj->n", error, np.linalg.inv(found.covariance), error)
    assert distance.mean() == pytest.approx(6, abs=1.0)


def test_where_a_motion_changes_no_length_its_std_is_infinite():
    pose = np.array([0.1, 0.05, 1.0, 0, 0, 0.2])
    found = pose_from_lengths(inverse(pose, FLAT).lengths, FLAT, np.array([0, 0, 1.0, 0, 0, 0.0]))
    assert found.rank == 3
    assert list(np.isinf(found.std)) == [False, False, True, True, True, False]
    np.testing.assert_allclose(found.pose, pose, atol=1e-8)


@pytest.mark.parametrize(
    ("length", "words"), [(0.5, "misses cable"), (-2.0, "8 numbers above zero")]
)
def test_lengths_of_no_pose_are_refused(length, words):
    with pytest.raises(InputError, match=words):
        pose_from_lengths(np.full(8, length), INCA, START)


def test_a_length_that_does_not_fit_the_others_is_refused_unless_it_is_in_reach():
    d = inverse(START, INCA).lengths
    d[0] += 0.1
    with pytest.raises(InputError, match="no pose of the platform"):
        pose_from_lengths(d, INCA, START)
    found = pose_from_lengths(d, INCA, START, reach=0.2)
    assert np.abs(found.residual).max() > 0.01
