"""Uneven logs are put on an even grid, and say so; a hole is not papered over."""

import numpy as np
import pytest

from identification import InputError, read_log
from identification.logs.resampling import even_out

RNG = np.random.default_rng(4)


def signals(t):
    return {"u": np.where(np.sin(9 * t) > 0, 1.0, -1.0), "y": np.sin(2 * t)}


def even(t, channels, **options):
    return even_out("log", t, channels, ["u"], **{"hold": "zoh", **options})


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


def test_an_even_log_is_left_as_it_is():
    t = 0.01 * np.arange(300)
    found = even(t, signals(t))
    for name, x in signals(t).items():
        np.testing.assert_allclose(found.channels[name], x, atol=1e-12)
    assert "and 0 of 300 samples" in found.sentence


def test_a_slope_that_is_nearly_zero_is_one_that_is_zero():
    t = 0.01 * np.delete(np.arange(60), 35)
    x = signals(t)
    flat = {**x, "y": x["y"] * (t > 0.02)}
    nearly = {**x, "y": np.where(t == 0.01, 1e-320, flat["y"])}
    found, wanted = (even(t, each).channels["y"] for each in (nearly, flat))
    np.testing.assert_allclose(found, wanted, rtol=1e-12, atol=1e-300)


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


def test_every_gap_is_told_once_though_two_channels_have_it():
    t = 0.01 * np.arange(2000)
    keep = ~np.isin(np.arange(2000), [300, 301, 302, 1500, 1501])
    both = {"y": np.sin(40 * t), "z": np.cos(40 * t)}
    found = even(t[keep], {n: x[keep] for n, x in both.items()})
    assert found.gaps == (pytest.approx((2.99, 3.03)), pytest.approx((14.99, 15.02)))
    assert "2 gaps are too wide to be bridged (the widest no" in found.sentence


def test_a_gap_of_a_joint_that_only_flickers_by_a_step_of_its_encoder_is_bridged():
    # Most differences are zero, so that the noise floor is zero too.
    t = 0.01 * np.arange(2000)
    flicker = 1e-3 * (RNG.random(2000) < 0.02)
    keep = ~np.isin(np.arange(2000), [700, 701])
    assert not even(t[keep], {"y": np.sin(t)[keep], "z": 0.3 + flicker[keep]}).gaps


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


def test_an_input_that_stays_away_is_refused_though_the_outputs_go_on(refusal):
    t = 0.01 * np.arange(1000)
    u = np.where((t > 3) & (t < 3.6), np.nan, np.sign(np.sin(5 * t)))
    said = refusal(even_out, "log", t, {"u": u, "q": np.sin(t)}, ["u"], "zoh")
    assert "no u for 0.6" in said


def test_a_pause_of_an_input_that_comes_with_every_sample_is_a_gap():
    t = 0.01 * np.arange(4000)
    u = np.where((t > 3) & (t < 3.3), np.nan, np.sign(np.sin(5 * t)))
    found = even(t, {"u": u, "q": np.sin(t)})
    assert found.gaps == (pytest.approx((3.0, 3.3), abs=1e-6),)
    assert "usually comes with every sample" in found.sentence
