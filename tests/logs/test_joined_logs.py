"""Records one after the other: cut and joined, they are the same samples."""

import pickle
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from identification import Log
from identification.logs.joined import JoinedLog, join_logs, records_of


def record(name, n, seed, **more):
    rng = np.random.default_rng(seed)
    more = {"input_names": ("u",), "output_names": ("y",), "units": {"u": "A", "y": "rad"}, **more}
    return Log(time=0.01 * np.arange(n) + seed, inputs=rng.standard_normal((n, 1)),
               outputs=rng.standard_normal((n, 1)), name=name, **more)  # fmt: skip


A, B, C = record("a", 30, 1), record("b", 41, 2), record("c", 25, 3)


def test_one_record_stays_as_it_is():
    assert join_logs([A]) is A
    assert records_of(A) == ((1, A),)


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


def test_it_survives_a_journey_to_another_process():
    log = pickle.loads(pickle.dumps(join_logs([A, B])))
    assert isinstance(log, JoinedLog)
    assert [len(r) for r in log.records] == [30, 41]


@pytest.mark.parametrize(
    ("other", "says"),
    [
        (record("d", 30, 9, input_names=("i",), units={}), "input names"),
        (record("d", 30, 9, hold="foh"), "hold"),
        (replace(record("d", 30, 9), time=0.02 * np.arange(30)), "sampling time"),
        (record("d", 30, 9, values={"mass": 2.0}), r"\[values\]"),
        (A, "given twice"),
    ],
)
def test_what_is_no_other_record_of_the_robot_is_refused(refusal, other, says):
    said = refusal(join_logs, [A, other])
    assert says.replace("\\", "") in said.replace("_", " ") or says in said


def test_nothing_to_join_is_refused(refusal):
    assert "no log" in refusal(join_logs, [])
