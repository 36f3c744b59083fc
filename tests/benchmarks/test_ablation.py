"""A pass is judged by the worlds that only one of the two searches answers right."""

import ablation
import pytest
from scipy.stats import binom

from identification.discovery.passes import PASSES


def row(effect, names, curve=""):
    named = [{"name": n, "one_of": False, "rivals": []} for n in names]
    truth = {"effect": effect, "names": [effect], "parameters": {}, "joint": "j1", "size": 1.0,
             "curve": curve}  # fmt: skip
    verdict = "named" if names else "nothing missing"
    moves = ["add_effect"] * len(names)
    return {"truth": truth, "verdict": verdict, "named": named, "moves": moves,
            "processor_seconds": 2.0}  # fmt: skip


def pair(with_it, without):
    return {"key": "k", "with": with_it, "without": without}


@pytest.mark.parametrize(
    ("answer", "good"),
    [
        (row("nothing", []), True), (row("nothing", ["delay"]), False),
        (row("delay", ["delay"]), True), (row("delay", ["lag"]), False), (row("delay", []), False),
        (row("tide", ["lag"], curve="curve_time"), False),
        (row("tide", ["curve_time"], curve="curve_time"), True),
        (row("tide", [], curve="curve_time"), False),
        ({**row("tide", [], curve="curve_time"), "verdict": "unknown effect"}, True),
    ],
)  # fmt: skip
def test_silence_a_right_name_and_what_is_called_unknown_or_drawn_are_right(answer, good):
    assert ablation.is_good(answer) is good


def test_only_worlds_that_one_search_alone_answers_right_count():
    right, wrong = row("delay", ["delay"]), row("delay", ["lag"])
    pairs = [pair(right, right)] * 5 + [pair(right, wrong)] * 6 + [pair(wrong, right)]
    told = next(line for line in ablation.summary(pairs).splitlines() if "listed effect" in line)
    cells = [cell.strip() for cell in told.strip("|").split("|")]
    assert cells[3:5] == ["6", "1"]
    assert float(cells[5]) == pytest.approx(2 * binom.cdf(1, 7, 0.5), rel=0.05)


def test_a_world_in_which_no_move_that_is_left_out_did_anything_is_not_searched_again(monkeypatch):
    asked = []
    monkeypatch.setattr(ablation.hidden_joints, "study", lambda *task: asked.append(task) or {})
    answer = {**row("delay", ["delay"]), "key": "cart/delay/3/records"}
    for passes, is_moved in ((("add_set",), True), (("add_effect",), True), (("add_set",), False)):
        pair = ablation.study(answer, 12.0, passes, is_moved)
        assert pair["with"] is answer
    assert [task[-1] for task in asked] == [("add_effect",), ("add_set",)]
    assert asked[0][:5] == ("cart", "delay", 3, "records", 12.0)


def test_the_plain_search_leaves_out_every_pass():
    assert ablation.passes_of(["plain"]) == (*PASSES,)
