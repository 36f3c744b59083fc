import pickle
from dataclasses import FrozenInstanceError, replace
from itertools import pairwise

import numpy as np
import pytest
from example_logs import wave
from hypothesis import given
from hypothesis import strategies as st

from identification import Log
from identification.logs.joined import JoinedLog, join_logs, records_of


def test_nothing_in_it_can_be_changed():
    log = wave()
    for array in (log.time, log.inputs, log.outputs, log.extras["x"]):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1
    with pytest.raises(TypeError):
        log.extras["y"] = log.time
    with pytest.raises(FrozenInstanceError):
        log.notes = "changed"


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


def _with(**changes):
    return lambda: replace(wave(), **changes)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (_with(inputs=np.zeros((40, 3))), ["inputs", "(40, 3)", "(40, 2)"]),
        (_with(outputs=np.full((40, 2), np.nan)), ["outputs[0, 0]", "nan", "finite"]),
        (_with(time=np.zeros(40)), ["row 0", "39 rows after", "does not advance"]),
        (_with(time=-0.01 * np.arange(40)), ["row 1", "does not increase"]),
        (_with(time=np.arange(40.0) ** 2), ["not even", "resample"]),
        (_with(output_names=("angle_1", "angle_1")), ["angle_1", "twice"]),
        (_with(units={"angel_1": "rad"}), ["angel_1", "did you mean 'angle_1'"]),
        (_with(units={"angle_1": "deg"}), ["deg", "SI", "rad"]),
        (_with(hold="spline"), ["spline", "foh", "zoh"]),
        (_with(splits={"late": (5, 6)}), ["late", "[5, 6)", "[0, 0.39]"]),
        (
            _with(splits={"estimation": (0, 0.3), "validation": (0.2, 0.4)}),
            ["estimation", "validation", "overlap"],
        ),
        (lambda: wave().between(1, 2), ["0 samples", "[1, 2)", "[0, 0.39]"]),
        (lambda: wave().part("validate"), ["did you mean 'validation'", "estimation"]),
    ],
)
def test_bad_logs_are_refused_in_one_sentence(call, words, refusal):
    text = refusal(call)
    for word in words:
        assert word in text


def record(name, n, seed, **more):
    rng = np.random.default_rng(seed)
    more = {"input_names": ("u",), "output_names": ("y",), "units": {"u": "A", "y": "rad"}, **more}
    return Log(time=0.01 * np.arange(n) + seed, inputs=rng.standard_normal((n, 1)),
               outputs=rng.standard_normal((n, 1)), name=name, **more)  # fmt: skip


A, B, C = record("a", 30, 1), record("b", 41, 2), record("c", 25, 3)


def test_samples_follow_one_another():
    log = join_logs([A, B, C])
    assert isinstance(log, JoinedLog)
    assert len(log) == 96
    np.testing.assert_array_equal(log.inputs, np.concatenate([A.inputs, B.inputs, C.inputs]))
    assert [(k, part.name) for k, part in records_of(log)] == [(1, "a"), (2, "b"), (3, "c")]
    assert log.sampling_time == 0.01


@given(st.integers(0, 90), st.integers(3, 96))
def test_a_part_has_the_parts_of_its_records(first, length):
    log, last = join_logs([A, B, C]), min(96, first + length)
    edges = [0, 30, 71, 96]
    inside = [max(0, min(last, b) - max(first, a)) for a, b in pairwise(edges)]
    if last - first < 3 or any(0 < n < 3 for n in inside):
        return
    part = log.between(0.01 * first, 0.01 * last)
    np.testing.assert_array_equal(part.outputs, log.outputs[first:last])
    assert [len(r) for _, r in records_of(part)] == [n for n in inside if n]
    assert [k for k, _ in records_of(part)] == [k for k, n in enumerate(inside, 1) if n]


def test_a_record_that_is_cut_knows_how_late_it_begins():
    part = join_logs([A, B]).between(0.4, 0.71)
    ((number, late),) = records_of(part)
    assert number == 2
    assert late.begun == pytest.approx(0.1)


@pytest.mark.parametrize(
    ("other", "says"),
    [
        (record("d", 30, 9, input_names=("i",), units={}), "input names"),
        (record("d", 30, 9, hold="foh"), "hold"),
        (replace(record("d", 30, 9), time=0.02 * np.arange(30)), "sampling time"),
        (record("d", 30, 9, values={"mass": 2.0}), r"\[values\]"),
        (A, "log 'a' is given twice"),
        (replace(A, name="copy"), "logs 'a' and 'copy' hold the same samples"),
    ],
)
def test_what_is_no_other_record_of_the_robot_is_refused(refusal, other, says):
    said = refusal(join_logs, [A, other])
    assert says.replace("\\", "") in said.replace("_", " ") or says in said
