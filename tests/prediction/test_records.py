"""What may be fitted together, and what then confirms."""

import numpy as np
import pytest
from records_cases import record

from identification.prediction.records import as_records


def test_without_records_that_confirm_the_second_half_of_each_log_does():
    logs = [record(1), record(2, samples=400)]
    made = as_records(logs)
    assert [r.role for r in made] == ["fit", "fit", "confirm", "confirm"]
    for log, first, second in zip(logs, made[:2], made[2:], strict=True):
        np.testing.assert_array_equal(
            np.concatenate([first.log.outputs, second.log.outputs]), log.outputs
        )


def test_records_that_confirm_leave_the_others_whole():
    a, b = record(1), record(2)
    made = as_records([a], [b], {b.name: {"J": 1.0}})
    assert [(r.log, r.role, dict(r.values)) for r in made] == [
        (a, "fit", {}), (b, "confirm", {"J": 1.0}),
    ]  # fmt: skip


def test_what_cannot_be_one_robot_is_refused(refusal):
    a = record(1)
    assert "given twice" in refusal(as_records, [a], [a])
    assert "no log" in refusal(as_records, [])
    other = record(2)
    foreign = type(other)(
        time=other.time, inputs=other.inputs, outputs=other.outputs, input_names=("drive",),
        output_names=("elbow",),
    )  # fmt: skip
    assert "elbow" in refusal(as_records, [a], [foreign])


def test_what_a_log_says_of_itself_holds_for_its_record():
    from dataclasses import replace

    a, b = replace(record(1), values={"J": 1.0, "d": 2.0}), replace(record(2), name="record 1")
    made = as_records([a, b], values={a.name: {"d": 3.0}})
    assert [dict(r.values) for r in made] == 2 * [{"J": 1.0, "d": 3.0}, {"d": 3.0}]
    assert [r.log.name for r in made[:2]] == ["record 1 [estimation]", "record 1 (2) [estimation]"]


@pytest.mark.parametrize("hold", ["zoh", "foh"])
def test_one_hold_is_for_all_records(hold, refusal):
    from dataclasses import replace

    a, b = replace(record(1), hold=hold), replace(record(2), hold="zoh")
    if hold == "zoh":
        assert len(as_records([a], [b])) == 2
    else:
        assert "hold" in refusal(as_records, [a], [b])
