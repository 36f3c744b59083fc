"""Which candidates are refitted, and which comes first."""

from dataclasses import dataclass, field

import numpy as np
import pytest
from numba import njit

from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Candidate, Effect, Shape, Size
from identification.prediction.contenders import count_numbers, list_contenders, list_simpler
from identification.prediction.scores import WindowScore
from identification.prediction.selection import Contender, _ranked
from identification.prediction.unseen import Unseen, compare

OPTIONS = DiscoveryOptions()


@njit
def law(s, p):
    return p[0]


def effect(name, sizes=1, shapes=0, hook="friction", own=False):
    return Effect(
        name, "f", tuple(Size(f"a{k}", "N", 1.0, 0.01) for k in range(sizes)),
        tuple(Shape(f"n{k}", "", (1.0,), 0.5, 2.0) for k in range(shapes)),
        places={"joint a": "@a"}, hooks={hook: law}, own=own,
    )  # fmt: skip


def score(e, fall, p_value=1e-9):
    return WindowScore(
        candidate=Candidate(e, "joint a", {s.name: 1.0 for s in e.shapes}),
        size=np.full(len(e.sizes), 0.1), std=np.full(len(e.sizes), 0.01), fall=fall,
        p_value=p_value,
    )  # fmt: skip


def names(scores):
    return [s.candidate.effect.name for s in scores]


def test_all_that_explain_about_as_much_are_refitted():
    scores = [score(effect(f"e{k}"), fall) for k, fall in enumerate((0.5, 0.45, 0.44, 0.42, 0.2))]
    assert names(list_contenders(scores, OPTIONS, 100)) == ["e0", "e1", "e2", "e3"]
    few = [score(effect(f"e{k}"), fall) for k, fall in enumerate((0.5, 0.3, 0.2, 0.19))]
    assert names(list_contenders(few, OPTIONS, 100)) == ["e0", "e1", "e2"]


@pytest.mark.parametrize(("fall", "is_in"), [(0.55, False), (0.9, True)])
def test_a_curve_is_refitted_where_it_promises_more_than_every_law(fall, is_in):
    scores = [score(effect("curve_speed", sizes=8), fall), score(effect("law"), 0.5)]
    chosen = names(list_contenders(scores, OPTIONS, 100))
    assert ("curve_speed" in chosen) == is_in
    assert "law" in chosen


def test_chance_keeps_a_score_out():
    assert list_contenders([score(effect("e"), 0.5, p_value=0.5)], OPTIONS, 100) == []


def test_simpler_laws_act_as_the_winner_does():
    rich = effect("rich", shapes=1)
    scores = [score(rich, 0.5), score(effect("force", hook="force"), 0.4),
              score(effect("plain"), 0.3), score(effect("as rich", sizes=2), 0.3)]  # fmt: skip
    assert count_numbers(scores[0].candidate) == 2
    assert names(list_simpler(scores[0].candidate, scores, OPTIONS)) == ["plain"]


@dataclass(frozen=True)
class Model:
    """What the ranking sees of a model."""

    unseen: Unseen
    candidates: tuple = ()
    fit: None = field(default=None)


def unseen(level, seed=0):
    rng = np.random.default_rng(seed)
    squares = tuple((level * rng.uniform(0.8, 1.2, 40),) for _ in range(3))
    return Unseen(
        lengths=(0.5, 1.0, 2.0), squares=squares, moves=((), (), ()), floor=1e-3,
        fit_percent=np.zeros(1),
    )  # fmt: skip


def contender(e, level, criterion, seed, is_proven=True):
    model = Model(unseen(level, seed), (score(e, 0.5).candidate,))
    return Contender(
        model=model, prediction=compare(unseen(1.0), model.unseen), criterion=criterion,
        is_proven=is_proven,
    )  # fmt: skip


def ranked(*contenders):
    return [c.candidate.effect.name for c in _ranked(contenders, 3, OPTIONS)]


def test_fewer_numbers_come_first_where_unseen_records_cannot_tell():
    rich = contender(effect("rich", shapes=1), 0.30, 105.0, seed=1)
    plain = contender(effect("plain"), 0.305, 100.0, seed=2)
    assert ranked(rich, plain) == ["plain", "rich"]


def test_more_numbers_come_first_where_unseen_records_or_the_criterion_tell():
    rich = contender(effect("rich", shapes=1), 0.1, 105.0, seed=1)
    plain = contender(effect("plain"), 0.3, 100.0, seed=2)
    assert ranked(rich, plain) == ["rich", "plain"]
    sure = contender(effect("rich", shapes=1), 0.30, 140.0, seed=1)
    assert ranked(sure, plain) == ["rich", "plain"]


def test_what_is_not_proven_comes_last():
    worse = contender(effect("plain"), 0.3, 200.0, seed=2, is_proven=False)
    rich = contender(effect("rich", shapes=1), 0.3, 100.0, seed=1)
    assert ranked(worse, rich) == ["rich", "plain"]


def test_what_all_records_share_comes_before_what_each_has_for_itself():
    own = contender(effect("shift", own=True), 0.3, 101.0, seed=1)
    shared = contender(effect("delay"), 0.3, 100.0, seed=2)
    assert ranked(own, shared) == ["delay", "shift"]
