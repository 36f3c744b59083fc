"""A law that was found beside a curve which is still there is told, and not named."""

from dataclasses import dataclass, replace
from types import SimpleNamespace

import pytest

from identification.effects.effect import Candidate, Effect, Size
from identification.prediction.moves import drop_beside_curves

SIZES = (Size("c", "N", 1.0, 0.1, about=""),)


@dataclass(frozen=True)
class Accepted:
    """What a contender is asked here."""

    candidate: Candidate
    doubt: str | None = None


def accepted(*names):
    return [Accepted(Candidate(Effect(n, "", SIZES, places={"joint": ""}), "joint", {}))
            for n in names]  # fmt: skip


@pytest.fixture
def kept(monkeypatch):
    """Names that stay, names that are in doubt, and what was refitted."""

    def of(*names, cannot=False):
        refits, told = [], []

        def refit(model, candidates, base, confirm):
            refits.append([c.effect.name for c in candidates])
            return None if cannot else SimpleNamespace(candidates=candidates)

        monkeypatch.setattr(drop_beside_curves, "refitted", refit)
        every = accepted(*names)
        model = SimpleNamespace(candidates=[a.candidate for a in every])
        task = SimpleNamespace(nominal_model=None, confirm=())
        state = SimpleNamespace(model=model, accepted=tuple(every), task=task)
        new, stay, lost = drop_beside_curves.drop_beside_curves(state, told.append)
        assert (new is model) == (not lost)
        assert all(a.doubt == "curve" for a in lost)
        assert [replace(a, doubt=None) for a in lost] == [a for a in every if a not in stay]
        assert len(told) == len(lost)
        return [a.candidate.effect.name for a in stay], refits

    return of


def test_laws_alone_and_laws_before_a_curve_stay_as_they_are(kept):
    assert kept("cogging", "offset") == (["cogging", "offset"], [])
    assert kept("cogging", "curve_time") == (["cogging", "curve_time"], [])
    assert kept() == ([], [])


def test_laws_behind_a_curve_go_and_the_rest_is_refitted_once(kept):
    names, refits = kept("offset", "curve_time", "cogging", "curve_before", "stiffness")
    assert names == ["offset", "curve_time", "curve_before"]
    assert refits == [["offset", "curve_time", "curve_before"]]


def test_a_model_that_cannot_be_simulated_without_them_stays_whole(kept):
    names, _ = kept("curve_time", "cogging", cannot=True)
    assert names == ["curve_time", "cogging"]
