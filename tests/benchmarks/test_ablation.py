"""A pass is judged by the worlds that only one of two searches answers right."""

import argparse

import ablation
import pytest
from scipy.stats import binom


def row(effect, names, curve=""):
    named = [{"name": n, "one_of": False, "rivals": []} for n in names]
    truth = {"effect": effect, "names": [effect], "parameters": {}, "joint": "j1", "size": 1.0,
             "curve": curve}  # fmt: skip
    verdict = "named" if names else "nothing missing"
    return {"truth": truth, "verdict": verdict, "named": named}


@pytest.mark.parametrize(("answer", "good", "false"), [
    (row("nothing", []), True, False), (row("nothing", ["delay"]), False, True),
    (row("delay", ["delay"]), True, False), (row("delay", ["lag"]), False, True),
    (row("delay", []), False, False),
    (row("tide", ["lag"], curve="curve_time"), False, True),
    (row("tide", ["curve_time"], curve="curve_time"), True, False),
    (row("tide", [], curve="curve_time"), False, False),
    ({**row("tide", [], curve="curve_time"), "verdict": "unknown effect"}, True, False),
])  # fmt: skip
def test_silence_a_right_name_and_what_is_called_unknown_or_drawn_are_right(answer, good, false):
    assert (ablation.is_good(answer), ablation.is_false(answer)) == (good, false)


def world(is_good, others):
    def short(good):
        return {"good": good, "false": not good, "verdict": "named", "named": [["x", str(good)]]}

    changed = {name: short(good) for name, good in others.items() if good != is_good}
    seconds = {"": 10.0} | {name: 5.0 if name in changed else 0.0 for name in others}
    return {"key": "k", "commit": "new", "truth": {"robot": "leg"}, "whole": short(is_good),
            "changed": changed, "seconds": seconds}  # fmt: skip


def test_only_worlds_that_one_search_alone_answers_right_count():
    rows = [world(True, {"add_set": True, "drop_places": True})] * 5
    rows += [world(True, {"add_set": False, "drop_places": True})] * 6
    rows += [world(False, {"add_set": True, "drop_places": False})]
    told = [[c.strip() for c in line.strip("|").split("|")] for line in ablation.lines(rows)]
    assert [cells[0] for cells in told] == ["`add_set`", "`drop_places`"]
    assert told[0][1:5] == ["12", "7", "6", "1"]
    assert float(told[0][5]) == pytest.approx(2 * binom.cdf(1, 7, 0.5), rel=0.05)
    assert told[0][6:] == ["1, 6", "0.29"]
    assert told[1][1:] == ["12", "0", "0", "0", "1", "1, 1", "0.00"]
    assert "It answers 11 of 12 worlds right (leg 12). " in " ".join(ablation.section(rows).split())


def test_every_pass_and_both_values_of_an_option_are_asked_beside_the_whole_search():
    asked = ablation.variants(["add_set"], ["min_fall", "max_refits"])
    assert [*asked] == ["", "add_set", "min_fall = 0.015", "min_fall = 0.045", "max_refits = 1",
                        "max_refits = 4"]  # fmt: skip
    assert asked["add_set"].without == ("add_set",)
    assert asked["max_refits = 4"].max_refits == 4


def test_every_robot_hides_every_effect_once_before_any_twice():
    given = argparse.Namespace(
        passes=["add_set"], options=[], seed=3, count=2, worlds=["leg", "pendulum"], rough=False
    )
    keys = [*ablation.tasks(given)]
    half = len(keys) // 2
    assert {k.rpartition("/")[2] for k in keys[:half]} == {"3"}
    assert {k.rpartition("/")[0] for k in keys[:half]} == {
        k.rpartition("/")[0] for k in keys[half:]
    }
    assert keys[:2] == ["leg/nothing/3", "pendulum/nothing/3"]


def test_worlds_that_are_rough_are_of_robots_that_can_be():
    given = argparse.Namespace(
        passes=["add_set"], options=[], seed=3, count=1, worlds=["leg", "pendulum"], rough=True
    )
    assert {key.split("/")[0] for key in ablation.tasks(given)} == {"leg"}
    assert all(key.endswith("/rough") for key in ablation.tasks(given))


@pytest.mark.parametrize(("name", "where", "good"), [
    ("coulomb_friction", "joint knee", True), ("coulomb_friction", "joint hip", False)
])  # fmt: skip
def test_a_world_of_a_small_robot_is_good_where_its_effect_is_named_at_its_joint(name, where, good):
    row = {"robot": "leg", "effect": "coulomb_friction", "joint": "knee", "rough": {},
           "verdict": "named", "differences": [], "clocks": [],
           "named": [{"name": name, "where": where, "confidence": 0.9, "rivals": []}]}  # fmt: skip
    assert (ablation.is_good(row), ablation.is_false(row)) == (good, not good)
