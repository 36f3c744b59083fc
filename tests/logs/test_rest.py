"""A record at rest is told beside records that move, and none that moves is."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from plain_logs import plain_log

from identification.logs.rest import is_at_rest, motion_share

T = 0.01 * np.arange(1000)
SWING = np.sin(2 * np.pi * 0.7 * T)


def log(y, noise=0.0, seed=0, unit="rad", step=0.0):
    y = np.asarray(y)
    y = y[:, None] if y.ndim == 1 else y
    y = y + noise * np.random.default_rng(seed).standard_normal(y.shape)
    if step:
        y = step * np.round(y / step)
    names = " ".join(f"y{k}" for k in range(y.shape[1]))
    made = plain_log(np.zeros((len(y), 1)), y, "u", names, time=T[: len(y)])
    return replace(made, units=dict.fromkeys(made.output_names, unit))


@pytest.mark.parametrize("noise", [0.0, 1e-4, 1e-2])
@pytest.mark.parametrize("step", [0.0, 2e-3])
@pytest.mark.parametrize("unit", [1.0, 1e-3, 57.3])
def test_a_robot_that_stands_still_is_at_rest_in_any_unit_and_noise(noise, step, unit):
    moving = log(unit * SWING, unit * noise, step=unit * step)
    for still in (0.0, 0.3):
        at = log(unit * (still + 0 * T), unit * noise, seed=1, step=unit * step)
        assert is_at_rest([moving], at)
        assert not is_at_rest([at], moving)


MOTIONS = {
    "small": 0.05 * SWING,
    "slow": 0.1 * T,  # a creep, at a fiftieth of the top rate
    "fast": 0.02 * np.sin(2 * np.pi * 20 * T),  # a vibration, of a fiftieth of the travel
    "once": np.where(T < 0.2, SWING, SWING[20]),
    "falling": SWING * np.exp(-T),
    "another joint": np.column_stack([0 * T, 0.2 * SWING]),
}


@pytest.mark.parametrize("motion", MOTIONS)
@pytest.mark.parametrize("noise", [0.0, 1e-3])
def test_a_record_that_moves_is_not(motion, noise):
    moved = MOTIONS[motion]
    fitted = log(np.column_stack([SWING, SWING]) if moved.ndim > 1 else SWING, noise)
    assert not is_at_rest([fitted], log(moved, noise, seed=1))


@given(st.floats(0.05, 20), st.integers(0, 5), st.sampled_from([0.0, 1e-3, 1e-2]))
def test_the_share_is_that_of_the_motion(amplitude, seed, noise):
    rng = np.random.default_rng(seed)
    rough = np.repeat(rng.uniform(-1, 1, 51), 20)[: len(T)]
    smooth = np.convolve(rough, np.ones(40) / 40, "same")
    share = motion_share([log(smooth, noise, seed)], log(amplitude * smooth, noise, seed + 9))
    assert share == pytest.approx(amplitude, rel=0.15)


def test_a_rate_that_stays_what_it_is_moves_its_joint():
    turning, still = log(1 + 0 * T, unit="rad/s"), log(0 * T, unit="rad/s")
    fitted = log(SWING, unit="rad/s")
    assert not is_at_rest([fitted], turning)
    assert is_at_rest([fitted], still)
    nameless = replace(turning, units={})  # which may be a rate
    assert not is_at_rest([replace(fitted, units={})], nameless)


def test_an_output_that_is_noise_everywhere_does_not_count():
    rng = np.random.default_rng(3)
    fitted = log(np.column_stack([SWING, 1e-2 * rng.standard_normal(len(T))]), 1e-4)
    still = log(np.column_stack([0 * T, 1e-2 * rng.standard_normal(len(T))]), 1e-4, 1)
    assert is_at_rest([fitted], still)


def test_noise_alone_says_nothing():
    noise = [log(0 * T, 1e-2, seed) for seed in (1, 2)]
    assert not is_at_rest(noise[:1], noise[1])
    assert not is_at_rest([], noise[0])
