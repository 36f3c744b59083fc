"""A law whose work a curve does that was found later at its joint is told, and not named."""

from dataclasses import dataclass
from types import SimpleNamespace

import pytest
from numba import njit

from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Candidate, Effect
from identification.effects.sizes import Size
from identification.prediction.moves import drop_drawn_laws
from identification.prediction.trial import has_size

LAW = njit(lambda s, p: 0.0)
SIZES = (Size("c", "N", 1.0, 0.1, about=""),)


def model(square, *candidates):
    return SimpleNamespace(candidates=list(candidates), fitted_power=square)


@dataclass(frozen=True)
class Accepted:
    """What a contender is asked here."""

    candidate: Candidate
    model: SimpleNamespace = None
    explained: float = 9.0
    doubt: str | None = None
    criterion: float = 0.0

    @property
    def is_proven(self):
        return self.doubt is None


def accepted(name, where="joint", hook="force"):
    effect = Effect(name, "", SIZES, places={where: ""}, hooks={hook: LAW})
    return Accepted(Candidate(effect, where, {}), model(1.0))


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
