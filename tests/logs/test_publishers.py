"""Rows of a second publisher are refused; right logs with stamps or zeros like these are not."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from identification import read_log
from identification.logs.stamps.publishers import refuse_interleaved, refuse_second_publisher
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


@pytest.mark.parametrize("after", [range(4, 890, 7), range(3, 890), [100, 101, 250, 411, 620, 800]])
@pytest.mark.parametrize("shift", [0.0, 0.4 * H])
def test_zeros_of_a_second_publisher(refusal, after, shift):
    columns = with_rows(motion(centre=1.3), [*after], shift, (0.0, 0.0))
    said = refusal(judge, *columns)
    assert ("two rows with one stamp" in said) == (shift == 0.0)
    if shift:
        assert "is zero in all columns, as of a second publisher" in said
        assert "drop such rows, or trust it" in said
        assert ("each 8th row" in said) == (after == range(4, 890, 7))


def test_zeros_in_place_of_samples(refusal):
    k = 5
    t, u, q = motion()
    u[::k] = q[::k] = 0.0
    assert f"each {k}th row" in refusal(judge, t, u, q)


@pytest.mark.parametrize("later", [0.0, 1e-6])
def test_two_publishers_that_always_differ(refusal, later):
    t, u, q = motion()
    twice = [np.repeat(x, 2) for x in (t, u, q)]
    twice[2][1::2] *= -1
    twice[0][1::2] += later
    assert "two rows with one stamp" in refusal(judge, *twice)


@pytest.mark.parametrize("is_first", [True, False])
def test_one_row_that_contradicts_another_of_its_stamp(refusal, is_first):
    """It is farther away than the joint moves in a row, and nearer than it moves in four."""
    t, u, q = motion()
    step, k = np.abs(np.diff(q)).max(), 431
    t, u, q = (np.insert(x, k, x[k]) for x in (t, u, q))
    q[k + (not is_first)] += 3.0 * step
    said = refusal(judge, t, u, q)
    assert f"row {k + 1}: there are two rows with one stamp, {t[k]:.9g} s" in said
    assert f"moves by {step:.2g} at most from row to row elsewhere" in said
    q[k : k + 2] = q[k - 1] + np.array([0.9, 1.1]) * step  # both are where it may be
    judge(t, u, q)


@given(
    seed=st.integers(0, 999),
    noise=st.sampled_from([0.0, 1e-4, 1e-2]),
    encoder=st.sampled_from([0.0, 2e-3, 0.05]),
    pairs=st.integers(1, 200),
    lost=st.integers(0, 60),
)
def test_rows_that_waited_for_one_another_are_right(seed, noise, encoder, pairs, lost):
    """Some rows have the stamp of the next one, and rows are lost, also between two of a stamp."""
    rng = np.random.default_rng(seed)
    t, u, q = motion(noise=noise, seed=seed)
    if encoder:
        q = encoder * np.round(q / encoder)
    kept = np.sort(rng.permutation(len(t))[lost:])
    first = rng.integers(0, len(t) - 40)
    kept = kept[(kept < first) | (kept > first + lost // 2)]
    t, u, q = t[kept], u[kept], q[kept]
    late = rng.permutation(len(t) - 1)[:pairs]
    stamps = t.copy()
    stamps[late] = t[late + 1]
    judge(np.maximum.accumulate(stamps), u, q)


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


@pytest.mark.parametrize("hold", [1, 5])
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


STEP = 0.01


def judge_clock(time, u, q):
    table = Table("log.csv", ("time", "u", "q"), np.column_stack([time, u, q]), "row {}".format)
    refuse_interleaved(table, ["u"], ["q"], ", or trust it")


def course(kind, n, rng):
    t = STEP * np.arange(n)
    return {
        "noise": lambda: rng.standard_normal(n),
        "bang-bang": lambda: rng.choice([-1.3, 1.3], n),
        "prbs": lambda: np.repeat(rng.choice([-0.7, 0.9], n), rng.integers(2, 15, n))[:n],
        "steps": lambda: np.repeat(rng.uniform(-2, 2, n), rng.integers(20, 70, n))[:n],
        "chirp": lambda: np.sin((1 + t) * t),
        "switched": lambda: np.where(np.arange(n) % 2, np.sin(2.1 * t), 0.0),
        "zero": lambda: np.zeros(n),
    }[kind]()


def course_of_cart(u, rng, noise=1e-4):
    """The place of a cart on a spring that is held back, shape (n,) [m]."""
    q, v, out = 0.2, 0.0, []
    for force in u:
        out.append(q)
        v += STEP * (force - 40 * q - 3 * v) / 1.7
        q += STEP * v
    return np.array(out) + noise * rng.standard_normal(len(u))


KINDS = ("noise", "bang-bang", "prbs", "steps", "chirp", "switched", "zero")


def second(rate, late, fresh, kind, seed=0, n=900, value=0.0):
    """A log among whose rows those of a second publisher stand."""
    rng = np.random.default_rng(seed)
    t = STEP * np.arange(n)
    u = course(kind, n, rng)
    q = course_of_cart(u, rng)
    other = np.arange(0, t[-1] - STEP, 1 / rate) + late * STEP
    last = np.searchsorted(t, other, side="right") - 1
    seen = np.interp(other, t, q) + 1e-4 * rng.standard_normal(len(other)) if fresh else q[last]
    time = np.append(t, other)
    order = np.argsort(time, kind="stable")
    columns = time, np.append(u, np.full(len(other), value)), np.append(q, seen)
    return [x[order] for x in columns]


@pytest.mark.parametrize("kind", KINDS[:5])
@pytest.mark.parametrize(("rate", "late", "fresh"), [
    (20, 0.5, False), (33, 0.1, False), (20, 0.3, True),
])  # fmt: skip
def test_rows_of_another_clock_are_refused(refusal, kind, rate, late, fresh):
    said = refusal(judge_clock, *second(rate, late, fresh, kind))
    assert f"that come on a clock of their own, every {1 / rate:.3g} s, as of a second" in said
    assert "u is 0 in it" in said
    assert "keep the rows of one publisher, or trust it" in said


@given(
    seed=st.integers(0, 999),
    kind=st.sampled_from(KINDS),
    encoder=st.sampled_from([0.0, 1e-4, 2e-3, 0.03]),
    jitter=st.sampled_from([0.0, 1e-3, 0.1, 0.3, 0.45]),
    rows=st.sampled_from(["all", "each fifth dropped", "some dropped", "two rates", "more"]),
)
def test_right_logs_of_one_clock_are_never_refused(seed, kind, encoder, jitter, rows):
    rng = np.random.default_rng(seed)
    n = 900
    u = course(kind, n, rng)
    q = course_of_cart(u, rng)
    if encoder:
        q = encoder * np.round(q / encoder)
    t = STEP * (np.arange(n) + jitter * rng.uniform(-1, 1, n))
    keep = {"each fifth dropped": np.arange(n) % 5 != 4, "some dropped": rng.random(n) > 0.1}
    at = keep.get(rows, np.ones(n, dtype=bool))
    if rows == "two rates":
        t[400:] = t[400] + (t[400:] - t[400]) / 2
    t, u, q = t[at], u[at], q[at]
    if rows == "more":  # each fifth sample is followed by one more that lets the command be
        after = np.arange(0, len(t) - 1, 5)
        t, q = (np.insert(x, after + 1, (x[after] + x[after + 1]) / 2) for x in (t, q))
        u = np.insert(u, after + 1, u[after])
    judge_clock(np.sort(t), u, q)


@pytest.mark.parametrize("kind", [k for k in KINDS if k != "switched"])
@pytest.mark.parametrize("times", [2, 3])
def test_a_sensor_slower_than_the_commands_is_right(kind, times):
    rng = np.random.default_rng(times)
    u = course(kind, 900, rng)
    judge_clock(STEP * np.arange(900), u, np.repeat(course_of_cart(u, rng)[::times], times)[:900])


def test_a_file_is_refused_and_rows_may_be_trusted(csv, refusal):
    columns = second(20, 0.3, False, "chirp")
    rows = [f"{a:.6f},{b:.6g},{c:.9g}\n" for a, b, c in zip(*columns, strict=True)]
    path = csv("time,u,q\n" + "".join(rows))
    said = refusal(read_log, path, ["u"], ["q"], lenient=True)
    assert f"of {path} is one of" in said
    assert len(read_log(path, ["u"], ["q"], lenient=True, trust_rows=True)) > 800
