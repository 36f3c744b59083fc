"""Effects in doubt leave a model in which others are sure, and stay where none is."""

from types import SimpleNamespace

import pytest

from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import CURVE, Candidate, Effect
from identification.effects.sizes import Size
from identification.prediction.moves import drop_doubtful
from identification.prediction.task import RecordsTask, WindowSearch
from identification.prediction.trial import Contender

SIZES = (Size("c", "N", 1.0, 0.1, about=""),)


def model(*candidates):
    return SimpleNamespace(candidates=[*candidates])


def accepted(name):
    candidate = Candidate(Effect(name, "", SIZES, places={"joint": ""}, hooks={}), "joint", {})
    return Contender(
        model=model(candidate), prediction=None, gains=None, numbers=1, criterion=1.0, doubt=None
    )


def state(*names):
    every = tuple(accepted(CURVE * name.isupper() + name) for name in names)
    task = RecordsTask(
        nominal_model=None, effects=(), options=DiscoveryOptions(), records=()
    )  # fmt: skip
    whole = model(*(a.candidate for a in every))
    return WindowSearch(
        task=task, moves=(), nominal=model(), nominal_scores=(), model=whole, accepted=every,
        scores=(), rejected=(), seconds={}, begun=None,
    )  # fmt: skip


def letters(found):
    return "".join(c.effect.name[-1] for c in found)


def after(monkeypatch, doubts, *names):
    """The names that stay, and those that are lost with their doubts.

    Doubts are those of each set of effects that is asked, by the joined names of its effects.
    """
    asked = []

    def of(now):
        kept = letters(a.candidate for a in now.accepted)
        assert kept == letters(now.model.candidates)
        asked.append(kept)
        return doubts[kept]

    monkeypatch.setattr(drop_doubtful, "_doubts", of)
    monkeypatch.setattr(drop_doubtful, "refitted", lambda old, rest, base, confirm: model(*rest))
    monkeypatch.setattr(drop_doubtful, "score_all", lambda *given: ("again",))
    begun = state(*names)
    new = drop_doubtful.drop_doubtful(begun, lambda line: None)
    assert (new is begun) == (new.scores == ())
    kept = letters(a.candidate for a in new.accepted)
    return kept, [(a.candidate.effect.name, a.doubt) for a in new.rejected], asked


N = "neighbour"


@pytest.mark.parametrize(("doubts", "names", "kept", "lost"), [
    ({"ab": (None, None)}, "ab", "ab", []),
    ({"ab": (None, N), "a": (None,)}, "ab", "a", [("b", N)]),
    ({"ab": (N, None), "b": (None,)}, "ab", "b", [("a", N)]),
    # what was hidden by the doubtful one speaks against the other
    ({"ab": (None, N), "a": (N,)}, "ab", "ab", []),
    # all are in doubt: the last one may be the reason
    ({"ab": (N, "odds"), "a": (None,)}, "ab", "a", [("b", "odds")]),
    ({"abc": (N, N, N), "ab": (None, "mass"), "a": (None,)}, "abc", "a", [("b", "mass"), ("c", N)]),
    # a curve alone would draw what the law explains, too
    ({"aC": (N, None)}, "aC", "aC", []),
    ({"abC": (N, None, None), "bC": (None, None)}, "abC", "bC", [("a", N)]),
    ({"abc": (N, N, N), "ab": (N, N), "a": (N,)}, "abc", "abc", []),
])  # fmt: skip
def test_what_is_sure_stays_without_what_is_in_doubt(monkeypatch, doubts, names, kept, lost):
    stays, gone, asked = after(monkeypatch, doubts, *names)
    assert stays == kept
    assert gone == lost
    assert asked == [*doubts]


def test_one_effect_is_not_asked_because_nothing_would_stay(monkeypatch):
    assert after(monkeypatch, {}, "a") == ("a", [], [])


def test_no_effect_is_lost_where_the_others_cannot_be_fitted_alone(monkeypatch):
    monkeypatch.setattr(drop_doubtful, "_doubts", lambda now: (None, N))
    monkeypatch.setattr(drop_doubtful, "refitted", lambda *given: None)
    begun = state("a", "b")
    assert drop_doubtful.drop_doubtful(begun, lambda line: None) is begun
