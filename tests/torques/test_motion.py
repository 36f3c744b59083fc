"""Rates and accelerations of a smooth motion, without delay, in a band that follows the noise."""

import numpy as np
import pytest

from identification.torques.equations.smoothing import choose_band, low_pass, smooth

H = 0.01
T = np.arange(0, 20, H)
ω = 2 * np.pi * np.array([0.3, 1.1])
MOTION = np.sin(ω * T[:, None]).sum(axis=1)
INNER = slice(100, -100)


def test_rates_and_accelerations_are_those_of_the_motion():
    found = smooth(MOTION[:, None], H, 8.0, np.zeros(1))
    v, a = (ω * np.cos(ω * T[:, None])).sum(axis=1), -(ω**2 * np.sin(ω * T[:, None])).sum(axis=1)
    for mine, truth in ((found.q, MOTION), (found.v, v), (found.a, a)):
        np.testing.assert_allclose(mine[INNER, 0], truth[INNER], atol=1e-3 * np.abs(truth).max())


def test_a_motion_backwards_has_the_same_accelerations_backwards():
    x = np.cumsum(np.random.default_rng(0).normal(size=(500, 2)), axis=0)
    ahead, back = (smooth(y, H, 5.0, np.zeros(2)) for y in (x, x[::-1]))
    np.testing.assert_allclose(ahead.a, back.a[::-1], atol=1e-9 * np.abs(ahead.a).max())
    np.testing.assert_allclose(ahead.v, -back.v[::-1], atol=1e-9 * np.abs(ahead.v).max())


def test_torques_go_through_the_same_filter():
    x = np.random.default_rng(1).normal(size=(400, 3, 2))
    found = low_pass(x, H, 4.0)
    np.testing.assert_allclose(found[:, 1, 0], smooth(x[:, 1], H, 4.0, np.zeros(2)).q[:, 0])


@pytest.mark.parametrize("noise", [1e-6, 1e-5, 1e-4])
def test_the_level_of_noise_is_found_and_the_band_holds_the_motion(noise):
    x = MOTION + noise * np.random.default_rng(2).standard_normal(len(T))
    band, level = choose_band(x, H)
    assert level == pytest.approx(noise, rel=0.2)
    assert 1.1 < band < 20.0


def test_more_noise_makes_the_band_narrower():
    n = np.random.default_rng(3).standard_normal(len(T))
    bands = [choose_band(MOTION + s * n, H)[0] for s in (1e-6, 1e-5, 1e-4, 1e-3)]
    assert bands == sorted(bands, reverse=True)
    assert bands[0] > 1.5 * bands[-1]
