"""A pass is judged by the worlds that only one of the two searches answers right."""

import json

import ablation
import pytest
from scipy.stats import binom


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


@pytest.mark.parametrize(("answer", "good"), [
    (row("nothing", []), True), (row("nothing", ["delay"]), False),
    (row("delay", ["delay"]), True), (row("delay", ["lag"]), False), (row("delay", []), False),
    (row("tide", ["lag"], curve="curve_time"), False),
    (row("tide", ["curve_time"], curve="curve_time"), True),
    (row("tide", [], curve="curve_time"), False),
    ({**row("tide", [], curve="curve_time"), "verdict": "unknown effect"}, True),
])  # fmt: skip
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
    answer = {**row("delay", ["delay"]), "key": "cart/delay/3", "duration": 9.0}
    for passes, is_moved in ((("add_set",), True), (("add_effect",), True), (("add_set",), False)):
        assert ablation.study(answer, passes, is_moved).get("alike", False) == (not asked)
    assert [task[-1] for task in asked] == [("add_effect",), ("add_set",)]
    assert asked[0][:4] == ("cart", "delay", 3, 9.0)


def test_only_answers_of_one_search_are_compared(tmp_path):
    def of(commit, effect, names):
        return {**row(effect, names), "key": f"cart/{effect}/1", "commit": commit}

    answers = [of("new", "delay", ["delay"]), of("new", "lag", ["lag"])]
    rows = [of("old", "lag", ["lag"]), of("new", "delay", []), of("new", "offset", ["offset"])]
    (pair,) = ablation.pairs_of(answers, rows)
    assert pair == {"with": answers[0], "without": rows[1]}
    assert "None has been left out" in ablation.section(answers, tmp_path)
    path = tmp_path / "add_set+begin_anew.jsonl"
    path.write_text("".join(json.dumps(r) + "\n" for r in rows), encoding="utf-8")
    told = ablation.section(answers, tmp_path)
    assert "Without `add_set` and `begin_anew`, search of new" in told
    assert "| a listed effect: named first, or alike | 1 of 1" in told
