"""Of kinds of one effect that a log does not tell apart the usual one is taken."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from discovery_cases import OPTIONS

from identification.discovery.scoring.sensitivities import list_between
from identification.discovery.selection import shapes
from identification.discovery.selection.shapes import improve_shape
from identification.effects.effect import Candidate, Effect, Shape, Size
from inca_mj.effects.motor import CURRENT_SATURATION
from inca_mj.studies.worlds import HiddenSetting, effect, world
from inca_mj.workflows.discovery import discover
from inca_mj.workflows.spread import spread_of

BARE = OPTIONS.bare_bic
KINDS = Effect(
    "limit",
    "clip",
    (Size("c", "", 1.0, 0.1),),
    (
        Shape("at", "N", (1.0, 2.0), 0.1, 9.0),
        Shape("soft", "", (0.0, 1.0), 0.0, 1.0, free=False, usual=0.0),
    ),
    places={"joint": ""},
)


def candidate(soft):
    return Candidate(KINDS, "joint", {"at": 1.0, "soft": soft})


def of(soft, negative_bic):
    refit = SimpleNamespace(log_posterior=negative_bic / 2)
    return SimpleNamespace(candidates=(candidate(soft),), negative_bic=negative_bic, refit=refit)


def choose(monkeypatch, best, other, white=True):
    """What becomes of the best fit, and the kinds that were refitted."""
    asked = []

    def fit_shape(asked_of, model, s, least):
        asked.append(s.candidate.shape["soft"])
        behind = [f.refit.log_posterior - least for f in (best, other) if f is not None]
        assert any(0 <= b <= BARE / 2 for b in behind)
        return other

    monkeypatch.setattr(shapes, "is_structured", lambda model, options: not white)
    monkeypatch.setattr(shapes, "_fit_shape", fit_shape)
    gains = {1.0: 20.0, 0.0: 10.0}
    ranked = [SimpleNamespace(candidate=candidate(s), gain=g, size=[1.0]) for s, g in gains.items()]
    more = SimpleNamespace(candidates=(None,))
    return improve_shape(SimpleNamespace(options=OPTIONS), more, best, ranked), asked


@pytest.mark.parametrize(("ahead", "usual"), [(BARE - 0.1, True), (BARE + 0.1, False)])
def test_another_kind_must_be_better_by_more_than_a_bare_mention(monkeypatch, ahead, usual):
    best, other = of(1.0, 100.0 + ahead), of(0.0, 100.0)
    chosen, asked = choose(monkeypatch, best, other)
    assert chosen is (other if usual else best)
    assert asked == [0.0]


def test_the_usual_kind_is_not_refitted_where_it_is_the_best_or_nothing_else_can_be(monkeypatch):
    best = of(0.0, 100.0)
    assert choose(monkeypatch, best, of(1.0, 99.0)) == (best, [])
    best = of(1.0, 100.0)
    assert choose(monkeypatch, best, None) == (best, [0.0])


def test_where_structure_is_left_the_next_kind_is_tried_and_the_likelier_kept(monkeypatch):
    best, other = of(0.0, 100.0), of(1.0, 130.0)
    chosen, asked = choose(monkeypatch, best, other, white=False)
    assert asked[0] == 1.0
    assert chosen is other


@pytest.mark.long
def test_a_limit_that_two_levels_of_current_reach_alike_is_a_hard_one():
    setting = HiddenSetting(duration=4.5)  # PRBS: 0.5 and 1 A
    log, truth = world(71, [replace(effect("current_saturation"), i_max=0.9)], setting=setting)
    assert np.unique(log.inputs).size == 2
    answer = discover(log, effects=(CURRENT_SATURATION,), spread=spread_of("none"))
    (named,) = answer.named
    assert named.candidate.shape["soft"] == 0.0
    assert named.parameters["i_max"][0] == pytest.approx(truth.sizes[0]["i_max"], rel=0.02)


@pytest.mark.parametrize(("here", "first", "last"), [(1.0, 1.25, 1.75), (2.0, 1.25, 3.75)])
def test_between_the_neighbours_of_a_value_all_steps_are_tried(here, first, last):
    late = replace(KINDS, shapes=(Shape("at", "s", (1.0, 2.0, 4.0), 0.1, 9.0, step=0.25),))
    tried = [c.shape["at"] for c in list_between(Candidate(late, "joint", {"at": here}))]
    assert tried == pytest.approx(np.arange(first, last + 0.1, 0.25))
    assert list_between(candidate(0.0)) == ()
