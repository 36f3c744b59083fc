"""Forces that are in no catalogue: their equations, their curves, and how answers are counted."""

import numpy as np
import pytest
from joint_page import section
from joint_statistics import is_drawn, is_drawn_over_its_cause, is_law_named, summary
from joint_worlds import slots as at
from joint_worlds.hidden import EVERY, UNLISTED
from joint_worlds.laws import unlisted
from joint_worlds.motion import ROBOTS
from joint_worlds.slots import plain_joints

from identification.effects.axes import Axis
from identification.effects.catalogue import joint_effects

AXES = tuple(Axis(name, "hinge", 1.0, 1.0, 1.0, duration=2.0) for name in "ab")
LAWS = [
    ({at.BUMP: 3.0, at.BUMP_PLACE: 0.2, at.BUMP_WIDTH: 0.5}, 3 * np.exp(-0.36)),
    ({at.STOP: 2.0, at.STOP_PLACE: 0.4}, -0.2),
    ({at.STOP: 2.0, at.STOP_PLACE: 0.6}, 0.0),
    ({at.FAST: 2.0, at.FAST_SPEED: 0.5}, 0.4),
    ({at.FAST: 2.0, at.FAST_SPEED: 0.8}, 0.0),
    ({at.BESIDE: 2.0, at.BESIDE_WAVES: 3.0, at.BESIDE_PHASE: 0.1}, 2 * np.sin(-0.8)),
    ({at.DRAG: 2.0}, -2.6),
    ({at.RIPPLE: 2.0, at.RIPPLE_WAVES: 2.0}, 1.4 * (1 + np.cos(1.0))),
]


@pytest.mark.parametrize(("numbers", "expected"), LAWS)
def test_a_force_is_what_its_equation_says(numbers, expected):
    (joint,) = plain_joints(1)
    for column, value in numbers.items():
        joint[column] = value
    assert unlisted(joint, 0.5, -0.7, -0.3, 1.3) == pytest.approx(expected, rel=1e-14)


def test_no_name_is_right_and_the_curve_that_draws_it_is_one_of_the_catalogue():
    arm = ROBOTS["two_link"]
    known = {e.name for e in joint_effects(AXES) if e.is_curve}
    for hidden in UNLISTED.values():
        assert hidden.names(arm) == ()
        drawn = {hidden.drawn_as(j) for j in (0, 1)}
        assert drawn == {""} if hidden.name == "ripple" else drawn <= known
    assert all(not EVERY[name].curve for name in EVERY if name not in UNLISTED)
    assert UNLISTED["drag"].drawn_as(0) == "curve_speed_behind"
    assert UNLISTED["beside"].drawn_as(1) == "curve_before"
    assert [n for n, h in UNLISTED.items() if not h.joints(ROBOTS["cart"])] == ["beside", "drag"]


def row(verdict, *named, curve="curve_speed"):
    return {
        "duration": 12.0,
        "truth": {"robot": "cart", "effect": "fast", "names": [], "joint": "rail", "size": 1.0,
                  "places": ["rail"], "curve": curve, "parameters": {}},
        "verdict": verdict, "errors": {"fit": 2.0, "discover": 1.0, "written": 3.0},
        "named": [{"name": n, "where": w, "one_of": False, "rivals": [],
                   "confidence": 0.85} for n, w in named],
        "processor_seconds": 1.0,
    }  # fmt: skip


def test_answers_are_counted_by_what_they_claim():
    right = row("unlisted effect", ("curve_speed", "joint rail"))
    other = row("unlisted effect", ("curve_load", "joint rail"))
    astray = row("unlisted effect", ("curve_speed", "joint hinge"))
    wrong = row("named", ("quadratic_friction", "joint rail"))
    beside = row("named", ("curve_speed", "joint rail"), ("cogging", "joint rail"))
    rows = [right, other, astray, wrong, beside, row("unknown effect"), row("nothing missing")]
    assert [is_law_named(r) for r in rows] == [False, False, False, True, True, False, False]
    assert [is_drawn(r) for r in rows] == [True, True, False, False, False, False, False]
    assert [is_drawn_over_its_cause(r) for r in rows] == [True] + 6 * [False]
    found = summary([*rows, row("unlisted effect", ("curve_speed", "joint rail"), curve="-")])
    counted = {key: (r["hits"], r["of"]) for key, r in found["unlisted"]["cart"].items()}
    assert counted == {
        "law_named": (2, 8), "law_refused": (0, 8), "drawn": (3, 8), "drawn_over_cause": (1, 7),
        "unknown": (1, 8), "drawn_or_unknown": (4, 8), "missed": (1, 8), "worse_than_fit": (0, 8),
    }  # fmt: skip
    assert found["all"]["right_first"]["of"] == 0  # they are no worlds with a name
    assert found["reliability"]["80 to 90 %"] == {
        **found["reliability"]["80 to 90 %"],
        "hits": 0,
        "of": 1,
    }
    assert "| a law is named, which is wrong, goal 4 % at most | 2 of 7 [8, 64 %] |" in section(
        rows
    )
