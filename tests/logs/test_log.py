from __future__ import annotations

import pickle
from dataclasses import FrozenInstanceError, replace

import numpy as np
import pytest
from example_logs import wave
from hypothesis import given
from hypothesis import strategies as st

from identification import Log, halves


def test_knows_its_sampling():
    log = wave(n=1000, step=0.01)
    assert len(log) == 1000
    assert log.sampling_time == 0.01
    assert log.duration == pytest.approx(9.99)


@pytest.mark.parametrize("digits", [6, 7, 8])
@pytest.mark.parametrize("rate", [50, 100, 187, 333])
def test_printed_digits_do_not_spoil_the_sampling_time(digits, rate):
    time = np.arange(20 * rate) / rate
    printed = np.array([float(f"{t:.{digits}g}") for t in time])
    log = Log(
        time=printed,
        inputs=np.zeros((len(time), 0)),
        outputs=np.zeros((len(time), 1)),
        input_names=(),
        output_names=("q",),
    )
    assert log.sampling_time == pytest.approx(1 / rate, rel=1e-5)


def test_nothing_in_it_can_be_changed():
    log = wave()
    for array in (log.time, log.inputs, log.outputs, log.extras["x"]):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1
    with pytest.raises(TypeError):
        log.extras["y"] = log.time
    with pytest.raises(FrozenInstanceError):
        log.notes = "changed"


def test_later_changes_of_its_sources_do_not_reach_it():
    time = 0.01 * np.arange(10)
    log = Log(
        time=time,
        inputs=np.zeros((10, 0)),
        outputs=np.zeros((10, 1)),
        input_names=(),
        output_names=("q",),
    )
    time[3] = 7
    assert log.time[3] == pytest.approx(0.03)


def test_travels_to_another_process():
    log = replace(wave(), splits={"all": (0, 1)}, notes="n")
    copy = pickle.loads(pickle.dumps(log))
    assert np.array_equal(copy.outputs, log.outputs)
    assert copy.splits == log.splits
    assert copy.units == log.units


@given(n=st.integers(6, 300), cut=st.floats(0, 1), step=st.sampled_from([0.001, 0.01, 1 / 187]))
def test_slices_join_to_the_whole(n, cut, step):
    log = wave(n, step)
    middle = log.time[3] + cut * (log.time[-3] - log.time[3])
    first, second = log.between(-np.inf, middle), log.between(middle, np.inf)
    assert np.array_equal(np.concatenate([first.time, second.time]), log.time)
    assert np.array_equal(np.concatenate([first.inputs, second.inputs]), log.inputs)
    assert np.array_equal(np.concatenate([first.outputs, second.outputs]), log.outputs)
    assert np.array_equal(np.concatenate([first.extras["x"], second.extras["x"]]), log.extras["x"])


@given(n=st.integers(6, 300))
def test_halves_join_to_the_whole(n):
    log = wave(n)
    first, second = (log.part(name) for name in halves(log))
    assert np.array_equal(np.concatenate([first.time, second.time]), log.time)
    assert abs(len(first) - len(second)) <= 1


def test_a_bound_belongs_to_the_sample_that_is_there():
    log = wave(n=1000)
    assert log.between(3.0, 7.0).time[0] == pytest.approx(3.0)
    assert log.between(3.0, 7.0).time[-1] == pytest.approx(6.99)


def test_a_part_is_a_log_with_a_name():
    log = replace(wave(n=100), splits={"calm": (0.2, 0.6)}, name="run")
    part = log.part("calm")
    assert (part.name, len(part), dict(part.splits)) == ("run [calm]", 40, {})
    assert part.units == log.units


def test_columns_have_names():
    log = wave()
    assert list(log.columns) == ["current_1", "current_2", "angle_1", "angle_2", "x"]
    assert np.array_equal(log.columns["angle_2"], log.outputs[:, 1])


def _with(**changes):
    return lambda: replace(wave(), **changes)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (_with(inputs=np.zeros((40, 3))), ["inputs", "(40, 3)", "(40, 2)"]),
        (_with(inputs=np.zeros((39, 2))), ["inputs", "(39, 2)"]),
        (_with(outputs=np.full((40, 2), np.nan)), ["outputs[0, 0]", "nan", "finite"]),
        (_with(time=np.zeros((40, 1))), ["time", "(40, 1)"]),
        (_with(time=np.zeros(40)), ["row 1", "does not increase"]),
        (_with(time=np.arange(40.0) ** 2), ["not even", "resample"]),
        (_with(time=np.arange(-20.0, 20) * 8.9e306), ["not even"]),
        (_with(output_names=("angle_1", "angle_1")), ["angle_1", "twice"]),
        (_with(output_names=("angle_1", "time")), ["'time'", "cannot name"]),
        (_with(output_names=("angle_1", "a,b")), ["'a,b'", "commas"]),
        (_with(units={"angel_1": "rad"}), ["angel_1", "did you mean 'angle_1'"]),
        (_with(units={"angle_1": "deg"}), ["deg", "SI", "rad"]),
        (_with(hold="spline"), ["spline", "foh", "zoh"]),
        (_with(splits={"late": (5, 6)}), ["late", "[5, 6)", "[0, 0.39]"]),
        (_with(splits={"odd": (0, np.nan)}), ["odd", "nan"]),
        (
            _with(splits={"estimation": (0, 0.3), "validation": (0.2, 0.4)}),
            ["estimation", "validation", "overlap"],
        ),
        (lambda: wave(n=2), ["at least 3", "2"]),
        (lambda: wave().between(1, 2), ["0 samples", "[1, 2)", "[0, 0.39]"]),
        (lambda: wave().part("validate"), ["did you mean 'validation'", "estimation"]),
        (
            lambda: Log(
                time=np.arange(9.0),
                inputs=np.zeros((9, 0)),
                outputs=np.zeros((9, 0)),
                input_names=(),
                output_names=(),
            ),
            ["no columns"],
        ),
    ],
)
def test_bad_logs_are_refused_in_one_sentence(call, words, refusal):
    text = refusal(call)
    for word in words:
        assert word in text
