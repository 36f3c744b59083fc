"""A candidate that fails is rejected and told, whatever stage of a search it fails in.

The slider lacks a constant force and a dry friction. One of the two fails as soon as it is there:
a simulation diverges, values are refused, a matrix cannot be inverted, or NaN comes out. Only the
nominal model may end a search.
"""

from functools import partial

import pytest
from discovery_cases import EFFECTS, disturbed, searched, stepped, task
from failing_cases import ERRORS, HOWS, Failing

from identification.discovery.attempts import (
    Failed,
    attempt,
    attempt_each,
    collected,
    tell_lost,
)
from identification.effects.effect import Candidate
from identification.errors import DivergenceError, InputError
from identification.innovations import fitted_model, state
from identification.innovations.discovery import INNOVATIONS
from identification.innovations.moves import forward_selection
from identification.innovations.verdict import conclude
from identification.report.discovery.effect_sections import FAILED
from identification.report.discovery.json import discovery_to_json
from identification.report.discovery.report import discovery_text

TRUTH = {"offset.f": -0.8, "rubbing.c": 1.0}
KEY = ("rubbing", "joint")


def failing(monkeypatch, how, size="rubbing.c"):
    return Failing(size, how).install(monkeypatch)


def told_of(found):
    return {f.key for f in found.failed}


@pytest.mark.parametrize(
    ("how", "module", "function"),
    # One function catches what is raised in all stages, so that a few ways try each stage.
    [*((how, state, "_compute_all_sensitivities") for how in HOWS[:3]),
     *((how, forward_selection, "_refit_candidates") for how in ("divides by zero",)),
     *((how, fitted_model, "validate") for how in ("gives NaN",))],
)  # fmt: skip
def test_a_candidate_that_fails_is_rejected_and_told_and_the_search_goes_on(
    how, module, function, monkeypatch
):
    bad, said = failing(monkeypatch, how), []
    bad.within(monkeypatch, module, function)
    states = stepped(INNOVATIONS.begin(task(disturbed(**TRUTH)), said.append))
    assert bad.reached
    assert states[-1].is_finished
    found = conclude(states[-1])
    assert "rubbing" not in {n.name for n in found.named}
    assert KEY in told_of(found)
    (one,) = (f for f in found.failed if f.key == KEY)
    assert one.outcome in discovery_text(found)
    assert f"{FAILED}:" in discovery_text(found)
    assert KEY in {(f["name"], f["where"]) for f in discovery_to_json(found)["failed"]}
    assert not any("take a smaller rho" in str(f) for f in found.failed)


def test_an_accepted_effect_that_fails_as_the_others_are_dropped_or_exchanged_stays(monkeypatch):
    after = searched(**TRUTH)[-3]
    assert [m.name for m in after.moves] == ["drop_effects", "exchange_effects"]
    bad = failing(monkeypatch, "gives NaN")
    with bad.active():
        after = stepped(after)[-1]
        found = conclude(after)
    assert bad.reached
    assert after.is_finished
    assert {n.name for n in found.named} | {r.name for r in found.rejected} >= {"rubbing"}


@pytest.mark.parametrize("stage", ["select_effect", "without_needless"])
def test_a_step_that_fails_as_a_whole_is_told_and_skipped(stage, monkeypatch):
    first, said = searched(**TRUTH)[0], []

    def fails(*_):
        raise DivergenceError("a force is not finite; take a shorter step")

    monkeypatch.setattr(state, stage, fails)
    now = first
    while not now.is_finished:
        now = INNOVATIONS.step(now, said.append)
    (one,) = (f for f in now.failed if not f.where)
    assert one.reason == "a force is not finite"
    assert str(one) in said
    assert conclude(now).failed == now.failed


@pytest.mark.parametrize("how", ["diverges", "gives NaN"])
def test_the_nominal_model_ends_a_search_and_nothing_else(how, monkeypatch):
    bad = failing(monkeypatch, how, "mass")
    with bad.active(), pytest.raises(InputError):
        INNOVATIONS.begin(task(disturbed(**TRUTH)), print)


def test_a_failure_is_told_once_and_without_what_nobody_can_follow():
    said, candidate = [], Candidate(EFFECTS[0], "joint", {})

    def fails():
        raise ERRORS["diverges"]

    with collected(said.append) as failed:
        assert attempt(None, fails) is None
        assert attempt(candidate, fails) is attempt(candidate, fails) is None
        tell_lost([candidate], [])
        tell_lost([candidate], [candidate])
        assert attempt("the pruning", lambda: 3) == 3
    reason = "the motors have more inertia than the robot"
    assert failed == [Failed("spring", "joint", True, reason)]
    assert said == [f"spring, joint: tried, and its simulation diverged: {reason}"]
    assert attempt(candidate, fails) is None  # nobody listens


def test_an_error_of_the_program_is_no_failed_candidate():
    def wrong():
        raise TypeError("a fault of the program")

    with pytest.raises(TypeError):
        attempt(None, wrong)


def test_evaluations_side_by_side_return_and_tell_what_they_do_one_by_one():
    def evaluate(k):
        if k % 3 == 0:
            raise DivergenceError(f"it left at {k}; take less")
        return k

    tasks = [(f"number {k}", partial(evaluate, k)) for k in range(12)]
    told = {}
    for name, run in (("one by one", lambda: [attempt(*t) for t in tasks]),
                      ("side by side", lambda: [*attempt_each(tasks)])):  # fmt: skip
        lines = []
        with collected(lines.append) as failed:
            told[name] = run(), list(failed), lines
    assert told["side by side"] == told["one by one"]
    assert len(told["side by side"][2]) == 4
    assert [*attempt_each(tasks)] == told["one by one"][0]  # nobody listens
