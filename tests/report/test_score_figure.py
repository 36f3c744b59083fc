"""The bars of what each effect would explain: what is named stands at the place of its name."""

from types import SimpleNamespace as Made

from identification.effects.effect import Candidate
from identification.report import discovery_figures
from inca_mj.effects.change import MISMATCHES
from inca_mj.effects.motor import DELAY, STRIBECK_FRICTION

OTHER, *_ = MISMATCHES


def score(effect, where, explains):
    return Made(candidate=Candidate(effect, where, {}), explains=explains)


def bars(monkeypatch, named, scores, best):
    """Returns the places of the bars, their lengths, and which are of named effects."""
    monkeypatch.setattr(discovery_figures, "describe_there", lambda c, plant: (c.effect, c.where))
    monkeypatch.setattr(discovery_figures, "gains_figure", lambda *drawn: drawn)
    found = Made(named=named, scores=scores, final=Made(plant=None))
    ((_, (labels, gains, is_named, _)),) = discovery_figures.score_figures(found, best, "", "")
    return [*zip(labels, gains.tolist(), is_named, strict=True)]


def test_a_named_effect_is_shown_at_its_place_and_bars_fall(monkeypatch):
    best = [score(STRIBECK_FRICTION, "all drives", 0.9), score(DELAY, "all drives", 0.7),
            score(OTHER, "drive 2", 0.3)]  # fmt: skip
    there = score(STRIBECK_FRICTION, "drive 5", 0.5)
    name = Made(candidate=Candidate(STRIBECK_FRICTION, "drive 5", {"v_s": 2.4}), one_of=False,
                rivals=(Made(candidate=best[1].candidate),))  # fmt: skip
    assert bars(monkeypatch, [name], [*best, there], best) == [
        ((DELAY, "all drives"), 0.7, False),
        ((STRIBECK_FRICTION, "drive 5"), 0.5, True),
        ((OTHER, "drive 2"), 0.3, False),
    ]
    # What cannot be told from it is named with it, at a place that may have no score.
    name.one_of, name.rivals = True, (Made(candidate=Candidate(DELAY, "drive 5", {})),)
    drawn = bars(monkeypatch, [name], best, best)
    assert [(at, is_named) for (_, at), _, is_named in drawn] == [
        ("all drives", True), ("all drives", True), ("drive 2", False),
    ]  # fmt: skip
    assert bars(monkeypatch, [], best, best)[0] == ((STRIBECK_FRICTION, "all drives"), 0.9, False)
