"""Several records as one: the windows are those of each, and what differs is refused."""

from dataclasses import replace

import numpy as np
import pytest

from identification import InputError, Log
from identification.windows.window_error import joined
from identification.windows.windows import windows


def record(n, seed, step=0.01, hold="foh"):
    rng = np.random.default_rng(seed)
    time = step * np.arange(n)
    u, y = rng.standard_normal((n, 2)), rng.standard_normal((n, 1))
    return Log(
        time=time,
        inputs=u,
        outputs=y,
        input_names=("a", "b"),
        output_names=("x",),
        hold=hold,
        name=f"record {seed}",
    )


def test_windows_of_joined_records_are_those_of_each():
    logs = [record(n, n) for n in (300, 251, 57)]
    both, each = windows(joined(logs, 0.2), 0.2), [windows(log, 0.2) for log in logs]
    np.testing.assert_array_equal(both.outputs, np.concatenate([cut.outputs for cut in each]))
    np.testing.assert_array_equal(both.inputs, np.concatenate([cut.inputs for cut in each]))


def test_one_record_is_itself_less_the_rest():
    log = record(57, 1)
    one = joined([log], 0.2)
    np.testing.assert_array_equal(one.outputs, log.outputs[:40])
    assert one.hold == log.hold


@pytest.mark.parametrize(
    ("second", "said"),
    [
        (record(100, 2, step=0.02), "sampling time"),
        (record(100, 2, hold="zoh"), "hold"),
        (replace(record(100, 2), output_names=("z",)), "columns"),
        (record(15, 2), "windows of 0.2 s do not fit"),
    ],
)
def test_records_that_do_not_belong_together_are_refused(second, said):
    with pytest.raises(InputError, match=said):
        joined([record(100, 1), second], 0.2)


def test_no_record_is_refused():
    with pytest.raises(InputError, match="no records"):
        joined([], 0.2)
