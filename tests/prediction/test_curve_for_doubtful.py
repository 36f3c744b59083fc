"""Curves at the joints of effects that are all in doubt take their place if they do as much."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from test_drop_doubtful import accepted, letter, state

from identification.prediction.moves import curve_for_doubtful as move


def after(monkeypatch, begun, doubtful, proven="", better=False, joint="joint"):
    """The names of the state after the move, those that were lost, and what was asked.

    Args:
        monkeypatch: of pytest.
        begun: the state.
        doubtful: letters of the effects in doubt.
        proven: curves that are proven one after the other once the doubtful are gone.
        better: whether unseen records prove that the doubtful ones predict better.
        joint: of the curves that are scored.
    """
    asked = []
    sure = [a for a in begun.accepted if letter(a) not in doubtful]
    doubts = [replace(a, doubt="odds") for a in begun.accepted if letter(a) in doubtful]
    left = SimpleNamespace(candidate=replace(accepted("C").candidate, where=joint))

    def without(state, sure, keys):
        whole = SimpleNamespace(candidates=[a.candidate for a in sure], unseen=None)
        return replace(state, model=whole, accepted=tuple(sure), scores=(left,))

    def add_curve(state, progress):
        asked.append((state.scores, state.rejected))
        rest = proven[sum(a.candidate.effect.is_curve for a in state.accepted) - len(sure) :]
        if not rest or not state.scores:
            return state
        return replace(state, accepted=(*state.accepted, accepted(f"curve{rest[0]}")))

    monkeypatch.setattr(move, "sure_and_doubtful", lambda state: (sure, doubts))
    monkeypatch.setattr(move, "fitted_without", without)
    monkeypatch.setattr(move, "add_curve", add_curve)
    monkeypatch.setattr(move, "is_better", lambda *given: better)
    monkeypatch.setattr(move, "share_a_joint", lambda a, b: a.where == b.where)
    new = move.curve_for_doubtful(begun, lambda line: None)
    lost = [(letter(a), a.doubt) for a in new.rejected]
    return "".join(map(letter, new.accepted)), lost, asked


@pytest.mark.parametrize(("names", "doubtful", "proven", "kept"), [
    ("ab", "a", "D", "ab"),  # one law is sure
    ("ab", "ab", "D", "D"),
    ("ab", "ab", "DE", "DE"),
    ("a", "a", "D", "D"),
    ("a", "a", "DE", "D"),  # no more than there were, so that no law is asked beside them
    ("aC", "a", "", "C"),  # the curve that is sure draws what there is
    ("aC", "a", "D", "CD"),
    ("ab", "ab", "", "ab"),  # nothing is proven in their place
])  # fmt: skip
def test_curves_take_the_place_of_what_is_in_doubt(monkeypatch, names, doubtful, proven, kept):
    new, lost, _ = after(monkeypatch, state(*names), doubtful, proven)
    assert new == kept
    assert lost == ([] if kept == names else [(n, "odds") for n in doubtful])


def test_laws_that_unseen_records_prove_to_be_better_stay(monkeypatch):
    assert after(monkeypatch, state("a", "b"), "ab", "D", better=True)[:2] == ("ab", [])


@pytest.mark.parametrize(("doubt", "curves", "is_better"), [
    (None, 5.0, True),  # they close five ninths of the gap, and effects all of it
    (None, 1.5, False),  # of which effects take a twentieth more, however surely
    ("chance", 5.0, False),
])  # fmt: skip
def test_effects_are_better_where_they_close_more_of_the_gap(monkeypatch, doubt, curves, is_better):
    def of(square):
        at_horizon = (np.full(4, square),)
        return SimpleNamespace(
            unseen=SimpleNamespace(select=SimpleNamespace(at_horizon=at_horizon))
        )

    monkeypatch.setattr(move, "compared", lambda *given: None)
    monkeypatch.setattr(move, "find_doubt", lambda *given: doubt)
    begun = replace(state("a"), nominal=of(10.0), model=of(1.0))
    assert move.is_better(begun, replace(begun, model=of(curves))) is is_better


def test_a_curve_is_asked_at_the_joints_of_the_doubtful_only(monkeypatch):
    _, _, ((scores, _), *_) = after(monkeypatch, state("a"), "a", "D")
    assert len(scores) == 1
    kept, _, ((scores, _),) = after(monkeypatch, state("a"), "a", "D", joint="other")
    assert kept == "a"
    assert not scores


def test_a_curve_does_not_pay_for_what_was_refitted_before(monkeypatch):
    begun = replace(state("a"), rejected=(accepted("x"),))
    new, lost, asked = after(monkeypatch, begun, "a", "D")
    assert (new, lost) == ("D", [("a", "odds"), ("x", None)])
    assert [rejected for _, rejected in asked] == [()]
