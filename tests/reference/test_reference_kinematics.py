"""Kinematics against finite differences along a trajectory of the equations."""

import numpy as np
import pytest
from reference_cases import plain_rotation, taut

from inca_mj.reference import equations, pack, rotation_matrix, simulate_reference
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


def test_the_rotation_is_orthonormal_and_in_the_thesis_order():
    R_AB = rotation_matrix(EULER)
    np.testing.assert_allclose(R_AB.T @ R_AB, np.eye(3), atol=1e-15)
    np.testing.assert_allclose(R_AB, plain_rotation(EULER), atol=1e-15)
    assert np.linalg.det(R_AB) == pytest.approx(1)


def test_euler_rates_turn_the_platform_at_its_body_rates():
    ω, h = np.array([0.3, -0.5, 0.8]), 1e-5
    J = np.array(list(equations.euler_rate_matrix(equations.vector(EULER))))
    step = h * J @ ω
    R_rate = (rotation_matrix(EULER + step) - rotation_matrix(EULER - step)) / (2 * h)
    skew = rotation_matrix(EULER).T @ R_rate
    np.testing.assert_allclose([skew[2, 1], skew[0, 2], skew[1, 0]], ω, rtol=1e-9)


def test_lengths_change_at_their_rates(run):
    q = pack(parameter_set(), INCA)
    each = (equations.cables(x, q) for x in run.state)
    _, d, d_rate, _, _ = map(np.array, zip(*each, strict=True))
    assert np.abs(d_rate).max() > 1e-3
    np.testing.assert_allclose(rate_of(d), d_rate[2:-2], atol=1e-8)
