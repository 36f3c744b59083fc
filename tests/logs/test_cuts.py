"""A judgement of a whole log holds for its parts: what is even stays even, however it is cut."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from identification import InputError, Log, halves


def log_of(time):
    n = len(time)
    return Log(time=time, inputs=np.zeros((n, 0)), outputs=np.zeros((n, 1)), input_names=(),
               output_names=("q",))  # fmt: skip


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


@pytest.mark.parametrize(("rate", "digits", "jitter"), [(200, 7, 3e-6), (250, 6, 2e-5)])
def test_halves_of_a_log_whose_stamps_lose_a_digit_on_the_way(rate, digits, jitter):
    rng = np.random.default_rng(3)
    t = np.arange(22 * rate) / rate
    time = [float(f"{x:.{digits}g}") for x in t + rng.uniform(-jitter, jitter, len(t))]
    log = log_of(np.array(time))
    for part in halves(log):
        assert log.part(part).sampling_time == pytest.approx(1 / rate, rel=1e-4)


@given(n=st.integers(3, 2000), step=st.floats(1e-6, 1e3), start=st.floats(-1e6, 1e6))
def test_stamps_that_are_a_grid_stay_as_they_are(n, step, start):
    assume(step > 100 * np.spacing(abs(start) + n * step))
    time = start + step * np.arange(n)
    np.testing.assert_array_equal(log_of(time).time, time)
