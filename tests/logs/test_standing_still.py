"""An output that shows nothing but its sensor's noise is told; one that moves never is."""

import numpy as np
import pytest
from joint_cases import run, slider, slider_log, steps

from identification.logs.plausible import PAST, is_noise

NOISE = 2e-4  # [m]


def noise(n, seed):
    return NOISE * np.random.default_rng(seed).standard_normal(n)


@pytest.mark.parametrize("samples", [60, 500])
def test_noise_is_told_and_any_motion_is_not(samples):
    """Three times the noise is a motion, whatever the size of both: no level is in the test."""
    u = steps(samples, seed=3)
    moved = run(slider(), slider_log(u))[:, 0]
    for seed in range(20):
        at_rest = noise(samples, seed)
        for size in (1e-9, 1.0, 1e9):
            assert is_noise(0.7 + size * at_rest, u)
            moving = 3 * moved / moved.std() * NOISE + at_rest
            assert not is_noise(size * moving, u)


def test_a_motion_without_memory_is_known_by_its_input():
    """A strongly damped slide, sampled slowly, follows the input and forgets it at once."""
    u = np.random.default_rng(5).standard_normal((300, 1))
    y = np.concatenate([[0.0], 0.01 * u[:-1, 0]]) + noise(300, 6)
    assert is_noise(y, np.empty((300, 0)))
    assert is_noise(y, np.zeros((300, 1)))
    assert not is_noise(y, u)


def test_what_is_constant_or_too_short_is_no_noise():
    assert not is_noise(np.full(100, 0.3), steps(100))
    for samples in (3, PAST, 20):
        assert not is_noise(noise(samples, 1), np.ones((samples, 1)))
