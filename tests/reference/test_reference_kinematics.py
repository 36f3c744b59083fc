"""Kinematics against finite differences along a trajectory of the equations."""

import numpy as np
import pytest
from reference_cases import plain_rotation, taut

from inca_mj.reference import kinematics, outputs, pack, simulate_reference
from inca_mj.reference import layout as at
from inca_mj.robot.geometry import INCA
from inca_mj.robot.parameters import parameter_set

H = 2e-5  # sample time of the trajectory [s]
EULER = np.array([0.4, -0.7, 1.1])


@pytest.fixture(scope="module")
def run():
    t = H * np.arange(101)
    return simulate_reference(parameter_set(), INCA, t, np.ones((101, 8)), start=taut(1))


def rate_of(rows):
    """Central differences of order 4; loses two rows at each end."""
    return (rows[:-4] - 8 * rows[1:-3] + 8 * rows[3:-1] - rows[4:]) / (12 * H)


def analyses(run):
    """Pose, velocity and acceleration analysis at every sample, and the outputs there."""
    q = pack(parameter_set(), INCA)
    for x in run.state:
        out = outputs(x, np.ones(8), q)
        R_AB = kinematics.rotation(x[at.EULER])
        ω_p, ω_p_rate = R_AB @ x[at.RATES], R_AB @ out.angular_acceleration
        pose = kinematics.geometric(x[at.POSITION], R_AB, INCA)
        motion = kinematics.velocity(pose, R_AB @ x[at.VELOCITY], ω_p)
        change = kinematics.acceleration(pose, motion, out.acceleration, ω_p, ω_p_rate)
        yield pose, motion, change, out


def test_the_rotation_is_orthonormal_and_in_the_thesis_order():
    R_AB = kinematics.rotation(EULER)
    np.testing.assert_allclose(R_AB.T @ R_AB, np.eye(3), atol=1e-15)
    np.testing.assert_allclose(R_AB, plain_rotation(EULER), atol=1e-15)
    assert np.linalg.det(R_AB) == pytest.approx(1)


def test_the_euler_rate_matrix_inverts_the_body_rate_matrix():
    product = kinematics.euler_rate_matrix(EULER) @ kinematics.body_rate_matrix(EULER)
    np.testing.assert_allclose(product, np.eye(3), atol=1e-15)


def test_euler_rates_turn_the_platform_at_its_body_rates():
    ω, h = np.array([0.3, -0.5, 0.8]), 1e-5
    step = h * kinematics.euler_rate_matrix(EULER) @ ω
    R_rate = (kinematics.rotation(EULER + step) - kinematics.rotation(EULER - step)) / (2 * h)
    skew = kinematics.rotation(EULER).T @ R_rate
    np.testing.assert_allclose([skew[2, 1], skew[0, 2], skew[1, 0]], ω, rtol=1e-9)


def test_a_cable_frame_has_its_z_along_the_cable():
    p = np.array([0.2, -0.3, 1.1])
    pose = kinematics.geometric(p, kinematics.rotation(EULER), INCA)
    np.testing.assert_allclose(pose.frames[:, :, 2], pose.directions, atol=1e-15)
    identity = np.einsum("nki,nkj->nij", pose.frames, pose.frames)
    np.testing.assert_allclose(identity, np.broadcast_to(np.eye(3), (8, 3, 3)), atol=1e-15)
    ends = INCA.A + pose.lengths[:, None] * pose.directions
    np.testing.assert_allclose(ends, p + pose.arms, atol=1e-15)


def test_lengths_and_directions_change_at_the_rates_of_the_velocity_analysis(run):
    poses, motions, _, outs = zip(*analyses(run), strict=True)
    d = np.array([pose.lengths for pose in poses])
    s = np.array([pose.directions for pose in poses])
    d_rate = np.array([motion.lengths for motion in motions])
    ω = np.array(
        [np.einsum("nik,nk->ni", p.frames, m.turns) for p, m in zip(poses, motions, strict=True)]
    )
    np.testing.assert_allclose(d_rate, [out.length_rate for out in outs], atol=1e-13)
    np.testing.assert_allclose(rate_of(d), d_rate[2:-2], atol=1e-8)
    np.testing.assert_allclose(rate_of(s), np.cross(ω, s)[2:-2], atol=1e-8)
    np.testing.assert_allclose(np.sum(ω * s, axis=2), 0, atol=1e-15)


def test_rates_change_at_the_acceleration_analysis(run):
    poses, motions, changes, _ = zip(*analyses(run), strict=True)
    frames = np.array([pose.frames for pose in poses])
    d_rate = np.array([motion.lengths for motion in motions])
    v_b = np.array([motion.connectors for motion in motions])
    ω = np.einsum("tnik,tnk->tni", frames, [motion.turns for motion in motions])
    ω_rate = np.einsum("tnik,tnk->tni", frames, [change.turns for change in changes])
    d_rate_rate = np.array([change.lengths for change in changes])
    v_b_rate = np.array([change.connectors for change in changes])
    scale = np.abs(d_rate_rate).max()
    assert scale > 1
    np.testing.assert_allclose(rate_of(d_rate), d_rate_rate[2:-2], atol=1e-6 * scale)
    np.testing.assert_allclose(rate_of(v_b), v_b_rate[2:-2], atol=1e-6 * scale)
    np.testing.assert_allclose(rate_of(ω), ω_rate[2:-2], atol=1e-6 * scale)
