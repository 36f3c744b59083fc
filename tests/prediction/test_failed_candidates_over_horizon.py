"""Over a horizon too, a candidate that fails is rejected and told, whatever stage it fails in.

The pendulum lacks friction under its load. This effect fails as soon as its size is not zero, while
one stage of the search runs; the other candidates are tried all the same.
"""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from failing_cases import ERRORS, Failing
from page_text import text_of
from records_cases import listed, nominal_model, records

from identification.discovery.options import DiscoveryOptions
from identification.errors import InputError
from identification.prediction import state
from identification.prediction.discovery import WINDOWS
from identification.prediction.fits import crossing
from identification.prediction.judging import extension
from identification.prediction.moves import add_effect
from identification.prediction.scoring import columns, forced
from identification.prediction.selection import exchange, selection
from identification.prediction.task import RecordsTask
from identification.prediction.verdict.verdict import conclude
from identification.report.discovery.json import discovery_to_json
from identification.report.discovery.report import DiscoveryFiles, discovery_text
from identification.windows.records import as_records

SIZE, NAME, WHERE = "quadratic_friction.c@hinge", "quadratic_friction", "joint hinge"
KEY, TRUE = (NAME, WHERE), 0.01
SAMPLES = 200


@cache
def task():
    logs = records(3, {SIZE: TRUE}, samples=SAMPLES)
    return RecordsTask(
        nominal_model=nominal_model(),
        records=as_records(logs[:1], logs[1:]),
        effects=listed(NAME, "offset"),
        options=DiscoveryOptions(without=("add_set",)),  # which would refit it once more
    )  # fmt: skip


@cache
def begun():
    return WINDOWS.begin(task(), print)


def ended(first, progress=print, evidence=WINDOWS):
    now = first
    while not now.is_finished:
        now = evidence.step(now, progress)
    return now


@cache
def found():
    return conclude(ended(begun()))


def failing(monkeypatch, how):
    return Failing(SIZE, how).install(monkeypatch)


def test_a_candidate_whose_simulation_fails_is_told_and_the_others_are_scored(monkeypatch):
    monkeypatch.setattr(columns, "forces_of", lambda fit: (None,) * len(fit.moves))
    bad, said = failing(monkeypatch, "gives NaN"), []
    bad.within(monkeypatch, state, "score_all")
    first = WINDOWS.begin(task(), said.append)
    assert bad.reached
    assert_only_the_other_is_scored(first, said)


def test_a_candidate_whose_law_gives_nan_is_told_and_the_others_are_scored(monkeypatch):
    whole, said = forced.hook_values, []

    def values(function, states, numbers):
        out = whole(function, states, numbers)
        return np.full_like(out, np.nan) if function.__name__ == NAME else out

    monkeypatch.setattr(forced, "hook_values", values)
    assert_only_the_other_is_scored(WINDOWS.begin(task(), said.append), said)


def assert_only_the_other_is_scored(first, said):
    assert {s.candidate.effect.name for s in first.scores} == {"offset"}
    assert [f.key for f in first.failed] == [KEY]
    assert str(first.failed[0]) in said


@pytest.mark.parametrize(("module", "function", "how"), [
    (selection, "begin", "gives NaN"), (selection, "with_effect", "is refused"),
    (extension, "predict_fitted", "diverges"),
])  # fmt: skip
def test_a_candidate_whose_refit_fails_is_told_and_not_named(module, function, how, monkeypatch):
    bad, said = failing(monkeypatch, how), []
    bad.within(monkeypatch, module, function)
    answer = conclude(ended(begun(), said.append))
    assert bad.reached
    assert NAME not in {n.name for n in answer.named}
    assert [f.key for f in answer.failed] == [KEY]
    assert str(answer.failed[0]) in said
    assert answer.failed[0].outcome in discovery_text(answer)
    assert discovery_to_json(answer)["failed"][0]["name"] == NAME


@pytest.mark.parametrize(("module", "function"), [(crossing, "_begun_best"), (exchange, "solve")])
def test_an_effect_that_fails_only_in_a_comparison_keeps_what_its_own_fit_found(
    module, function, monkeypatch
):
    asked = []

    def fails(*_, **__):
        asked.append(function)
        raise ERRORS["cannot be solved"]

    monkeypatch.setattr(module, function, fails)
    answer = conclude(ended(begun()))
    assert asked
    assert [n.candidate.key for n in answer.named] == [KEY]
    assert answer.named[0].parameters["c"][0] == pytest.approx(
        found().named[0].parameters["c"][0], rel=0.05
    )


def test_a_failure_while_a_search_ends_leaves_what_was_found(monkeypatch):
    bad = failing(monkeypatch, "diverges")
    end = ended(begun())
    with bad.active():
        answer = conclude(end)
    assert [n.candidate.key for n in answer.named] == [KEY]


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize("step", ["refit_contenders", "drop_effects"])
def test_a_round_that_fails_as_a_whole_ends_the_search_with_what_was_found(
    step, monkeypatch, tmp_path
):
    def fails(*_):
        raise InputError("a matrix is singular; take another")

    evidence = WINDOWS
    if step == "drop_effects":
        moves = tuple(replace(m, make=fails) if m.name == step else m for m in WINDOWS.moves)
        evidence = replace(WINDOWS, moves=moves)
    else:
        monkeypatch.setattr(add_effect, step, fails)
    said = []
    first = replace(begun(), moves=evidence.asked(begun()))
    answer = conclude(ended(first, said.append, evidence))
    one, *others = answer.failed
    assert (one.where, one.reason) == ("", "a matrix is singular")
    assert len(others) == (step == "refit_contenders")  # for laws, and for curves
    assert str(one) in said
    assert one.outcome in text_of(
        DiscoveryFiles(answer).write_page(tmp_path / "report.html").read_text()
    )
