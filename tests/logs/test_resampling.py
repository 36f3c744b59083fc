"""Uneven logs are put on an even grid, and say so; a hole is not papered over."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from identification import InputError, read_log
from identification.logs.stamps.gaps import Channel, find_lost_rows
from identification.logs.stamps.resampling import even_out, on_a_grid
from identification.logs.table import Table

RNG = np.random.default_rng(4)


def signals(t):
    return {"u": np.where(np.sin(9 * t) > 0, 1.0, -1.0), "y": np.sin(2 * t)}


def even(t, channels, step=None):
    columns = np.column_stack([t, *channels.values()])
    table = Table(Path("log.csv"), ("time", *channels), columns, str)
    found, gaps = even_out(table, ["u"], "zoh", step)
    on_grid = {name: found[name] for name in channels}
    (said,) = found.remarks
    return SimpleNamespace(time=found["time"], channels=on_grid, sentence=said, gaps=gaps)


def test_jitter_is_taken_out_and_the_rate_is_that_of_the_median_interval():
    t = 0.01 * np.arange(800) + RNG.uniform(-3e-3, 3e-3, 800)
    found = even(t, signals(t))
    np.testing.assert_allclose(np.diff(found.time), 0.01, rtol=1e-9)
    # A parabola through neighbours errs by at most max|y'''| h³.
    np.testing.assert_allclose(found.channels["y"], np.sin(2 * found.time), atol=8 * 0.016**2)
    assert "put on a grid of 0.01 s (100 Hz)" in found.sentence


def test_a_held_input_does_the_same_work_on_the_grid():
    t = np.sort(RNG.uniform(0, 8, 900))
    u = RNG.standard_normal(900)
    found = even(t, {"u": u, "y": np.sin(t)}, step=0.01)
    end = found.time[-1] + 0.01
    stamps = np.append(np.clip(t, found.time[0], end), end)
    work = float(np.sum(u * np.diff(stamps)))
    assert 0.01 * found.channels["u"].sum() == pytest.approx(work, abs=0.01 * np.abs(u).max())


def test_drops_repeated_stamps_and_interleaved_channels():
    t = 0.005 * np.arange(2000)
    x = signals(t)
    odd = np.arange(2000) % 2 == 1
    x = {"u": np.where(odd, x["u"], np.nan), "y": np.where(odd, np.nan, x["y"])}
    keep = np.delete(np.arange(2000), [500, 501, 502, 503, 1200])
    twice = np.sort(np.append(keep, [700, 900]))
    found = even(t[twice], {n: c[twice] for n, c in x.items()})
    assert "grid of 0.01 s" in found.sentence
    assert "largest gap is 0.03 s, from 2.49 s" in found.sentence
    assert np.abs(found.channels["y"] - np.sin(2 * found.time)).max() < 2e-3


def test_a_gap_is_bridged_only_where_the_log_says_that_this_is_harmless(refusal):
    t = 0.01 * np.arange(1000)
    slow, fast = {"y": np.sin(t)}, {"y": np.sin(20 * t)}
    keep = (t < 4) | (t > 4.2)
    assert not even(t[keep], {n: x[keep] for n, x in slow.items()}).gaps
    found = even(t[keep], {n: x[keep] for n, x in fast.items()})
    assert found.gaps == (pytest.approx((3.99, 4.21)),)
    assert "1 gap is too wide to be bridged (no y for 0.22 s from 3.99 s" in found.sentence
    assert "windows of a horizon that touch a gap are left out" in found.sentence
    wide = (t < 3) | (t > 6)
    text = refusal(even, t[wide], {n: x[wide] for n, x in slow.items()})
    assert "no y for 3.02 s from 2.99 s, more than 5 % of it, and says nothing" in text
    assert "as two logs" in text


def test_time_that_goes_back_and_channels_that_do_not_overlap_are_refused(refusal):
    t = 0.01 * np.arange(100)
    assert "goes back after 0.99 s" in refusal(even, np.tile(t, 2), {"y": np.tile(t, 2)})
    late = np.where(t > 0.975, 1.0, np.nan)
    assert "has 2 samples and needs 3" in refusal(even, t, {"y": t, "x": late})
    late[-2] = np.nan
    assert "has 1 sample and needs 3" in refusal(even, t, {"y": t, "x": late})


@pytest.mark.parametrize("last", [5.0, 1e9, 1e300])
def test_a_grid_that_is_nearly_all_made_up_is_refused(refusal, last):
    """A stamp in ns among stamps in s, or a log that is written twice, 1 µs apart."""
    t = 1e-4 * np.arange(100)
    assert "nearly all were made up" in refusal(even, np.append(t, last), {"y": np.append(t, 0)})


def test_a_file_is_read_with_its_cells_missing_and_its_unused_columns_left_out(csv):
    rows = [f"{0.01 * k:.2f},{k % 2 or ''},state {k},{0.1 * k},{k}\n" for k in range(40)]
    del rows[20]
    path = csv("time,u,mode,y,y\n".replace("y,y", "y,z") + "".join(rows))
    log = read_log(path, ["u"], ["y"], lenient=True)
    np.testing.assert_allclose(log.outputs[:, 0], 10 * log.time, atol=1e-9)
    assert log.sampling_time == pytest.approx(0.01)
    assert len(log.remarks) == 1
    with pytest.raises(InputError, match="unknown column z"):
        read_log(csv("time,u,y,z\n0,1,2,3\n1,1,2,3\n2,1,2,3\n"), ["u"], ["y"])
    with pytest.raises(InputError, match=r"lacks column y .is y its column yy.*it has time, u, yy"):
        read_log(csv("time,u,yy\n0,1,2\n1,1,2\n2,1,2\n"), ["u"], ["y"], lenient=True)


@pytest.mark.parametrize("where", ["columns = {}", "[log]\ncolumns = {}"])
def test_a_file_without_a_header_is_read_by_a_list_of_columns(csv, refusal, where):
    path = csv("".join(f"{0.01 * k:.2f},7,{k},{2 * k}\n" for k in range(20)))
    text = refusal(read_log, path, ["u"], ["y"])
    assert "list their names in order as columns in" in text
    names = '["time", "skip", "u", "y"]'
    path.with_suffix(".toml").write_text(where.format(names))
    log = read_log(path, ["u"], ["y"])
    np.testing.assert_array_equal(log.outputs, 2 * log.inputs)
    path.with_suffix(".toml").write_text(where.format('["time", "u", "y"]'))
    assert "has 4 columns, and 3 are named" in refusal(read_log, path, ["u"], ["y"])
    path.with_suffix(".toml").unlink()
    said = {"columns": ["time", "skip", "u", "y"]}
    assert len(read_log(path, ["u"], ["y"], said=said)) == 20


def test_a_pause_of_an_input_that_comes_with_every_sample_is_a_gap():
    t = 0.01 * np.arange(4000)
    u = np.where((t > 3) & (t < 3.3), np.nan, np.sign(np.sin(5 * t)))
    found = even(t, {"u": u, "q": np.sin(t)})
    assert found.gaps == (pytest.approx((3.0, 3.3), abs=1e-6),)
    assert "usually comes with every sample" in found.sentence


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


@pytest.mark.parametrize("n", [5, 20])
@pytest.mark.parametrize("kind", ["noise", "bang-bang", "chirp"])
def test_each_lost_row_is_a_gap_where_the_input_changes_all_the_time(kind, n):
    rng = np.random.default_rng(n)
    keep = np.arange(N) % n != n - 1
    t = 1.5 + H * (np.arange(N) + 0.02 * rng.random(N))
    gaps = lost(t[keep], course(kind, rng)[keep])
    assert [gap.begin for gap in gaps] == t[np.arange(n - 2, N - 1, n)[: len(gaps)]].tolist()
    assert len(gaps) == (N - 1) // n
    assert f"{len(gaps)} of {N - (N % n == 0)} rows are missing where u may have" in gaps[0].why


@pytest.mark.parametrize("n", [5, 20])
def test_of_steps_only_the_rows_are_gaps_in_which_a_step_may_hide(n):
    u = course("steps", np.random.default_rng(n))
    t, keep = H * np.arange(N), np.arange(N) % n != n - 1
    found = {round(gap.begin / H) + 1 for gap in lost(t[keep], u[keep])}
    gone = np.flatnonzero(~keep)[: -1 if not keep[-1] else None]
    changed = {int(k) for k in gone if u[k - 1] != u[k + 1]}
    assert found == (changed if len(changed) > 1e-3 * N else set())
    assert {int(k) for k in gone if u[k] != u[k - 1]} <= changed


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
