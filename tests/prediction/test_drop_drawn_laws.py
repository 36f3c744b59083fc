"""A law whose work a curve does that was found later at its joint is told, and not named."""

from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest
from numba import njit

from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Candidate, Effect
from identification.effects.sizes import Size
from identification.prediction.moves import curve_for_laws, drop_beside_curves, drop_drawn_laws
from identification.prediction.trial import has_size

LAW = njit(lambda s, p: 0.0)
SIZES = (Size("c", "N", 1.0, 0.1, about=""),)


def model(square, *candidates):
    unseen = SimpleNamespace(select=SimpleNamespace(at_horizon=(np.array([square]),)))
    return SimpleNamespace(candidates=list(candidates), unseen=unseen, scale=np.ones(1))


@dataclass(frozen=True)
class Accepted:
    """What a contender is asked here."""

    candidate: Candidate
    model: SimpleNamespace = None
    prediction: SimpleNamespace = None
    doubt: str | None = None
    criterion: float = 0.0

    @property
    def is_proven(self):
        return self.doubt is None


def accepted(name, where="joint", hook="force", after=1.0, fall=0.9):
    effect = Effect(name, "", SIZES, places={where: ""}, hooks={hook: LAW})
    prediction = SimpleNamespace(fall=fall)
    return Accepted(Candidate(effect, where, {}), model(after), prediction)


def state(whole, every, effects=()):
    task = SimpleNamespace(
        nominal_model=None, confirm=(), horizon=0.2, effects=effects, options=DiscoveryOptions()
    )
    return SimpleNamespace(model=whole, accepted=tuple(every), task=task, scores=())


def names(each):
    return [a.candidate.effect.name for a in each]


def after_curve(monkeypatch, every, without):
    """What stays and what goes where the mean square without the law, beside the curve, is so."""
    told = []

    def refit(whole, rest, base, confirm):
        return None if without is None else model(without, *rest)

    monkeypatch.setattr(drop_drawn_laws, "refitted", refit)
    whole = model(0.1, *(a.candidate for a in every))
    new, kept, lost = drop_drawn_laws.drop_drawn_laws(state(whole, every), told.append)
    assert len(told) == len(lost)
    assert all(a.doubt == "drawn" for a in lost)
    assert names(c for c in kept) == [c.effect.name for c in new.candidates]
    return names(kept), names(lost)


# Alone the law took the mean square from 10 to 1.
@pytest.mark.parametrize(("without", "is_lost"), [(4.5, True), (4.7, False)])
def test_a_law_stays_that_explains_beside_the_curve_what_it_did_alone(
    monkeypatch, without, is_lost
):
    every = [accepted("square"), accepted("curve_speed")]
    kept, lost = after_curve(monkeypatch, every, without)
    assert (kept, lost) == (
        (["curve_speed"], ["square"]) if is_lost else (["square", "curve_speed"], [])
    )


def in_their_place(monkeypatch, every, theirs, curve, doubt=None):
    asked = []

    def score(bare, effects, options):
        asked.append(names_of(bare.candidates))
        return [SimpleNamespace(candidate=accepted("curve_position", w).candidate)
                for w in ("joint", "other joint")]  # fmt: skip

    def refit(bare, scores, *_):
        assert {s.candidate.where for s in scores} == {"joint"}
        new = accepted("curve_position")
        found = model(0.1, *bare.candidates, new.candidate)
        return bare, (replace(new, model=found, criterion=curve, doubt=doubt),)

    monkeypatch.setattr(curve_for_laws, "refitted", lambda whole, rest, *_: model(5.0, *rest))
    monkeypatch.setattr(curve_for_laws, "score_all", score)
    monkeypatch.setattr(curve_for_laws, "refit_contenders", refit)
    monkeypatch.setattr(curve_for_laws, "count_windows", lambda m: 100)
    monkeypatch.setattr(curve_for_laws, "all_gains", lambda parent, m: np.zeros(3))
    monkeypatch.setattr(curve_for_laws, "evidence", lambda *_: np.array([[theirs]]))
    whole = model(0.2, *(a.candidate for a in every))
    effects = [accepted("curve_position").candidate.effect]
    begun = state(whole, every, effects)
    new, kept, lost = curve_for_laws.curve_for_laws(begun, lambda line: None)
    assert names_of(new.candidates) == names(kept)
    assert all(a.doubt == "drawn" for a in lost)
    return names(kept), names(lost), asked


def names_of(candidates):
    return [c.effect.name for c in candidates]


TWO = [accepted("cogging"), accepted("delay", hook="input"), accepted("uneven", hook="friction")]


def test_a_curve_with_more_evidence_than_two_laws_stands_in_their_place(monkeypatch):
    found = in_their_place(monkeypatch, TWO, 300.0, 400.0)
    assert found == (["delay", "curve_position"], ["cogging", "uneven"], [["delay"]])


@pytest.mark.parametrize(("curve", "doubt"), [(290.0, None), (400.0, "chance")])
def test_laws_stay_whose_evidence_is_more_or_whose_curve_is_not_proven(monkeypatch, curve, doubt):
    kept, lost, _ = in_their_place(monkeypatch, TWO, 300.0, curve, doubt)
    assert (kept, lost) == (names(TWO), [])


@pytest.mark.parametrize(("name", "std", "has"), [
    ("curve_speed", 0.5, True), ("square", 0.5, False), ("square", 0.01, True),
    ("curve_speed", 1e-9, True),
])  # fmt: skip
def test_a_law_needs_a_size_that_is_known_and_a_curve_a_size(name, std, has):
    candidate = accepted(name).candidate
    (size,) = candidate.free
    for value, is_there in ((0.3, has), (0.0, False)):
        fit = SimpleNamespace(
            values={size: value}, problem=SimpleNamespace(names=(size,)), std={size: std}
        )
        whole = SimpleNamespace(std={size: std}, fit=fit, candidates=(candidate,))
        assert has_size(whole, DiscoveryOptions()) == is_there


def test_laws_behind_a_curve_go_and_the_rest_is_refitted_once(monkeypatch):
    refits, told = [], []

    def refit(whole, candidates, base, confirm):
        refits.append(names_of(candidates))
        return model(1.0, *candidates)

    monkeypatch.setattr(drop_beside_curves, "refitted", refit)
    every = [accepted(n) for n in ("offset", "curve_time", "cogging", "curve_before", "stiffness")]
    whole = model(1.0, *(a.candidate for a in every))
    new, stay, lost = drop_beside_curves.drop_beside_curves(state(whole, every), told.append)
    assert names(stay) == names_of(new.candidates) == ["offset", "curve_time", "curve_before"]
    assert refits == [names(stay)]
    assert [replace(a, doubt=None) for a in lost] == [a for a in every if a not in stay]
    assert all(a.doubt == "curve" for a in lost)
    assert len(told) == len(lost)
