"""A part of a swing is a quarter of the period of a sine, whatever its size, unit and noise."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from identification.logs.swing import FEWEST, LONGEST, SHORTEST, part_of_swing

H = 0.01
TIME = H * np.arange(1000)
BETWEEN = (4 * SHORTEST + 0.05, 4 * LONGEST - 0.05)  # periods whose quarter no limit cuts


@given(st.floats(*BETWEEN), st.floats(0, 6.3), st.floats(1e-3, 1e3), st.floats(-10, 10))
def test_of_a_sine_it_is_a_quarter_of_the_period(period, phase, size, zero):
    y = size * (zero + np.sin(2 * np.pi * TIME / period + phase))
    assert part_of_swing(y[:, None], H) == pytest.approx(period / 4, abs=2 * H)


@given(st.floats(*BETWEEN), st.integers(0, 2**31 - 1))
def test_noise_of_a_tenth_shortens_it_little(period, seed):
    y = np.sin(2 * np.pi * TIME / period) + 0.1 * np.random.default_rng(seed).normal(size=1000)
    assert part_of_swing(y[:, None], H) == pytest.approx(period / 4, rel=0.15)


def test_outputs_that_stand_still_do_not_count():
    y = np.column_stack([np.sin(2 * np.pi * TIME), np.ones((1000, 5))])
    assert part_of_swing(y, H) == part_of_swing(y[:, :1], H) == pytest.approx(0.25, abs=2 * H)


def test_it_stays_within_its_limits():
    still, fast = np.ones((1000, 1)), np.sin(100 * TIME)[:, None]
    slow = np.sin(0.3 * TIME)[:, None]
    assert part_of_swing(still, H) == part_of_swing(fast, H) == SHORTEST
    assert part_of_swing(slow, H) == LONGEST
    assert part_of_swing(slow[:100], H) == pytest.approx(0.1 * 100 * H)
    assert part_of_swing(slow, 0.1) == pytest.approx(FEWEST * 0.1)
    assert part_of_swing(slow[:8], H) == pytest.approx(2 * H)  # a quarter of the rows
