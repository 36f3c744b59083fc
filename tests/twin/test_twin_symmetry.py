"""The geometry equals its mirror images, so a mirrored start and input give a mirrored run."""

import numpy as np
import pytest
from twin_cases import moving

from identification.model.rollout import State
from inca_mj.robot.inputs import prbs
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import build_twin

# The sign of a polar vector's entries, and where each drive lands.
MIRRORS = {
    "x": (np.array([-1, 1, 1]), np.array([2, 1, 4, 3, 6, 5, 8, 7]) - 1),
    "y": (np.array([1, -1, 1]), np.array([4, 3, 2, 1, 8, 7, 6, 5]) - 1),
}


def mirrored(at, sign, drives):
    """p, v mirror; ω and a quaternion's vector part are axial and take det(M) M."""
    axial = np.prod(sign) * sign
    qpos, qvel = np.atleast_2d(at.qpos), np.atleast_2d(at.qvel)
    return State(
        np.hstack([sign * qpos[:, :3], qpos[:, 3:4], axial * qpos[:, 4:7], qpos[:, 7:][:, drives]]),
        np.hstack([sign * qvel[:, :3], axial * qvel[:, 3:6], qvel[:, 6:][:, drives]]),
        np.atleast_2d(at.act)[:, drives],
    )


@pytest.mark.parametrize("axis", MIRRORS)
def test_a_mirrored_start_and_input_give_the_mirrored_run(axis):
    sign, drives = MIRRORS[axis]
    robot, start, currents = build_twin(), moving(3), prbs(101, 0.01, seed=5)
    run = simulate(robot, currents, start=start)
    image = simulate(robot, currents[:, drives], start=mirrored(start, sign, drives))
    expected = mirrored(State(run.qpos, run.qvel, run.act), sign, drives)
    np.testing.assert_allclose(image.qpos, expected.qpos, atol=1e-10)
    np.testing.assert_allclose(image.tension, run.tension[:, drives], atol=1e-8)
    assert np.abs(run.motor_angle[-1]).max() > 1
