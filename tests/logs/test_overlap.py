"""Two logs that hold the same samples are told from two that only look alike."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from records_cases import record

from identification import InputError
from identification.logs.joined import ROW, share_samples
from identification.prediction.records import as_records


def noisy(seed, samples=200, noise=1e-4):
    log = record(seed, samples=samples)
    more = noise * np.random.default_rng(100 + seed).standard_normal(log.outputs.shape)
    return replace(log, outputs=log.outputs + more)


def part(log, first, last, name="part"):
    rows = slice(first, last)
    return replace(
        log, time=log.time[rows], inputs=log.inputs[rows], outputs=log.outputs[rows], name=name
    )  # fmt: skip


@given(st.integers(0, 150), st.integers(ROW, 50))
def test_any_part_of_a_log_shares_its_samples(first, count):
    log = noisy(1)
    assert share_samples(log, part(log, first, first + count))
    assert share_samples(part(log, first, first + count), log)


@given(st.integers(0, 100))
def test_the_same_motion_measured_again_shares_none(seed):
    again = replace(
        noisy(1), outputs=noisy(1).outputs + 1e-9 * np.random.default_rng(seed).random((200, 1))
    )
    assert not share_samples(noisy(1), again)


def test_parts_that_do_not_overlap_share_none_and_few_samples_tell_nothing():
    log = noisy(1)
    assert not share_samples(part(log, 0, 100), part(log, 100, 200))
    assert not share_samples(log, part(log, 0, ROW - 1))


def test_robots_at_rest_are_all_alike():
    still = replace(noisy(1), inputs=np.zeros((200, 1)), outputs=np.zeros((200, 1)))
    assert not share_samples(still, replace(still, name="other"))


def test_a_record_that_confirms_with_a_part_of_what_was_fitted_is_refused():
    log, other = noisy(1), noisy(2)
    with pytest.raises(InputError, match="'part' and 'record 1' hold the same samples"):
        as_records([log, other], [part(log, 20, 120)])
    assert len(as_records([part(log, 0, 100)], [part(log, 100, 200)])) == 2
