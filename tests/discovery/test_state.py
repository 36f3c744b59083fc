"""A search is a state that is stepped until it is finished; here it is one for two effects."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from discovery_cases import EFFECTS, OPTIONS, searched, stepped

from identification.discovery.confidence import name_effects
from identification.discovery.fitted_model import fit_model
from identification.discovery.scoring.sensitivities import compute_sensitivities
from identification.discovery.selection.forward_selection import select_effect
from identification.discovery.selection.pruning import exchange
from identification.discovery.state import next_state
from identification.discovery.verdict import conclude


def names(state):
    return [a.candidate.effect.name for a in state.accepted]


@pytest.fixture(scope="module")
def states():
    return searched(**{"offset.f": -0.8, "rubbing.c": 1.0})


def test_each_step_accepts_an_effect_or_ends_the_selection(states):
    growing = ["add_effect", "add_pair", "add_deviants"]
    asked = [*growing, "drop_effects", "exchange_effects"]
    assert [[m.name for m in s.moves] for s in states] == [asked] * 3 + [
        asked[k:] for k in range(1, 6)
    ]
    assert [len(s.accepted) for s in states] == [0, 1] + 6 * [2]
    assert set(names(states[-1])) == {"offset", "rubbing"}
    for state in states:
        assert {c.effect.name for c in state.model.candidates} == set(names(state))
        left = {s.candidate.effect.name for s in state.scores}
        assert left == {e.name for e in EFFECTS} - set(names(state))


def test_candidates_are_scored_along_the_trajectory_of_the_model(states):
    for before, state in pairwise(states[:3]):
        has = {c.key for c in state.model.candidates}
        old = {s.candidate.key: s.S for s in before.sensitivities}
        for s in state.sensitivities:
            if s.candidate.key in has:
                assert s.S is old[s.candidate.key]
                continue
            (fresh,) = compute_sensitivities(state.model.refit.point, [s.candidate])
            np.testing.assert_allclose(s.S, fresh.S, rtol=1e-9, atol=1e-12)
            assert not np.allclose(s.S, old[s.candidate.key], rtol=1e-3)


def test_a_step_changes_no_state_that_it_begins_with(states):
    first = states[0]
    again = next_state(first, print)
    assert names(first) == []
    assert first.model is first.nominal
    assert names(again) == names(states[1])
    assert again.model.negative_bic == states[1].model.negative_bic


def test_a_finished_state_stays_as_it_is(states):
    assert next_state(states[-1], print) is states[-1]


def test_no_more_effects_are_accepted_than_the_options_admit(states):
    one = replace(OPTIONS, max_effects=1)
    state = replace(states[0], task=replace(states[0].task, options=one))
    state = next_state(state, print)
    assert [m.name for m in state.moves] == ["drop_effects", "exchange_effects"]
    assert names(state) == names(states[1])


def test_of_two_effects_neither_is_the_others_rival(states):
    end = states[-1]
    assert {n.candidate.effect.name for n in conclude(end).named} == {"offset", "rubbing"}
    first, second = end.accepted
    there = replace(first.model, candidates=second.model.candidates[-1:])
    accepted = (replace(first, alternatives=(there,)), second)
    again = name_effects(end.task, accepted, end.model, end.sensitivities, 1.0, 0.95)
    assert not again[0].rivals
    assert again[0].confidence > 0.5
    lower = name_effects(end.task, accepted, end.model, end.sensitivities, 1.0, 0.6)
    assert [n.confidence for n in lower] == [min(0.6, n.confidence) for n in again]


def test_an_effect_gives_way_to_one_that_was_never_refitted_but_explains_more(states):
    end = states[-2]
    kept = {a.candidate.effect.name: a for a in end.accepted}
    spring = next(s.candidate for s in end.sensitivities if s.candidate.effect.name == "spring")
    values = end.model.refit.point.values
    wrong = fit_model(end.task, (kept["rubbing"].candidate, spring), values)
    alone = replace(kept["offset"].model, candidates=(spring,))
    first = replace(kept["offset"], model=alone, alternatives=(), gain=10.0)
    accepted = [first, kept["rubbing"]]
    _, better = exchange(end.task, end.nominal, accepted, wrong, end.sensitivities)
    assert {c.effect.name for c in better.candidates} == {"offset", "rubbing"}
    assert better.negative_bic > wrong.negative_bic


def test_what_was_refitted_beside_a_name_and_not_believed_is_kept(states, monkeypatch):
    def doubtful(task, *rest):  # beside a first name nothing is proven
        return select_effect(replace(task, options=replace(OPTIONS, min_proof_t=1e9)), *rest)

    monkeypatch.setattr("identification.discovery.state.select_effect", doubtful)
    answer = conclude(stepped(states[1])[-1])
    rejected = {r.candidate.effect.name: r for r in answer.rejected}
    assert "rubbing" in rejected
    assert rejected["rubbing"].bic_gain > 0
    named = {n.candidate.effect.name for n in answer.named}
    assert "offset" in (named if answer.verdict == "named" else rejected)
