"""Channels that arrived unevenly: lines stay lines, and a hole is not papered over."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from identification.logs.resampling import on_a_grid


@given(st.integers(0, 2**31), st.floats(0.01, 0.2))
def test_straight_lines_are_kept_to_the_last_digits(seed, step):
    rng = np.random.default_rng(seed)
    time = np.sort(rng.uniform(0, 10, 400))
    a, b = 2 * time - 1, 5 - time
    odd = rng.random(400) < 0.5
    channels = {"a": np.where(odd, a, np.nan), "b": np.where(odd, np.nan, b)}
    t, out = on_a_grid(time, channels, step, 10.0)
    begin = max(time[odd].min(), time[~odd].min())
    np.testing.assert_allclose(out["a"], 2 * (t + begin) - 1, atol=1e-9)
    np.testing.assert_allclose(out["b"], 5 - (t + begin), atol=1e-9)
    np.testing.assert_allclose(np.diff(t), step, rtol=1e-9)
    assert t[-1] + begin <= min(time[odd].max(), time[~odd].max()) + 1e-9


def test_an_even_log_is_left_as_it_is():
    time = 0.1 * np.arange(50)
    x = np.sin(time)
    t, out = on_a_grid(time, {"x": x}, 0.1, 0.15)
    np.testing.assert_allclose(t, time, atol=1e-12)
    np.testing.assert_allclose(out["x"], x, atol=1e-12)


def test_what_cannot_be_bridged_is_named(refusal):
    time = np.r_[0:1:0.1, 3:4:0.1]
    x = np.ones(20)
    assert "no sample for 2.1 s from 0.9 s" in refusal(on_a_grid, time, {"x": x}, 0.1, 0.5)
    empty = np.full(20, np.nan)
    assert "'y' has 0 samples" in refusal(on_a_grid, time, {"x": x, "y": empty}, 0.1, 5.0)
    late = np.where(time > 3.75, 1.0, np.nan)
    assert "leave one out" in refusal(on_a_grid, time, {"x": x, "z": late}, 0.1, 5.0)
    assert "positive step" in refusal(on_a_grid, time, {"x": x}, 0.0, 5.0)
