"""Rows that an even log has lost take their inputs with them, and are gaps where this matters."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from identification.logs.gaps import Channel, find_lost_rows
from identification.logs.resampling import even_out

H = 0.004
N = 1200


def course(kind, rng):
    return {
        "noise": lambda: rng.standard_normal(N),
        "bang-bang": lambda: rng.choice([-2.0, 2.0], N),
        "chirp": lambda: np.sin((3 + 2 * H * np.arange(N)) * H * np.arange(N)),
        "steps": lambda: np.repeat(rng.uniform(-1, 1, N), rng.integers(20, 60, N))[:N],
        "slow": lambda: np.sin(0.3 * H * np.arange(N)),
        "zero": lambda: np.zeros(N),
    }[kind]()


def lost(t, u):
    return find_lost_rows(Channel("u", t, u), t)


@pytest.mark.parametrize("n", [3, 5, 10, 20])
@pytest.mark.parametrize("kind", ["noise", "bang-bang", "chirp"])
def test_each_lost_row_is_a_gap_where_the_input_changes_all_the_time(kind, n):
    rng = np.random.default_rng(n)
    keep = np.arange(N) % n != n - 1
    t = 1.5 + H * (np.arange(N) + 0.02 * rng.random(N))
    gaps = lost(t[keep], course(kind, rng)[keep])
    assert [gap.begin for gap in gaps] == t[np.arange(n - 2, N - 1, n)[: len(gaps)]].tolist()
    assert len(gaps) == (N - 1) // n
    assert f"{len(gaps)} of {N - (N % n == 0)} rows are missing where u may have" in gaps[0].why


@pytest.mark.parametrize("n", [3, 5, 10, 20])
def test_of_steps_only_the_rows_are_gaps_in_which_a_step_may_hide(n):
    u = course("steps", np.random.default_rng(n))
    t, keep = H * np.arange(N), np.arange(N) % n != n - 1
    found = {round(gap.begin / H) + 1 for gap in lost(t[keep], u[keep])}
    gone = np.flatnonzero(~keep)[: -1 if not keep[-1] else None]
    changed = {int(k) for k in gone if u[k - 1] != u[k + 1]}
    assert found == (changed if len(changed) > 1e-3 * N else set())
    assert {int(k) for k in gone if u[k] != u[k - 1]} <= changed


@pytest.mark.parametrize("kind", ["slow", "zero"])
def test_an_input_that_is_the_same_on_both_sides_is_known(kind):
    u, t = course(kind, np.random.default_rng(1)), H * np.arange(N)
    keep = np.arange(N) % 7 != 3
    assert not lost(t[keep], u[keep])


@given(
    seed=st.integers(0, 999),
    kind=st.sampled_from(["noise", "bang-bang", "chirp", "steps", "zero"]),
    stamps=st.sampled_from(["even", "jitter", "random", "another rate", "one lost"]),
    jitter=st.sampled_from([0.0, 1e-3, 0.1, 0.3, 0.45]),
)
def test_right_logs_have_no_such_gaps(seed, kind, stamps, jitter):
    rng = np.random.default_rng(seed)
    u, t = course(kind, rng), H * np.arange(N)
    if stamps == "another rate":
        t[700:] = t[700] + 2 * (t[700:] - t[700])
    if stamps == "jitter":
        t = np.sort(t + jitter * H * rng.uniform(-1, 1, N))
    if stamps == "random":
        t = np.sort(rng.uniform(0, N * H, N))
    keep = np.arange(N) != (seed + 1 if stamps == "one lost" else N)
    assert not lost(t[keep], u[keep])


def test_the_grid_has_the_gaps_and_its_sentence_tells_them():
    rng = np.random.default_rng(5)
    t, keep = H * np.arange(N), np.arange(N) % 20 != 19
    channels = {"u": course("noise", rng)[keep], "q": np.sin(t)[keep]}
    found = even_out("log", t[keep], channels, ["u"], "zoh")
    assert len(found.gaps) == N // 20 - 1
    assert "59 gaps are too wide to be bridged" in found.sentence
    assert "59 of 1199 rows are missing where u may have changed" in found.sentence
    assert not even_out("log", t[keep], {"q": channels["q"]}, ["u"], "zoh").gaps
