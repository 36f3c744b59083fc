"""A likely jump is scored at the times between those that were scored, before any is refitted."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Candidate, Effect
from identification.effects.sizes import Shape, Size
from identification.innovations.moves import forward_selection

JUMP = Effect(
    "jump", "", (Size("c", "", 1.0, 0.1, about=""),),
    (Shape("t_s", "s", (1.0, 2.0, 4.0), 0.1, 9.0, about="", step=0.5),), places={"joint": ""},
    phrase="jump",
)  # fmt: skip

OTHER = replace(JUMP, name="other")


def score(p, gain=100.0, t_s=2.0, effect=JUMP):
    return SimpleNamespace(
        candidate=Candidate(effect, "joint", {"t_s": t_s} if effect.shapes else {}),
        size=np.array([0.5]), gain=gain, p_value=p,
    )  # fmt: skip


@pytest.fixture
def sharpened(monkeypatch):
    """The times at which candidates are scored again."""
    monkeypatch.setattr(forward_selection, "compute_sensitivities", lambda point, some: some)
    monkeypatch.setattr(forward_selection, "score_candidates", lambda model, some, options: some)
    model = SimpleNamespace(
        refit=SimpleNamespace(point=SimpleNamespace(log=None)), innovations=None
    )

    def of(*scores):
        found = forward_selection._sharpen(model, scores, DiscoveryOptions())
        return [c.shape["t_s"] for c in found]

    return of


def test_what_is_beyond_chance_is_scored_between_its_neighbours(sharpened):
    assert sharpened(score(1e-30)) == [1.5, 2.0, 2.5, 3.0, 3.5]


def test_what_is_chance_or_has_no_times_is_not(sharpened):
    assert sharpened(score(0.5)) == []
    assert sharpened(score(1e-30, gain=-1.0)) == []
    assert sharpened(score(1e-30, effect=replace(JUMP, shapes=()))) == []


def test_no_time_of_one_is_compared_with_a_better_time_of_another(monkeypatch):
    """Both are scored anew, and the true one, which was only beyond chance at first, leads."""
    gains = {"jump": 900.0, "other": 500.0}

    def anew(model, some, options):
        return [score(1e-99, gains[c.effect.name], c.shape["t_s"], c.effect) for c in some]

    monkeypatch.setattr(forward_selection, "compute_sensitivities", lambda point, some: some)
    monkeypatch.setattr(forward_selection, "score_candidates", anew)
    begun = (score(1e-30, 100.0), score(1e-30, 95.0, effect=OTHER))
    model = SimpleNamespace(
        refit=SimpleNamespace(point=SimpleNamespace(log=None)), innovations=None
    )
    scores = (*begun, *forward_selection._sharpen(model, begun, DiscoveryOptions()))
    significant = forward_selection.select_significant(scores, DiscoveryOptions())
    first, second = forward_selection._select_contenders(significant, DiscoveryOptions())[:2]
    assert (first.candidate.effect.name, second.candidate.effect.name) == ("jump", "other")
