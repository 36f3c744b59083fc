"""An answer is right if it names all that is hidden, each at its joint, and nothing else."""

import pytest
from robot_models import study
from robot_page import is_right, is_wrong, page
from robot_worlds import LISTED, UNLISTED, make


def row(effect, joint, verdict, *named, robot="leg"):
    """A row of an answer whose names are pairs of a law and its place, with rivals after them."""
    each = [
        {"name": name, "where": where, "confidence": 0.85, "rivals": [[*r, 0.1] for r in rivals]}
        for name, where, *rivals in named
    ]
    return {"robot": robot, "effect": effect, "joint": joint, "verdict": verdict, "named": each,
            "key": "a", "commit": "b"}  # fmt: skip


RUB, STIFF = ("coulomb_friction", "joint hip"), ("hardening", "joint knee")
CURVE = ("curve_position", "joint hip")


@pytest.mark.parametrize(("answer", "right", "wrong"), [
    (row("coulomb_friction", "hip", "named", RUB), True, False),
    (row("coulomb_friction", "knee", "named", RUB), False, True),
    (row("coulomb_friction", "knee", "named", RUB, robot="gripper"), True, False),
    (row("coulomb_friction", "hip", "named", RUB, STIFF), False, True),
    (row("coulomb_friction", "hip", "named", (*STIFF, RUB)), False, False),  # it is in the set
    (row("coulomb_friction", "hip", "unknown effect"), False, False),
    (row("coulomb_friction+hardening", "hip+knee", "named", STIFF, RUB), True, False),
    (row("coulomb_friction+hardening", "hip+knee", "named", RUB), False, False),
    (row("coulomb_friction+hardening", "knee+hip", "named", STIFF, RUB), False, True),
    (row("bump", "hip", "unlisted effect", CURVE), True, False),
    (row("bump", "hip", "named", RUB), False, True),
    (row("hardening+bump", "knee+hip", "named", STIFF, CURVE), True, False),
    (row("hardening+bump", "knee+hip", "named", STIFF, RUB), False, True),
    (row("hardening+bump", "knee+hip", "unknown effect"), True, False),
    (row("nothing", "", "nothing missing"), True, False),
    (row("nothing", "", "unknown effect"), False, False),
    (row("nothing", "", "named", RUB), False, True),
])  # fmt: skip
def test_answers(answer, right, wrong):
    assert (is_right(answer), is_wrong(answer)) == (right, wrong)


@pytest.mark.parametrize(("rough", "right"), [({}, False), ({"hip": 0.1}, True)])
def test_a_curve_may_draw_what_makes_a_robot_rough(rough, right):
    drawn = ("curve_position", "joint knee")
    answer = row("coulomb_friction", "hip", "named", RUB, drawn) | {"rough": rough}
    assert is_right(answer) == right
    assert not is_right(answer | {"named": answer["named"][1:]})


@pytest.mark.parametrize(("clocks", "right"), [
    ([0.0156, 0.0162], True), ([0.0156, 0.0212], False), ([], False),
])  # fmt: skip
def test_clocks_that_hardly_differ_may_be_a_delay(clocks, right):
    late = ("delay", "all inputs")
    answer = row("coulomb_friction", "hip", "named", RUB, late) | {"clocks": clocks}
    assert (is_right(answer), is_wrong(answer)) == (right, not right)


def test_the_page_tells_how_often_names_of_each_confidence_are_right():
    rows = [row("coulomb_friction", "hip", "named", RUB, STIFF, CURVE)]
    lines = [line for line in page(rows).splitlines() if line.startswith("| 0.8 to 0.9")]
    assert [line.split("|")[2].split("[")[0].strip() for line in lines] == ["1 of 2"]


def test_the_page_counts_rough_robots_by_themselves():
    rows = [
        row("coulomb_friction", "hip", "named", RUB),
        row("coulomb_friction", "hip", "named", STIFF) | {"rough": {"hip": 0.1}},
        row("nothing", "", "unlisted effect", CURVE) | {"rough": {"hip": 0.1}},
    ]
    cells = [line.split("|")[2:4] for line in page(rows).splitlines() if line.count("|") == 5]
    rates = {tuple(cell.split("[")[0].strip() for cell in both) for both in cells}
    assert {("1 of 1", "0 of 1"), ("0 of 1", "1 of 2"), ("-", "1 of 1")} <= rates


def test_a_world_of_two_effects_hides_two_that_its_robot_may_hide_and_is_made_again_alike(
    monkeypatch,
):
    monkeypatch.setattr("robot_motions.linkages.SECONDS", 2.0)
    world, motions = make("cart", "two_unlisted", 3)
    again, _ = make("cart", "two_unlisted", 3)
    assert world == again
    assert len(motions) == 2
    assert world.hidden[0].effect in LISTED
    assert world.hidden[1].effect in UNLISTED


@pytest.mark.long
def test_a_weak_motor_of_a_servo_is_named_and_without_the_pass_it_is_not():
    found, left = (study("leg", "voltage", 1603, w) for w in ((), ("limits_of_much_left",)))
    assert [n["name"] for n in found["named"]] == ["voltage_limit"]
    assert left["named"] == []
