"""Rows of a second publisher at stamps of its clock are refused; right logs like these are not."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from identification import read_log
from identification.logs.publishers import refuse_interleaved
from identification.logs.table import Table

H = 0.01


def judge(time, u, q):
    table = Table("log.csv", ("time", "u", "q"), np.column_stack([time, u, q]), "row {}".format)
    refuse_interleaved(table, ["u"], ["q"], ", or trust it")


def course(kind, n, rng):
    t = H * np.arange(n)
    return {
        "noise": lambda: rng.standard_normal(n),
        "bang-bang": lambda: rng.choice([-1.3, 1.3], n),
        "prbs": lambda: np.repeat(rng.choice([-0.7, 0.9], n), rng.integers(2, 15, n))[:n],
        "steps": lambda: np.repeat(rng.uniform(-2, 2, n), rng.integers(20, 70, n))[:n],
        "chirp": lambda: np.sin((1 + t) * t),
        "switched": lambda: np.where(np.arange(n) % 2, np.sin(2.1 * t), 0.0),
        "zero": lambda: np.zeros(n),
    }[kind]()


def motion(u, rng, noise=1e-4):
    """The place of a cart on a spring that is held back, shape (n,) [m]."""
    q, v, out = 0.2, 0.0, []
    for force in u:
        out.append(q)
        v += H * (force - 40 * q - 3 * v) / 1.7
        q += H * v
    return np.array(out) + noise * rng.standard_normal(len(u))


KINDS = ("noise", "bang-bang", "prbs", "steps", "chirp", "switched", "zero")


def second(rate, late, fresh, kind, seed=0, n=900, value=0.0):
    """A log among whose rows those of a second publisher stand."""
    rng = np.random.default_rng(seed)
    t = H * np.arange(n)
    u = course(kind, n, rng)
    q = motion(u, rng)
    other = np.arange(0, t[-1] - H, 1 / rate) + late * H
    last = np.searchsorted(t, other, side="right") - 1
    seen = np.interp(other, t, q) + 1e-4 * rng.standard_normal(len(other)) if fresh else q[last]
    time = np.append(t, other)
    order = np.argsort(time, kind="stable")
    columns = time, np.append(u, np.full(len(other), value)), np.append(q, seen)
    return [x[order] for x in columns]


@pytest.mark.parametrize("kind", KINDS[:5])
@pytest.mark.parametrize(
    ("rate", "late", "fresh"),
    [(20, 0.3, False), (20, 0.5, False), (100, 0.5, False), (97, 0.1, False), (33, 0.1, False),
     (20, 0.3, True), (100, 0.3, True)],
)  # fmt: skip
def test_rows_of_another_clock_are_refused(refusal, kind, rate, late, fresh):
    said = refusal(judge, *second(rate, late, fresh, kind))
    assert f"that come on a clock of their own, every {1 / rate:.3g} s, as of a second" in said
    assert "u is 0 in it" in said
    assert "keep the rows of one publisher, or trust it" in said


def test_another_course_of_a_second_publisher_is_refused(refusal):
    t, u, q = second(20, 0.3, False, "prbs", value=np.nan)
    u = np.where(np.isnan(u), 57.3 * np.roll(u, 1), u)
    assert "the outputs repeat the row before to the last digit" in refusal(judge, t, u, q)


@given(
    seed=st.integers(0, 999),
    kind=st.sampled_from(KINDS),
    encoder=st.sampled_from([0.0, 1e-4, 2e-3, 0.03]),
    jitter=st.sampled_from([0.0, 1e-3, 0.1, 0.3, 0.45]),
    rows=st.sampled_from(["all", "each fifth dropped", "some dropped", "two rates", "more"]),
)
def test_right_logs_are_never_refused(seed, kind, encoder, jitter, rows):
    rng = np.random.default_rng(seed)
    n = 900
    u = course(kind, n, rng)
    q = motion(u, rng)
    if encoder:
        q = encoder * np.round(q / encoder)
    t = H * (np.arange(n) + jitter * rng.uniform(-1, 1, n))
    keep = {"each fifth dropped": np.arange(n) % 5 != 4, "some dropped": rng.random(n) > 0.1}
    at = keep.get(rows, np.ones(n, dtype=bool))
    if rows == "two rates":
        t[400:] = t[400] + (t[400:] - t[400]) / 2
    t, u, q = t[at], u[at], q[at]
    if rows == "more":  # each fifth sample is followed by one more that lets the command be
        after = np.arange(0, len(t) - 1, 5)
        t, q = (np.insert(x, after + 1, (x[after] + x[after + 1]) / 2) for x in (t, q))
        u = np.insert(u, after + 1, u[after])
    judge(np.sort(t), u, q)


@pytest.mark.parametrize("kind", [k for k in KINDS if k != "switched"])
@pytest.mark.parametrize("times", [2, 3])
def test_a_sensor_slower_than_the_commands_is_right(kind, times):
    rng = np.random.default_rng(times)
    u = course(kind, 900, rng)
    judge(H * np.arange(900), u, np.repeat(motion(u, rng)[::times], times)[:900])


def test_a_file_is_refused_and_rows_may_be_trusted(csv, refusal):
    columns = second(20, 0.3, False, "chirp")
    rows = [f"{a:.6f},{b:.6g},{c:.9g}\n" for a, b, c in zip(*columns, strict=True)]
    path = csv("time,u,q\n" + "".join(rows))
    said = refusal(read_log, path, ["u"], ["q"], lenient=True)
    assert f"of {path} is one of" in said
    assert len(read_log(path, ["u"], ["q"], lenient=True, trust_rows=True)) > 800
