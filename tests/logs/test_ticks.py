"""Ticks of a clock that are no multiple of the last digit, and declared steps against stamps."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from test_coarse import motion, put, read

from identification import read_log
from identification.logs.stamps.fitting_steps import quanta_of

CLOCKS = [  # the tick of the clock [s], its first stamp [s], how it is printed, the sampling time
    (1 / 64, 0.0, "%.4f", 0.01),
    (1 / 64, 1000.0, "%.4f", 0.004),
    (1 / 60, 0.0, "%.4f", 0.01),
    (1 / 60, 0.0, "%.17g", 0.008),
    (1 / 64, 2e5, "%.9g", 0.01),  # the spacing of 32-bit floats
    (1 / 32, 3e5, "%.9g", 0.01),
    (1 / 32, 3e5, "%.9g", 0.0125),
    (1 / 75, 12.0, "%.3f", 0.0021),
]


def stamps_of(tick, start, form, step, n):
    return [form % t for t in (tick * np.floor((start + 0.3 * step + step * np.arange(n)) / tick))]


@pytest.mark.parametrize("clock", CLOCKS)
@pytest.mark.parametrize("declared", [False, True])
def test_rows_between_the_ticks_of_a_clock_are_kept_and_told(csv, clock, declared):
    n, step = 4000, clock[-1]
    y = motion(n, step)
    u = motion(n, step, seed=1)
    sidecar = f"sampling_time = {step}" if declared else ""
    log = read(put(csv, stamps_of(*clock, n), u, y, sidecar))
    np.testing.assert_array_equal(log.outputs[:, 0], y)
    np.testing.assert_array_equal(log.inputs[:, 0], u)
    assert log.sampling_time == pytest.approx(step, rel=1e-9)
    (said,) = log.remarks
    assert "all its rows were kept" in said


@pytest.mark.parametrize("clock", CLOCKS[:4])
def test_noise_that_hides_the_motion_is_overruled_by_trust(csv, refusal, clock):
    n, step = 900, clock[-1]
    y = 1e-3 * np.random.default_rng(0).standard_normal(n)
    path = put(csv, stamps_of(*clock, n), motion(n, step), y)
    assert "write sampling_time = ... [s] into" in refusal(read, path)
    log = read_log(path, ["u"], ["y"], lenient=True, trust_rows=True)
    np.testing.assert_array_equal(log.outputs[:, 0], y)
    assert log.sampling_time == pytest.approx(step, rel=1e-9)


@given(
    tick=st.floats(0.002, 0.1),
    digits=st.integers(3, 9),
    ratio=st.floats(0.1, 0.9),
    start=st.floats(0, 1e4),
)
def test_the_quantum_is_the_tick_give_or_take_a_digit(tick, digits, ratio, start):
    digit = 10.0**-digits
    if tick < 3 * digit:
        return
    stamps = stamps_of(tick, start, f"%.{digits}f", ratio * tick, 600)
    quanta = quanta_of(np.array([float(t) for t in stamps]))
    assert quanta.max() == pytest.approx(tick, abs=1.6 * digit)
    assert quanta.max() >= tick - 0.1 * digit


@pytest.mark.parametrize(("step", "form", "missing"), [
    (0.005, "%.2f", 4), (0.002, "%.2f", 11),
])  # fmt: skip
def test_a_gap_between_coarse_stamps_does_not_make_a_right_step_wrong(
    csv, refusal, step, form, missing
):
    n, at = 1500, 700
    keep = np.delete(np.arange(n), range(at, at + missing))
    digit = 10.0 ** -int(form[2])
    stamps = [form % (digit * np.floor(step * k / digit + 1e-6)) for k in keep.tolist()]
    y = motion(n, step)[keep]
    path = put(csv, stamps, np.sign(y), y, f"sampling_time = {step}")
    said = refusal(read, path)
    assert said.startswith(f"line {at + 1} of {path}: about {missing} rows are missing behind it")
    assert f"sampling_time = {step:g} in {path.with_suffix('.toml')} fits the rows up to" in said
    assert "save the rows before and behind as two logs" in said
    assert "correct sampling_time" not in said
    for part in (slice(0, at), slice(at, None)):  # what the message says to do
        log = read(put(csv, stamps[part], np.sign(y[part]), y[part], f"sampling_time = {step}"))
        np.testing.assert_array_equal(log.outputs[:, 0], y[part])


@pytest.mark.parametrize(("step", "wrong"), [
    (0.01, 0.02), (0.01, 0.005), (1 / 30, 0.03),
])  # fmt: skip
@pytest.mark.parametrize("form", ["%.3f", "%.17g"])
@pytest.mark.parametrize("empty", [0, 3])
def test_an_even_log_contradicts_a_wrong_sampling_time(csv, refusal, step, wrong, form, empty):
    if form == "%.3f" and round(1e3 * step, 9) % 1:
        form = "%.5f"
    n = 400
    stamps = [form % (7.0 + step * k) for k in range(n)]
    y = motion(n, step)
    path = put(csv, stamps, np.sign(y), y, f"sampling_time = {wrong}")
    lines = path.read_text().splitlines()
    for k in range(50, 50 + 90 * empty, 90):
        lines[k] = lines[k].rsplit(",", 1)[0] + ","
    path.write_text("\n".join(lines))
    said = refusal(read, path)
    assert f"{path.with_suffix('.toml')} says sampling_time = {wrong:.6g}" in said
    assert f"even with a step of {step:.6g} s; correct sampling_time or leave it out" in said
    assert ("thinned by every" in said) == (wrong > step)
    path.with_suffix(".toml").write_text("")
    assert read(path).sampling_time == pytest.approx(step, rel=1e-6)


@given(
    jitter=st.floats(0.05, 0.45),
    grid=st.sampled_from([0.01, 0.02, 0.0101]),
    seed=st.integers(0, 99),
)
def test_a_log_that_is_uneven_is_put_on_the_grid_that_is_declared(
    tmp_path_factory, jitter, grid, seed
):
    n, folder = 400, tmp_path_factory.mktemp("log")
    late = 0.01 * np.random.default_rng(seed).uniform(-jitter, jitter, n)
    y = motion(n, 0.01)

    def csv(text):
        (folder / "log.csv").write_text(text)
        return folder / "log.csv"

    stamps = [f"{1.0 + t:.6f}" for t in (0.01 * np.arange(n) + late).tolist()]
    log = read(put(csv, stamps, np.sign(y), y, f"sampling_time = {grid}"))
    assert log.sampling_time == pytest.approx(grid)
    assert "is uneven in time" in log.remarks[0]
