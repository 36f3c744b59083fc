"""A search is a state that is stepped until it is finished; here it is one for two effects."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from discovery_cases import EFFECTS, OPTIONS, searched

from identification.innovations.discovery import INNOVATIONS
from identification.innovations.fitted_model import fit_model
from identification.innovations.moves.pruning import exchange
from identification.innovations.scoring.sensitivities import compute_sensitivities


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


def test_no_more_effects_are_accepted_than_the_options_admit(states):
    one = replace(OPTIONS, max_effects=1)
    state = replace(states[0], task=replace(states[0].task, options=one))
    state = INNOVATIONS.step(state, print)
    assert [m.name for m in state.moves] == ["drop_effects", "exchange_effects"]
    assert names(state) == names(states[1])


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
