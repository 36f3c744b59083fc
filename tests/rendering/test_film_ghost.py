import numpy as np
import pytest

from identification.errors import InputError
from inca_mj.kinematics.stiff import poses_with_stiff_cables
from inca_mj.rendering.ghost import ghost_positions


def test_the_ghost_of_simulated_angles_is_the_simulated_robot(short_run):
    robot = short_run.twin
    R, begin = robot.parameters.values()["R"], np.array(robot.start.pose)
    poses = poses_with_stiff_cables(short_run.motor_angle, R, begin, robot.geometry)
    # A millimetre: the strain that the ghost neglects is a tenth of that.
    np.testing.assert_allclose(poses[:, :3], short_run.position, atol=1e-3)
    np.testing.assert_allclose(poses[:, 3:], short_run.angles, atol=1e-2)
    assert np.ptp(short_run.position[:, 2]) > 0.02


def test_a_measured_pose_is_used_as_it_is(short_run):
    poses = np.hstack([short_run.position, short_run.angles])
    positions = ghost_positions(short_run.twin, short_run.motor_angle, poses)
    turns = np.abs((positions[:, 3:7] * short_run.qpos[:, 3:7]).sum(axis=1))
    np.testing.assert_allclose(turns, 1, atol=1e-12)
    np.testing.assert_allclose(positions[:, :3], short_run.position, atol=0)
    np.testing.assert_allclose(positions[:, 7:], short_run.motor_angle, atol=0)


@pytest.mark.parametrize(
    ("angles", "poses"),
    [
        (np.zeros((5, 7)), None),
        (np.zeros(8), None),
        (np.full((5, 8), np.nan), None),
        (np.zeros((5, 8)), np.zeros((4, 6))),
        (np.zeros((5, 8)), np.zeros((5, 3))),
    ],
)
def test_measurements_of_another_shape_are_refused(short_run, angles, poses):
    with pytest.raises(InputError, match="measured"):
        ghost_positions(short_run.twin, angles, poses)


def test_angles_that_no_pose_comes_near_are_refused_at_their_first_sample(short_run):
    """Each sample would take all steps of the search: of 4700 rad a film never ended."""
    angles = 200.0 * short_run.motor_angle
    angles[-1] = 4700.0
    with pytest.raises(InputError, match=r"of sample \d+ give: .* check the unit of the angles"):
        ghost_positions(short_run.twin, angles, None)
