"""From records to a verdict: a hidden law is named, an empty one is not, and what is refused."""

import time
from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from records_cases import listed, nominal_model, pendulum, record, records, search

from identification.errors import InputError
from identification.prediction.discovery import discover_records
from identification.prediction.selection import selection
from identification.prediction.verdict import verdict
from identification.report.discovery.json import discovery_to_json
from identification.report.discovery.report import discovery_text
from identification.report.words.proof import agreement_sentences
from identification.report.words.rest import resting
from identification.runtime import pool

SAMPLES = 300  # of each record
MU = "transmitted_load_friction.mu@hinge"


def rows(log, count):
    """The first samples of a log."""
    cut = {name: getattr(log, name)[:count] for name in ("time", "inputs", "outputs")}
    return replace(log, **cut)


FEW = ("transmitted_load_friction", "gravity_load_friction", "quadratic_friction", "offset")


@cache
def found(mu=0.15, names=FEW):
    return search(records(4, {MU: mu} if mu else None, samples=SAMPLES), names)


def test_friction_under_the_transmitted_load_is_named_with_its_size():
    answer = found()
    assert answer.verdict == "named"
    (named,) = answer.named
    assert named.candidate.effect.name == "transmitted_load_friction"
    value, std, _ = named.parameters["mu"]
    assert abs(value - 0.15) < 4 * std
    assert std < 0.02
    assert len(named.proof.agrees) == 2
    assert named.proof.disagrees == ()
    assert answer.share > 0.9


def test_a_record_that_repeats_another_is_no_further_witness():
    first, second, third = records(3, {MU: 0.15}, samples=SAMPLES)
    again = replace(third, name="again", outputs=third.outputs + 1e-5)
    # which refits nothing: records are told before
    answer = search([first, second, third, again], FEW[:1], max_minutes=0.0)
    assert answer.repeats == ("again",)
    assert discovery_to_json(answer)["repeats"] == ["again"]


def test_a_record_at_rest_is_no_witness_and_repeats_nothing():
    """It counted as one on which a name is right or wrong, or as a motion that was fitted."""
    first, second, third = records(3, {MU: 0.15}, samples=SAMPLES)
    noise = 3e-4 * np.random.default_rng(5).standard_normal(third.outputs.shape)
    still = replace(third, name="still", inputs=0 * third.inputs, outputs=noise)
    # which refits nothing: records are told before
    answer = search([first, second, third, still], FEW[:1], max_minutes=0.0)
    assert answer.repeats == ()
    assert resting(answer) == discovery_to_json(answer)["resting"] == ["still"]
    told = replace(found().named[0].proof, agrees=(third.name, "still"), untouched=None)
    named = replace(found().named[0], proof=told)
    assert agreement_sentences(answer, named) == (
        " The named effect lowers the error on the unseen record. still, in which the robot hardly"
        " moves, does not count."
    )
    assert "In still the robot hardly moves, so that this proves little" in discovery_text(answer)
    alone = search([first, second, still, replace(still, name="too", outputs=-noise)], FEW[:1],
                   max_minutes=0.0)  # fmt: skip
    assert agreement_sentences(alone, named) == (
        " In all unseen records the robot hardly moves, so that they hardly confirm it."
    )
    assert resting(found()) == []


def test_records_too_short_to_confirm_are_refused():
    first, second = records(2, {MU: 0.15})
    short = rows(second, 45)
    with pytest.raises(InputError, match=r"holds 2 windows of 0\.2 s, too few to prove anything"):
        discover_records(nominal_model(), [first], [short], listed(FEW[0]))


def test_records_without_an_effect_get_no_name():
    answer = found(mu=0.0)
    assert answer.named == ()
    assert answer.verdict == "nothing missing"


def clipped_and_not(names):
    """Two records whose torque is clipped and two whose torque is small; the model begins right."""
    hidden = {"saturation.c@drive": 1.0, "saturation.u_max": 0.4}
    logs = [record(k, SAMPLES, hidden, plant=pendulum()) for k in (1, 2)]
    logs += [record(k, SAMPLES, plant=pendulum(), largest=0.35) for k in (3, 4)]
    return search(logs, names, replace(nominal_model(), plant=pendulum()))


def test_what_made_a_fit_worse_than_its_start_is_named_and_told():
    answer = clipped_and_not(("saturation", "offset"))
    assert [n.candidate.effect.name for n in answer.named] == ["saturation"]
    assert answer.named[0].parameters["u_max"][0] == pytest.approx(0.4, rel=0.02)
    said = discovery_text(answer)
    assert "the fitted values predicted unseen data worse than those of the model" in said


def test_a_horizon_is_needed(refusal):
    base, logs = replace(nominal_model(), horizon=None), records(2)
    assert "horizon" in refusal(discover_records, base, logs[:1], logs[1:], [])


def test_a_search_behind_its_time_limit_answers_and_says_what_it_has_not_tried():
    answer = search(records(4, {MU: 0.15}, samples=SAMPLES), FEW, max_minutes=0.0)
    assert answer.verdict == "unknown effect"
    assert answer.scores
    assert answer.cut_short == ("add_effect", "add_set")
    assert discovery_to_json(answer)["cut_short"] == [*answer.cut_short]
    said = discovery_text(answer)
    sought = "the next effect and sets of several effects"
    assert f"while it sought {sought}. Effects that it" in said
    (untried,) = [f.evidence for f in answer.findings if f.kind == "untried effect"]
    assert untried.score.candidate.where == "joint hinge"
    assert "would explain more than chance could by its score" in said
    assert found().cut_short == ()


def test_effects_without_a_sure_name_tell_how_far_they_predict_together(monkeypatch):
    sure = found()
    assert (sure.verdict, sure.doubtful) == ("named", None)
    monkeypatch.setattr(verdict, "doubts_of_names", lambda named, *_: ("odds",) * len(named))
    unsure = search(records(4, {MU: 0.15}, samples=SAMPLES), FEW)
    assert (unsure.verdict, unsure.named) == ("unknown effect", ())
    assert unsure.doubtful.rms == sure.after.rms < 0.2 * unsure.after.rms
    assert "whose names are not sure, together take this error from" in discovery_text(unsure)
    assert discovery_to_json(unsure)["gap"]["doubtful"]["rms"] == unsure.doubtful.rms


def test_what_was_refitted_before_the_time_was_over_is_still_judged_and_named(monkeypatch):
    """The clock jumps behind the limit once the first effect of the first round is refitted."""
    is_late, refit, passed = [], selection._refit, time.monotonic

    def first(*args):
        new = refit(*args)
        is_late.append(args[1].candidate.effect.name)
        return new

    monkeypatch.setenv("INCA_MJ_THREADS", "1")
    monkeypatch.setattr(selection, "_refit", first)
    late = SimpleNamespace(monotonic=lambda: passed() + 1e6 * bool(is_late))
    monkeypatch.setattr(pool, "time", late)
    answer = search(records(4, {MU: 0.15}, samples=SAMPLES), FEW)
    assert is_late == [FEW[0]]
    assert [n.candidate.effect.name for n in answer.named] == [FEW[0]]
