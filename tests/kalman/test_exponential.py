"""Transitions from the series are those of the matrix exponential."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm

from identification.kalman.response import transitions

SIZES = st.integers(1, 6)
SCALES = st.sampled_from([1e-9, 1e-3, 1.0, 30.0, 1e3])


def drawn(seed, size, scale):
    """Stable matrices, shape (5, size, size) [1/s], and durations, shape (5,) [s]."""
    rng = np.random.default_rng(seed)
    F = scale * (rng.normal(size=(5, size, size)) - 2 * size * np.eye(size))
    return F, rng.uniform(1e-4, 1e-2, 5)


@given(st.integers(0, 2**32 - 1), SIZES, SCALES)
def test_they_are_the_blocks_of_van_loan(seed, size, scale):
    F, duration = drawn(seed, size, scale)
    A, Γ = transitions(F, duration)
    block = np.zeros((5, 2 * size, 2 * size))
    block[:, :size, :size], block[:, :size, size:] = F, np.eye(size)
    exact = expm(block * duration[:, None, None])
    np.testing.assert_allclose(A, exact[:, :size, :size], atol=1e-13)
    np.testing.assert_allclose(Γ, exact[:, :size, size:], atol=1e-13 * duration.max())


@given(st.integers(0, 2**32 - 1), st.integers(1, 3), st.floats(0.1, 30.0))
def test_oscillations_whose_norm_is_far_above_their_powers(seed, pairs, turns):
    rng = np.random.default_rng(seed)
    rate = turns * rng.uniform(0.1, 1, pairs)
    F = np.zeros((1, 2 * pairs, 2 * pairs))
    F[0, :pairs, pairs:], F[0, pairs:, :pairs] = np.diag(rate), -np.diag(rate)
    F[0, :pairs, 1:pairs] += rng.normal(size=(pairs, pairs - 1)) * turns
    A, _ = transitions(F, np.ones(1))
    exact = expm(F[0])
    np.testing.assert_allclose(A[0], exact, atol=1e-13 * np.abs(exact).max() * (1 + turns))


@given(st.integers(0, 2**32 - 1), SIZES)
def test_the_units_of_the_states_change_nothing(seed, size):
    F, duration = drawn(seed, size, 30.0)
    D = 10.0 ** np.random.default_rng(seed).integers(-5, 6, size)
    units = D[:, None] / D
    for other, own in zip(transitions(F * units, duration), transitions(F, duration), strict=True):
        np.testing.assert_allclose(other / units, own, atol=1e-13)
