"""Effects in doubt leave a model in which others are sure, and stay where none is."""

from types import SimpleNamespace

import pytest

from identification.discovery.effect_results import Neighbour
from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import CURVE, Candidate, Effect
from identification.effects.sizes import Size
from identification.prediction.judging.trial import Contender
from identification.prediction.moves import drop_doubtful
from identification.prediction.task import RecordsTask, WindowSearch

SIZES = (Size("c", "N", 1.0, 0.1, about=""),)
N = "neighbour"


def model(*candidates):
    return SimpleNamespace(candidates=[*candidates])


def accepted(name):
    candidate = Candidate(Effect(name, "", SIZES, places={"joint": ""}, hooks={}), "joint", {})
    return Contender(
        model=model(candidate),
        prediction=None,
        gains=None,
        numbers=1,
        criterion=1.0,
        explained=1.0,
        doubt=None,
    )


def state(*names, without=()):
    every = tuple(accepted(CURVE * name.isupper() + name) for name in names)
    task = RecordsTask(
        nominal_model=None, effects=(), options=DiscoveryOptions(without=without), records=()
    )  # fmt: skip
    whole = model(*(a.candidate for a in every))
    return WindowSearch(
        task=task, moves=(), nominal=model(), nominal_scores=(), model=whole, accepted=every,
        scores=(), rejected=(), seconds={}, begun=None,
    )  # fmt: skip


def letter(a):
    return a.candidate.effect.name[-1]


def after(monkeypatch, doubts, parts="", shares=(), begun=None):
    """The names that stay, and those that are lost with their doubts.

    Args:
        monkeypatch: of pytest.
        doubts: of each effect, None for a sure one; a curve has a capital letter.
        parts: pairs "ab": while b is in doubt, it may be a part of what a misses.
        shares: of what smooth forces could, by effect, and what speaks for each.
        begun: the state; one of these effects when None.
    """
    begun = begun or state(*doubts)
    named = [
        SimpleNamespace(candidate=a.candidate, smooth_share=share, evidence=evidence)
        for a, (share, evidence) in zip(begun.accepted, shares, strict=False)
    ]
    pairs = parts.split()

    def beside(law, state, stick, doubtful=()):
        is_part = any(letter(law) + letter(d) in pairs for d in doubtful)
        return Neighbour("curve", "joint", 0.5, 0.0, 0.5 if is_part else 0.01)

    monkeypatch.setattr(drop_doubtful, "names_of", lambda *given: (named, None))
    monkeypatch.setattr(drop_doubtful, "forbidden_of", lambda state: ())
    monkeypatch.setattr(drop_doubtful, "is_off", lambda *given: True)
    monkeypatch.setattr(drop_doubtful, "doubts_of_names", lambda *given: tuple(doubts.values()))
    monkeypatch.setattr(drop_doubtful, "neighbour_of", beside)
    monkeypatch.setattr(drop_doubtful, "refitted", lambda old, rest, base, confirm: model(*rest))
    monkeypatch.setattr(drop_doubtful, "score_all", lambda *given: ("again",))
    new = drop_doubtful.drop_doubtful(begun, lambda line: None)
    assert (new is begun) == (new.scores == ())
    assert [*map(letter, new.accepted)] == [c.effect.name[-1] for c in new.model.candidates]
    if new is not begun:  # judged beside all effects, and not again in the smaller model
        assert all(a.neighbour.of_both == 0.01 for a in new.accepted)
    return "".join(map(letter, new.accepted)), [(letter(a), a.doubt) for a in new.rejected]


@pytest.mark.parametrize(("doubts", "parts", "kept", "lost"), [
    ({"a": None, "b": None}, "", "ab", []),
    ({"a": None, "b": N}, "", "a", [("b", N)]),
    ({"a": "odds", "b": None}, "", "b", [("a", "odds")]),
    # what is in doubt may be a part of what another law misses
    ({"a": None, "b": N}, "ab", "ab", []),
    ({"a": None, "b": N, "c": None}, "ab", "c", [("a", N), ("b", N)]),
    ({"a": None, "b": N, "c": None}, "ab ca", "abc", []),
    ({"a": N, "b": N}, "", "ab", []),
    # a curve alone would draw what the law explains, too
    ({"a": N, "C": None}, "", "aC", []),
    ({"a": N, "b": None, "C": None}, "", "bC", [("a", N)]),
])  # fmt: skip
def test_what_is_sure_stays_without_what_is_in_doubt(monkeypatch, doubts, parts, kept, lost):
    assert after(monkeypatch, doubts, parts) == (kept, lost)


@pytest.mark.parametrize(("shares", "kept", "lost"), [
    ([(0.99, 9.0), (0.95, 5.0)], "ab", []),
    ([(0.99, 9.0), (0.90, 5.0)], "a", [("b", "further")]),
    # the one with the most evidence need not be exact, wherever it stands
    ([(0.90, 5.0), (0.99, 9.0)], "b", [("a", "further")]),
    ([(0.88, 9.0), (0.99, 5.0)], "ab", []),
    ([(0.88, 9.0), (0.91, 5.0), (0.90, 7.0)], "a", [("b", "further"), ("c", "further")]),
    # one of a body or an input has no smooth force of its own
    ([(0.99, 9.0), (None, 5.0)], "ab", []),
])  # fmt: skip
def test_a_further_law_explains_nearly_all_that_smooth_forces_could(
    monkeypatch, shares, kept, lost
):
    sure = dict.fromkeys("abc"[: len(shares)])
    assert after(monkeypatch, sure, shares=shares) == (kept, lost)
    begun = state(*sure, without=("further_laws",))
    assert after(monkeypatch, sure, shares=shares, begun=begun) == ("abc"[: len(shares)], [])


@pytest.mark.parametrize(("share", "kept"), [(0.4, "a"), (0.6, "aB")])
def test_a_curve_beside_a_law_explains_half_of_what_smooth_forces_could(monkeypatch, share, kept):
    shares, sure = [(0.99, 9.0), (share, 5.0)], {"a": None, "B": None}
    assert after(monkeypatch, sure, shares=shares) == (kept, [("B", "further")] * (kept == "a"))
    begun = state(*sure, without=("further_laws",))
    assert after(monkeypatch, sure, shares=shares, begun=begun) == ("aB", [])


def test_one_effect_is_not_asked_because_nothing_would_stay(monkeypatch):
    monkeypatch.setattr(drop_doubtful, "names_of", lambda *given: pytest.fail("it is asked"))
    begun = state("a")
    assert drop_doubtful.drop_doubtful(begun, lambda line: None) is begun


def test_no_effect_is_lost_where_the_others_cannot_be_fitted_alone(monkeypatch):
    monkeypatch.setattr(drop_doubtful, "sure_and_doubtful", lambda state: (
        [*state.accepted[:1]], [*state.accepted[1:]]
    ))  # fmt: skip
    monkeypatch.setattr(drop_doubtful, "refitted", lambda *given: None)
    begun = state("a", "b")
    assert drop_doubtful.drop_doubtful(begun, lambda line: None) is begun
