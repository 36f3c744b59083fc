"""A search is a state that is stepped until it is finished."""

from dataclasses import replace

import pytest
from discovery_cases import EFFECTS, OPTIONS, nominal_model, record, slider, task, wander

from identification.discovery.search import discover
from identification.discovery.state import first_state, next_state
from identification.discovery.verdict import conclude

ROBOT = {"mass": 2.2, "damping": 2.7, "x0": 0.01, "v0": 0.02}


def log(**sizes):
    error = wander(500, 0.03, 0.1, seed=8)
    return record(slider(**ROBOT, **sizes), 500, seed=11, error=error)


def names(state):
    return [a.candidate.effect.name for a in state.accepted]


@pytest.fixture(scope="module")
def states():
    """Every state of a search for two effects, the finished one last."""
    seen = [first_state(task(log(**{"offset.f": -0.8, "rubbing.c": 1.0})), print)]
    while not seen[-1].is_finished:
        seen.append(next_state(seen[-1], print))
    return seen


def test_each_step_accepts_an_effect_or_ends_the_selection(states):
    assert [s.stage for s in states] == ["selection"] * 3 + ["deviants", "pruning", "finished"]
    assert [len(s.accepted) for s in states] == [0, 1, 2, 2, 2, 2]
    assert set(names(states[-1])) == {"offset", "rubbing"}
    for state in states:
        assert {c.effect.name for c in state.model.candidates} == set(names(state))
        left = {s.candidate.effect.name for s in state.scores}
        assert left == {e.name for e in EFFECTS} - set(names(state))


def test_a_step_changes_no_state_that_it_begins_with(states):
    first = states[0]
    again = next_state(first, print)
    assert names(first) == []
    assert first.model is first.nominal
    assert names(again) == names(states[1])
    assert again.model.negative_bic == states[1].model.negative_bic


def test_a_finished_state_stays_as_it_is(states):
    assert next_state(states[-1], print) is states[-1]


def test_the_verdict_is_that_of_the_whole_discovery(states):
    answer, whole = conclude(states[-1]), discover(nominal_model(), states[0].task.log, EFFECTS)
    assert answer.verdict == whole.verdict == "named"
    assert [n.parameters for n in answer.named] == [n.parameters for n in whole.named]
    assert [n.confidence for n in answer.named] == [n.confidence for n in whole.named]


def test_no_more_effects_are_accepted_than_the_options_admit(states):
    one = replace(OPTIONS, max_effects=1)
    state = replace(states[0], task=replace(states[0].task, options=one))
    state = next_state(state, print)
    assert state.stage == "pruning"
    assert names(state) == names(states[1])
