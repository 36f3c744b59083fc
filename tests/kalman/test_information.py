"""What the samples of a log tell of its noise, on the cable robot, whose states differ by 1e5."""

import numpy as np
from effect_cases import bare
from plain_logs import plain_log

from identification import Predictor
from identification.kalman.backwards import information
from identification.kalman.linear import linearise
from identification.kalman.noise_model import Noise, build_whitener
from inca_mj.robot.inputs import make_input
from inca_mj.twin.logs import ANGLES, CURRENTS


def slow_information(filter_):
    """The recursion with the matrices of the whole state, multiplied in the order they stand."""
    system, (nx, nu, ny) = filter_.system, filter_.system.sizes
    C = np.hstack([system.C, np.zeros((ny, nu))])
    N, V, diagonal = np.zeros((nx + nu, nx + nu)), [], []
    for k in range(len(filter_.K) - 1, -1, -1):
        K, L = filter_.K[k], filter_.L[k]
        if k < len(system.A):
            A = np.block([[system.A[k], system.B[k]],
                          [np.zeros((nu, nx)), system.a[k] * np.eye(nu)]])  # fmt: skip
            N = A.T @ N @ A
        V.append(np.diag(L.T @ L + K.T @ N @ K))
        rest = np.eye(nx + nu) - K @ C
        N = rest.T @ N @ rest + C.T @ L.T @ L @ C
        diagonal.append(np.diag(N))
    return np.array(V[::-1]), np.array(diagonal[::-1])


def test_rounding_does_not_grow_along_a_log():
    """A sum of all products of the update loses every digit within some hundred samples."""
    u = make_input("prbs", 3.0)
    log = plain_log(u, np.zeros_like(u), CURRENTS, ANGLES)
    plant = linearise(Predictor(bare(), log, ()), np.empty(0))
    filter_ = build_whitener(plant, Noise(2.0, 0.03), log.sampling_time)
    V, N = information(filter_.system, filter_.K, filter_.L)
    slow_V, slow_N = slow_information(filter_)
    np.testing.assert_allclose(V, slow_V, rtol=1e-9)
    size = np.abs(slow_N).max(axis=0)
    np.testing.assert_allclose(N / size, slow_N / size, atol=1e-9)
