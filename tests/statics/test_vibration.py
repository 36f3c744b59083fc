"""Cables that swing: strings, sag, and the platform on them, by the exact dynamic stiffness."""

import numpy as np
import pytest
from scipy.linalg import eigh
from statics_cases import ROBOT

from inca_mj.kinematics.cables import inverse
from inca_mj.kinematics.rotations import cross_matrix
from inca_mj.robot.geometry import INCA
from inca_mj.statics.stiffness import mass_matrix, stiffness
from inca_mj.statics.vibration import (
    coupled_modes,
    in_plane_frequency,
    irvine_parameter,
    string_frequencies,
)

AT = inverse(ROBOT.start, INCA)
RHO = 1e-3


def coupled(rho=RHO, sines=12):
    return coupled_modes(ROBOT, ROBOT.start, AT, ROBOT.tension, rho, sines)


def test_a_string_of_small_pieces_has_the_frequencies_of_a_string():
    d, T, n = 2.5, 4.0, 400
    K = (np.diag(np.full(n - 1, 2.0)) - np.eye(n - 1, k=1) - np.eye(n - 1, k=-1)) * T * n / d
    slow = np.sqrt(np.linalg.eigvalsh(K / (RHO * d / n))[:3]) / (2 * np.pi)
    np.testing.assert_allclose(string_frequencies(d, T, RHO), slow, rtol=1e-4)


def test_sag_raises_the_first_frequency_from_the_string_to_the_stiff_cable():
    d, T = 2.5, 4.0
    first = float(string_frequencies(d, T, RHO, 1)[0])
    assert in_plane_frequency(d, 1e-4, T, RHO, 25000.0) == pytest.approx(first)
    assert in_plane_frequency(d, d, T, RHO, 1e12) == pytest.approx(2.8606 * first, rel=1e-4)
    for λ in (1e3, 25000.0, 1e6):
        f = in_plane_frequency(d, d, T, RHO, λ)
        x, Λ2 = f / first * np.pi, irvine_parameter(d, T, RHO, λ)
        assert np.tan(x / 2) == pytest.approx(x / 2 - 4 / Λ2 * (x / 2) ** 3, rel=1e-6)
        assert first < f < 2.87 * first


def test_light_cables_change_nothing_and_more_sines_converge_from_above():
    light = coupled(1e-12)
    np.testing.assert_allclose(light.coupled, light.massless, rtol=1e-5)
    np.testing.assert_allclose(light.share, 1, atol=1e-5)
    found = [coupled(sines=n).coupled for n in (4, 8, 16)]
    assert np.abs(found[1] - found[2]).max() < np.abs(found[0] - found[1]).max()
    assert (found[2] <= found[1] + 1e-9).all()  # of a Ritz method
    assert (coupled().added < coupled().massless).all()
    assert (coupled().in_plane > coupled().cables).all()
    np.testing.assert_allclose(light.in_plane, light.cables)


def test_the_exact_dynamic_stiffness_of_strings_is_singular_there():
    """A string pulls its moving end back with T (ω/c) cot(ω d/c), exactly."""
    found = coupled(sines=40)
    T, d, s = ROBOT.tension, AT.lengths, AT.directions
    d_0 = ROBOT.lambda_ * d / (ROBOT.lambda_ + T)
    K, M = stiffness(AT, T, ROBOT.lambda_ / d_0), mass_matrix(ROBOT, ROBOT.start)
    C = np.concatenate([np.broadcast_to(np.eye(3), (8, 3, 3)), -cross_matrix(AT.arms)], axis=2)
    along = s[:, :, None] * s[:, None, :]
    across = np.eye(3) - along

    def smallest(f):
        ω = 2 * np.pi * f
        c = np.sqrt(T / RHO)
        more = T * (ω / c) / np.tan(ω * d / c) - T / d
        D = K - ω**2 * M
        D = D + np.einsum("k,kia,kij,kjb->ab", more, C, across, C)
        D = D - ω**2 * np.einsum("k,kia,kij,kjb->ab", RHO * d / 3, C, along, C)
        values = eigh(D, M, eigvals_only=True)
        return values[np.abs(values).argmin()] / ω**2

    for f in found.coupled:
        # an eigenvalue of D passes through zero within 0.2 % of the frequency, or comes very near
        around = [smallest(f * (1 + e)) for e in np.linspace(-2e-3, 2e-3, 41)]
        assert np.abs(around).min() < 1e-3
