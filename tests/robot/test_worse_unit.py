"""Outputs of one unit that are predicted worse are named where those of another are not."""

import pytest

from identification.robot.record_error import AS_WRITTEN, FITTED, Confirmation
from identification.robot.worse_unit import worse_unit


def confirmation(before, after):
    return Confirmation("log", 1.0, 0.9, "", (AS_WRITTEN, FITTED), before, after)


def test_the_worse_outputs_are_named_beside_the_others():
    (said,) = worse_unit([confirmation({"m": 1.9, "rad": 0.4}, {"m": 0.5, "rad": 0.7})])
    assert "the angles (mean square +206 %) of what was not fitted worse than the values" in said
    assert "began, and not the slides (mean square -93 %). This may be chance" in said
    assert "before you rely on what it predicts of angles." in said


def test_records_count_together():
    one = confirmation({"m": 1.0, "rad": 1.0}, {"m": 0.5, "rad": 1.2})
    other = confirmation({"m": 1.0, "rad": 2.0}, {"m": 0.5, "rad": 1.0})
    assert worse_unit([one])
    assert not worse_unit([one, other])


@pytest.mark.parametrize(
    "after",
    [{"m": 0.9, "rad": 0.9}, {"m": 0.9, "rad": 1.04}, {"m": 1.2, "rad": 1.2}],
    ids=["both better", "within noise", "both worse"],
)
def test_nothing_is_said_where_no_unit_is_given_up_for_another(after):
    assert worse_unit([confirmation({"m": 1.0, "rad": 1.0}, after)]) == []


def test_outputs_of_one_unit_are_told_by_their_own_sentence():
    assert worse_unit([confirmation({"rad": 1.0}, {"rad": 2.0})]) == []
