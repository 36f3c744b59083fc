"""A log whose stamps lost digits has all its rows and its right step, or is refused."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from plain_logs import plain_log

from identification import InputError, read_log
from identification.logs.sampling import sampling_time
from identification.logs.sidecar import Sidecar
from identification.logs.stamps.coarse import evened_stamps
from identification.logs.stamps.fitting_steps import EXACT, judged
from identification.logs.table import Table

FORMS = ("%.4g", "%.5g", "%.6g", "%.7g", "%.8g", "%.1f", "%.2f", "%.3f", "%.4f")


def motion(n, step, noise=1e-3, seed=0):
    """A position that a log shows well, whatever its rate: five periods of two sines."""
    s = np.arange(n) / n
    return (np.sin(10 * np.pi * s) + 0.3 * np.cos(26 * np.pi * s)
            + noise * np.random.default_rng(seed).standard_normal(n))  # fmt: skip


def table(time, *columns, names=("time", "u", "y")):
    return Table(Path("log.csv"), names, np.column_stack([time, *columns]), lambda k: f"row {k}")


def put(csv, stamps, u, y, sidecar=""):
    rows = (f"{t},{a!r},{b!r}\n" for t, a, b in zip(stamps, u.tolist(), y.tolist(), strict=True))
    path = csv("time,u,y\n" + "".join(rows))
    path.with_suffix(".toml").write_text(sidecar)
    return path


def read(path):
    return read_log(path, ["u"], ["y"], lenient=True)


@st.composite
def rounded(draw):
    """Even stamps as they are printed, their sampling time, and an output."""
    n = draw(st.integers(100, 4000))
    step = draw(st.one_of(
        st.floats(-3.5, -0.5).map(lambda x: 10**x),
        st.sampled_from([30, 50, 60, 100, 125, 200, 300, 500]).map(lambda rate: 1 / rate),
    ))  # fmt: skip
    start = draw(st.sampled_from([0.0, 1.0, 99.0, 12345.0, 20000.005, 1e5, 1e6]))
    start += step * draw(st.floats(0, 1))
    form = draw(st.sampled_from(FORMS))
    stamps = [form % t for t in (start + step * np.arange(n)).tolist()]
    noise = draw(st.sampled_from([0.0, 1e-3]))
    return stamps, step, motion(n, step, noise, draw(st.integers(0, 999)))


@given(log=rounded())
def test_all_rows_and_the_step_or_a_refusal(tmp_path_factory, log):
    stamps, step, y = log
    time = np.array([float(t) for t in stamps])
    folder = tmp_path_factory.mktemp("log")
    path = put(lambda text: _written(folder, text), stamps, np.sign(y), y)
    assume(time[-1] > time[0])
    try:
        found = read(path)
    except InputError:
        return
    known = judged(time)
    if known.is_coarse and not known.steps:
        raise AssertionError("an even log has a sampling time that fits its stamps")
    steps = np.diff(time)
    if len(found) != len(time) or not np.array_equal(found.outputs[:, 0], y):
        # Rounding moved no row by more than a quarter of a step; or it made one step or two that
        # dropped samples make, too, and a sentence tells how many were made up.
        usual = np.median(steps)
        odd = int(np.sum(np.abs(steps - usual) > 0.25 * usual))
        assert not known.is_coarse or (odd <= 2 and steps.min() > 0)
        assert "were made up" in found.remarks[0]
        return
    # Stamps that are even as they are printed tell no more than their digits do.
    known_to = 4e-2 / len(time)
    if np.ptp(steps) <= 1e-9:
        known_to = known.quanta.max() / (time[-1] - time[0])
    assert found.sampling_time == pytest.approx(step, rel=max(EXACT, known_to))


def _written(folder, text):
    path = folder / "log.csv"
    path.write_text(text)
    return path


@given(log=rounded())
def test_a_declared_sampling_time_wins_where_it_is_the_right_one(tmp_path_factory, log):
    stamps, step, y = log
    time = np.array([float(t) for t in stamps])
    assume(time[-1] > time[0])
    sidecar = Sidecar(path=Path("log.toml"), sampling_time=step)
    found = evened_stamps(table(time, np.sign(y), y), ["y"], sidecar)
    np.testing.assert_array_equal(found.data[:, 1:], np.column_stack([np.sign(y), y]))
    assert sampling_time(found["time"]) == pytest.approx(step, rel=1e-9)
    assert found.remarks


def test_a_log_that_is_too_short_to_tell_its_step_is_told_what_to_write(csv, refusal):
    y = motion(120, 0.005)
    stamps = [f"{0.01 * (k // 2):.2f}" for k in range(120)]
    path = put(csv, stamps, np.sign(y), y)
    said = refusal(read, path)
    assert said.startswith("line 2 of")
    assert "the stamps 0 and 0 s" in said
    assert "60 rows have the stamp of the row before them and other values" in said
    low, high = judged(np.array([float(t) for t in stamps])).steps
    assert low < 0.005 < high
    assert f"each sampling time from {low:.6g} to {high:.6g} s fits all rows" in said
    assert "write sampling_time = ... [s] into" in said
    path.with_suffix(".toml").write_text("sampling_time = 0.005")
    assert read(path).sampling_time == 0.005


def test_a_clock_that_wanders_beside_coarse_stamps_is_refused(csv, refusal):
    n = 3000
    y, k = motion(n, 0.01), np.arange(n)
    stamps = [f"{t:.2f}" for t in 0.01 * k + 0.03 * np.sin(k / 200)]
    path = put(csv, stamps, np.sign(y), y)
    assert "no sampling time fits all rows" in refusal(read, path)
    path.with_suffix(".toml").write_text("sampling_time = 0.01")
    (said,) = read(path).remarks  # the user insists: what is lost is told
    time = np.array([float(t) for t in stamps])
    same = int(np.sum(np.diff(time) == 0))
    assert f"{same} rows have the stamp of another one, and the last of each counts" in said


@given(jitter=st.sampled_from([0.0, 3.5e-3, 4.9e-3]), seed=st.integers(0, 99))
def test_jitter_that_scatters_rounded_stamps_does_no_harm(jitter, seed):
    n = 3000
    y = motion(n, 0.01)
    late = np.random.default_rng(seed).uniform(-jitter, jitter, n)
    time = np.round(0.0025 + 0.01 * np.arange(n) + late, 2)
    whole = table(time, np.sign(y), y)
    found = evened_stamps(whole, ["y"], Sidecar(path=Path("log.toml")))
    np.testing.assert_array_equal(found["y"], y)
    assert sampling_time(found["time"]) == pytest.approx(0.01, rel=EXACT)
    assert bool(found.remarks) == bool(np.any(np.diff(time) == 0))


@given(
    dropped=st.lists(st.integers(5, 990), min_size=1, max_size=30, unique=True),
    every=st.sampled_from([0.01, 0.02, 0.005]),
)
def test_rows_that_are_missing_by_chance_are_gaps_and_no_digits(dropped, every):
    keep = np.delete(np.arange(1000), dropped)
    time = np.array([float(f"{every * k:.3f}") for k in keep])
    y = motion(1000, every)[keep]
    stamps = judged(time)
    assume(stamps.steps is None or len(dropped) <= 2)
    whole = table(time, np.sign(y), y)
    found = evened_stamps(whole, ["y"], Sidecar(path=Path("log.toml")))
    assert found is whole


@given(noise=st.sampled_from([1e-4, 1e-2]), seed=st.integers(0, 99))
def test_a_sensor_that_is_read_twice_with_one_stamp_is_no_log_of_twice_the_rate(noise, seed):
    n = 2000
    rng = np.random.default_rng(seed)
    y = np.repeat(motion(n, 0.01, 0.0), 2) + noise * rng.standard_normal(2 * n)
    whole = table(np.repeat(0.01 * np.arange(n), 2), np.sign(y), y)
    try:
        found = evened_stamps(whole, ["y"], Sidecar(path=Path("log.toml")))
    except InputError:  # so much noise that nothing is known
        assert noise > 1e-3
        return
    assert found is whole


@given(n=st.integers(3, 400), width=st.floats(0, 2), seed=st.integers(0, 9999))
def test_the_steps_that_fit_are_those_of_all_pairs_of_rows(n, width, seed):
    rng = np.random.default_rng(seed)
    time = np.maximum.accumulate(np.round(np.arange(n) + width * rng.uniform(-1, 1, n)))
    assume(time[-1] > time[0])
    known = judged(time)
    near = known.quanta / 2 + 1e-3 * known.mean
    i, j = np.triu_indices(n, 1)
    least = ((time[j] - near[j]) - (time[i] + near[i])) / (j - i)
    most = ((time[j] + near[j]) - (time[i] - near[i])) / (j - i)
    low, high = least.max(), most.min()
    if known.steps is None:
        assert low > high - 1e-9 or high <= 0 or low <= 0
    else:
        assert known.steps == (pytest.approx(low, rel=1e-9), pytest.approx(high, rel=1e-9))


def log_of(time):
    n = len(time)
    return plain_log(np.zeros((n, 0)), np.zeros((n, 1)), "", "q", time=time)


@st.composite
def stamps(draw):
    """Stamps as files have them: any rate and start, jitter, and a few printed digits."""
    n = draw(st.integers(6, 3000))
    step = 10 ** draw(st.floats(-5, 1))
    start = draw(st.sampled_from([0.0, 1.0, -3.0, 7.3, 1e3, 1.7e9, -1e6])) + step * draw(
        st.floats(0, 10)
    )
    jitter = step * 10 ** draw(st.floats(-6, -1.5))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    time = start + step * np.arange(n) + rng.uniform(-jitter, jitter, n)
    form = draw(st.sampled_from(["{:.4g}", "{:.7g}", "{:.9g}", "{:.3f}", "{:.6f}", "{!r}"]))
    return np.array([float(form.format(float(t))) for t in time])


@given(time=stamps(), data=st.data())
def test_any_cut_of_an_accepted_log_is_accepted(time, data):
    try:
        log = log_of(time)
    except InputError:
        assume(False)
    np.testing.assert_allclose(log.time, time, atol=0.03 * log.sampling_time)
    for _ in range(3):  # a cut of a cut, too
        first = data.draw(st.integers(0, len(log) - 3))
        last = data.draw(st.integers(first + 3, len(log)))
        h = log.sampling_time
        part = log.between(log.time[first], log.time[0] + h * last)
        floats = 4 * np.spacing(np.abs(log.time).max())
        assert part.sampling_time == pytest.approx(h, rel=1e-3, abs=floats)
        log = part
