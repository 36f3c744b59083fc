"""The stiffness matrix against differences of the static force, and what follows from it."""

import numpy as np
import pytest
from hypothesis import given, settings
from scipy.linalg import block_diag
from statics_cases import ROBOT, poses

from inca_mj.kinematics.cables import inverse
from inca_mj.robot.geometry import INCA
from inca_mj.statics.equilibrium import equilibrium, moved
from inca_mj.statics.robot import pull
from inca_mj.statics.stiffness import mass_matrix, modes, principal, stiffness, with_drums

STEP = 3e-5  # tensions are known to λ times rounding, 5e-12 N


def differences(pose, tension_at):
    """−∂(wrench)/∂(displacement, turn) by central differences, shape (6, 6)."""
    columns = []
    for step in STEP * np.eye(6):
        ends = []
        for sign in (1, -1):
            at = inverse(moved(pose, sign * step), INCA)
            ends.append(at.W @ tension_at(at.lengths))
        columns.append(-(ends[0] - ends[1]) / (2 * STEP))
    return np.array(columns).T


@given(poses)
@settings(max_examples=20, deadline=None)
def test_it_is_the_derivative_of_the_wrench_with_locked_drums_and_with_free_ones(pose):
    at = inverse(pose, INCA)
    T = np.linspace(2, 9, 8)
    d_0 = ROBOT.lambda_ * at.lengths / (ROBOT.lambda_ + T)
    K = stiffness(at, T, ROBOT.lambda_ / d_0)
    want = differences(pose, lambda d: ROBOT.lambda_ * (d - d_0) / d_0)
    np.testing.assert_allclose(K, want, atol=1e-7 * np.abs(K).max())
    current = np.linspace(-0.3, 0.5, 8)
    found = pull(ROBOT, at.lengths, current)
    K = stiffness(at, found.tension, found.stiffness)
    want = differences(pose, lambda d: pull(ROBOT, d, current).tension)
    np.testing.assert_allclose(K, want, atol=3e-7 * np.abs(K).max())


def test_it_is_symmetric_at_rest_and_only_there():
    rest = equilibrium(ROBOT)
    np.testing.assert_allclose(rest.stiffness, rest.stiffness.T, atol=1e-9)
    twisted = equilibrium(ROBOT, load=np.array([0, 0, 0, 0.02, 0, 0]))
    lost = twisted.stiffness - twisted.stiffness.T
    # K − Kᵀ is [torque]× in the block of turns (the load's sign turned), and nothing elsewhere
    np.testing.assert_allclose(lost[:3, :], 0, atol=1e-9)
    assert abs(lost[4, 5]) == pytest.approx(0.02, abs=1e-9)


def test_eliminating_the_drums_gives_the_stiffness_with_free_drums():
    at = inverse(ROBOT.start, INCA)
    whole = with_drums(ROBOT, at, ROBOT.tension, ROBOT.no_load)
    drums = np.linalg.solve(whole[6:, 6:], whole[6:, :6])
    np.testing.assert_allclose(whole[:6, :6] - whole[:6, 6:] @ drums,
                               equilibrium(ROBOT).stiffness, atol=1e-6)  # fmt: skip


def test_principal_values_are_forces_over_displacements():
    at = inverse(ROBOT.start + np.r_[0.2, 0.1, -0.2, 0, 0, 0.1], INCA)
    K = stiffness(at, np.full(8, 4.0), ROBOT.lambda_ / at.lengths)
    K = (K + K.T) / 2
    push, twist = principal(K)
    for values, vectors, side in ((push.values, push.vectors, 0), (twist.values, twist.vectors, 3)):
        assert (np.diff(values) >= 0).all()
        for value, v in zip(values, vectors, strict=True):
            load = np.zeros(6)
            load[side : side + 3] = value * v
            np.testing.assert_allclose(np.linalg.solve(K, load)[side : side + 3], v, atol=1e-6)


def test_modes_solve_the_equation_and_drums_slow_them():
    at = inverse(ROBOT.start, INCA)
    K = stiffness(at, ROBOT.tension, ROBOT.lambda_ / ROBOT.no_load)
    M = mass_matrix(ROBOT, ROBOT.start)
    found = modes(K, M)
    for f, x in zip(found.frequency, found.shape, strict=True):
        np.testing.assert_allclose(K @ x, (2 * np.pi * f) ** 2 * M @ x, atol=1e-6 * np.abs(K).max())
    whole = with_drums(ROBOT, at, ROBOT.tension, ROBOT.no_load)
    heavy = [block_diag(M, np.diag(scale * ROBOT.J)) for scale in (1.0, 1e9)]
    assert (modes(whole, heavy[0]).frequency < found.frequency).all()
    # drums of endless inertia are locked: the platform's modes are the last six
    np.testing.assert_allclose(modes(whole, heavy[1], 14).frequency[8:], found.frequency, rtol=1e-6)
