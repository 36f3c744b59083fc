"""Rows of a second publisher are refused; right logs with stamps or zeros like these are not."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from identification.logs.publishers import refuse_second_publisher
from identification.logs.table import Table

UNITS = {"u": "N", "q": "m", "v": "m/s"}
H = 0.004


def judge(time, u, *outputs, units=UNITS):
    names = ("time", "u", "q", "v")[: 2 + len(outputs)]
    table = Table("log.csv", names, np.column_stack([time, u, *outputs]), lambda k: f"row {k}")
    refuse_second_publisher(table, ["u"], names[2:], units, ", or trust it")


def motion(n=900, noise=1e-4, centre=0.0, seed=0):
    rng = np.random.default_rng(seed)
    t = H * np.arange(n)
    q = centre + 0.4 * np.sin(2.3 * t) + 0.1 * np.sin(9 * t) + noise * rng.standard_normal(n)
    return t, np.sign(np.sin(5 * t)), q


def with_rows(columns, after, shift, values):
    """Columns with rows of other values behind some rows, so much later."""
    out = []
    for k, x in enumerate(columns):
        other = x[after] + shift if k == 0 else np.full(len(after), values[k - 1])
        out.append(np.insert(x, np.asarray(after) + 1, other))
    return out


@pytest.mark.parametrize("centre", [0.0, 1.3])
@pytest.mark.parametrize("after", [range(4, 890, 7), range(3, 890), [100, 101, 250, 411, 620, 800]])
@pytest.mark.parametrize("shift", [0.0, 0.4 * H])
def test_zeros_of_a_second_publisher(refusal, centre, after, shift):
    columns = with_rows(motion(centre=centre), [*after], shift, (0.0, 0.0))
    said = refusal(judge, *columns)
    assert ("two rows with one stamp" in said) == (shift == 0.0)
    if shift:
        assert "is zero in all columns, as of a second publisher" in said
        assert "drop such rows, or trust it" in said
        assert ("each 8th row" in said) == (after == range(4, 890, 7))


def test_the_row_that_is_told_is_one_of_the_second_publisher(refusal):
    t, u, q = motion(centre=2.0)
    said = refusal(judge, *with_rows((t, u, q), [300], 0.3 * H, (0.0, 0.0)))
    assert said.startswith("row 301 is zero")
    said = refusal(judge, *with_rows((t, u, q), [300], 0.0, (0.7, -0.4)))
    assert said.startswith("row 301: there are two rows with one stamp, 1.2 s")
    assert f"q is {q[300]:.4g} and -0.4 m" in said


@pytest.mark.parametrize("k", [2, 5, 9])
def test_zeros_in_place_of_samples(refusal, k):
    t, u, q = motion()
    u[::k] = q[::k] = 0.0
    assert f"each {k}th row" in refusal(judge, t, u, q)


@pytest.mark.parametrize("later", [0.0, 1e-17, 1e-6])
def test_two_publishers_that_always_differ(refusal, later):
    t, u, q = motion()
    twice = [np.repeat(x, 2) for x in (t, u, q)]
    twice[2][1::2] *= -1
    twice[0][1::2] += later
    assert "two rows with one stamp" in refusal(judge, *twice)


@given(
    seed=st.integers(0, 999),
    noise=st.sampled_from([0.0, 1e-4, 1e-2]),
    encoder=st.sampled_from([0.0, 2e-3, 0.05, 0.3]),
    coarse=st.integers(1, 12),
    burst=st.integers(0, 60),
    rest=st.integers(0, 300),
)
def test_right_logs_are_never_refused(seed, noise, encoder, coarse, burst, rest):
    rng = np.random.default_rng(seed)
    t, u, q = motion(noise=noise, seed=seed)
    if encoder:
        q = encoder * np.round(q / encoder)
    stamps = H * coarse * np.floor(t / H / coarse)  # a clock that is too slow for its samples
    first = rng.integers(0, len(t) - 61)
    stamps[first : first + burst] = stamps[first + burst]  # rows that waited for one another
    u = np.where(rng.random(len(u)) < 0.3, 0.0, u)
    q -= q[rest]
    q[:rest] = u[:rest] = 0.0  # at rest at zero
    v = np.where(rng.random(len(q)) < 0.3, 0.0, 5.0)  # a rate may do what it likes
    judge(np.maximum.accumulate(stamps), u, q, v)


@pytest.mark.parametrize("hold", [1, 2, 5])
@pytest.mark.parametrize("levels", [(0.0, 0.5), (0.0, 0.5, -0.5)])
def test_a_servo_that_steps_to_zero_within_a_sample_is_right(hold, levels):
    rng = np.random.default_rng(hold)
    u = np.repeat(rng.choice(levels, 600 // hold), hold)
    t = H * np.arange(len(u)) + 0.1 * H * rng.random(len(u))
    judge(t, u, u * (1 + 1e-4 * rng.standard_normal(len(u))))


def test_commands_and_channels_that_share_a_stamp_are_right():
    t, u, q = motion()
    # A step of a command is written as its two values at one time.
    steps = np.flatnonzero(np.diff(u)) + 1
    before = np.insert(u, steps, u[steps - 1])
    judge(np.insert(t, steps, t[steps]), before, np.insert(q, steps, q[steps]))
    # Each device writes rows of its own.
    odd = np.arange(len(t)) % 2 == 1
    u, q = np.where(odd, u, np.nan), np.where(odd, np.nan, q)
    judge(t - H * odd, u, q, np.where(odd, 0.0, np.nan))


def test_a_sensor_and_a_command_that_are_always_zero_are_right():
    t, _, q = motion()
    judge(t, 0 * t, 0 * q, 0 * q)
    judge(t, 0 * t, np.where(np.abs(q) < 0.05, 0.0, q))
