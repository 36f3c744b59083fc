"""What a model has of a set of names is the likeliest of them."""

from dataclasses import replace
from functools import cache

import pytest
from records_cases import listed, nominal_model, records

from identification.discovery.options import DiscoveryOptions
from identification.prediction.discovery import WINDOWS
from identification.prediction.judging.judging import judged
from identification.prediction.judging.odds import find_odds
from identification.prediction.moves.add_set import with_one
from identification.prediction.moves.likeliest_of_set import likeliest_of_set
from identification.prediction.task import RecordsTask
from identification.prediction.verdict import told_effects
from identification.windows.records import as_records

TRUE = ("quadratic_friction.c@hinge", 0.01)


@cache
def refits():
    """A search's first state, and what can be refitted in its first round."""
    logs = records(3, dict([TRUE]), samples=200)
    names = ("quadratic_friction", "stribeck_friction", "sublinear_friction")
    task = RecordsTask(
        nominal_model=nominal_model(), records=as_records(logs[:1], logs[1:]),
        effects=listed(*names), options=DiscoveryOptions(max_effects=1),
    )  # fmt: skip
    state, best = WINDOWS.begin(task, print), {}
    for score in state.scores:
        best.setdefault(score.candidate.effect.name, score.candidate)
    refitted = filter(None, (with_one(state, state.model, c) for c in best.values()))
    tried = [judged(state.model, model, len(best), task.options) for model in refitted]
    assert len(tried) > 1
    return state, tried


def with_accepted(which):
    """The state in which one of the refits was accepted, beside the others as its rivals."""
    state, tried = refits()
    mine = next(c for c in tried if c.candidate.effect.name == which)
    others = tuple(c for c in tried if c is not mine)
    accepted = (replace(mine, alternatives=others),)
    return replace(state, model=mine.model, accepted=accepted, nominal=state.model)


def other_name():
    names = [c.candidate.effect.name for c in refits()[1]]
    return next(name for name in names if name != "quadratic_friction")


def test_a_likelier_rival_takes_the_place_of_the_effect_that_was_accepted():
    state = with_accepted(other_name())
    model, (new,), lost = likeliest_of_set(state, print)
    assert new.candidate.effect.name == "quadratic_friction"
    assert new.is_proven
    assert lost == ()
    assert [c.key for c in model.candidates] == [new.candidate.key]
    odds = find_odds(new, model)
    assert odds.own >= max((share for _, share in odds.rivals), default=0.0)
    assert model.values[TRUE[0]] == pytest.approx(TRUE[1], rel=0.1)


def test_the_likeliest_stays_and_nothing_is_refitted():
    state = with_accepted("quadratic_friction")
    model, accepted, lost = likeliest_of_set(state, print)
    assert model is state.model
    assert accepted == state.accepted
    assert lost == ()


def test_the_shares_of_an_effect_and_its_rivals_are_odds():
    for which in ("quadratic_friction", other_name()):
        state = with_accepted(which)
        odds = find_odds(state.accepted[0], state.model)
        every = [odds.own, *(share for _, share in odds.rivals)]
        assert sum(every) == pytest.approx(1.0)
        assert min(every) >= 0.0


def test_what_physics_forbids_is_asked_again_beside_what_was_found_since():
    """It had more of the odds when the effect was found, because it imitated the next one too."""
    state = with_accepted("quadratic_friction")
    (mine,) = state.accepted
    rival, *_ = mine.alternatives
    far = replace(rival, gains=replace(mine.gains, blocks=mine.gains.blocks + 1.0), doubt="mass")
    mine = replace(mine, alternatives=(far,))
    alone = replace(state, accepted=(mine,))
    assert find_odds(mine, state.model).forbidden > 0.5
    assert likeliest_of_set(alone, print)[1] == (mine,)
    later = with_one(state, state.model, rival.candidate) or state.model
    found = replace(rival, model=later)
    model, (first, second), _ = likeliest_of_set(
        replace(state, model=later, accepted=(mine, found)), print
    )
    assert first.candidate.key == mine.candidate.key
    assert find_odds(first, model).own > 0.5
    assert second is found


def test_a_rival_and_another_name_of_the_same_force_have_the_sizes_of_their_own_fits(monkeypatch):
    """The verdict tells each name of a set with its own size, and not that of the first one."""
    state = with_accepted("quadratic_friction")
    (mine,) = state.accepted
    (other, *_) = mine.alternatives
    odds = replace(
        find_odds(mine, state.model), rivals=((other, 0.4),), twin=other.candidate.key[0]
    )
    monkeypatch.setattr(told_effects, "find_odds", lambda *_: odds)
    named = told_effects.named_effect(state, mine, 0.95, None)
    (rival,) = named.rivals
    assert (rival.name, named.twin.name) == (other_name(), other_name())
    assert named.twin.confidence == named.confidence
    _, sizes = told_effects.fitted_sizes(other.model, other.candidate)
    assert rival.parameters == named.twin.parameters == sizes
    assert {s.name for s in rival.candidate.effect.sizes} <= {*sizes}
