"""Two effects of which neither is proven without the other are found together, or not at all."""

import pytest
from discovery_cases import EFFECTS, base, record, slider, wander

from identification.discovery.both import both
from identification.discovery.columns import columns, common
from identification.discovery.forward import add
from identification.discovery.search import discover
from identification.discovery.steps import fitted, holds, scores_of

OFFSET, RUBBING = {"offset.f": -0.8}, {"rubbing.c": 1.0}


def log(**sizes):
    error = wander(500, 0.03, 0.1, seed=8)
    robot = slider(mass=2.2, damping=2.7, x0=0.01, v0=0.02, **sizes)
    return record(robot, 500, seed=11, error=error)


def searched(**sizes):
    """The nominal model, the one with the best effect, and the sensitivities of all."""
    step = fitted(base(), log(**sizes), (), {})
    sensed = columns(step.refit.at, common(EFFECTS))
    new, *_ = add(base(), log(**sizes), step, scores_of(step, sensed), lambda line: None)
    return step, new.step, sensed


def test_each_is_proven_beside_the_other():
    step, first, sensed = searched(**OFFSET, **RUBBING)
    found = both(base(), log(**OFFSET, **RUBBING), step, first, sensed, lambda line: None)
    assert {a.step.candidates[-1].effect.name for a in found} == {"offset", "rubbing"}
    assert all(holds(a.proof) for a in found)
    assert len(found[-1].step.candidates) == 2


@pytest.mark.parametrize("alone", [OFFSET, RUBBING])
def test_one_effect_gets_no_companion(alone):
    step, first, sensed = searched(**alone)
    assert both(base(), log(**alone), step, first, sensed, lambda line: None) == ()


@pytest.mark.parametrize(("sizes", "names"), [({**OFFSET, **RUBBING}, {"offset", "rubbing"}),
                                              (OFFSET, set())])  # fmt: skip
def test_a_search_goes_on_from_what_is_not_proven_alone(monkeypatch, sizes, names):
    def doubtful(base, whole, step, *rest):
        new, rejected, hopeful = add(base, whole, step, *rest)
        if not step.candidates:  # nothing is proven alone
            return None, rejected, new.step
        return new, rejected, hopeful

    monkeypatch.setattr("identification.discovery.search.add", doubtful)
    answer = discover(base(), log(**sizes), EFFECTS)
    assert {n.candidate.effect.name for n in answer.named} == names
