"""Two effects of which neither is proven without the other are found together, or not at all."""

import pytest
from discovery_cases import EFFECTS, base, record, slider, wander

from identification.discovery.fitted_model import fit_model, is_confirmed, score_candidates
from identification.discovery.scoring.sensitivities import columns, common
from identification.discovery.search import discover
from identification.discovery.selection.forward_selection import select_effect
from identification.discovery.selection.pairs import find_pair

OFFSET, RUBBING = {"offset.f": -0.8}, {"rubbing.c": 1.0}


def log(**sizes):
    error = wander(500, 0.03, 0.1, seed=8)
    robot = slider(mass=2.2, damping=2.7, x0=0.01, v0=0.02, **sizes)
    return record(robot, 500, seed=11, error=error)


def searched(**sizes):
    """The nominal model, the one with the best effect, and the sensitivities of all."""
    step = fit_model(base(), log(**sizes), (), {})
    sensed = columns(step.refit.point, common(EFFECTS))
    new, *_ = select_effect(
        base(), log(**sizes), step, score_candidates(step, sensed), lambda line: None
    )
    return step, new.step, sensed


def test_each_is_proven_beside_the_other():
    step, first, sensed = searched(**OFFSET, **RUBBING)
    found = find_pair(base(), log(**OFFSET, **RUBBING), step, first, sensed, lambda line: None)
    assert {a.step.candidates[-1].effect.name for a in found} == {"offset", "rubbing"}
    assert all(is_confirmed(a.proof) for a in found)
    assert len(found[-1].step.candidates) == 2


@pytest.mark.parametrize("alone", [OFFSET, RUBBING])
def test_one_effect_gets_no_companion(alone):
    step, first, sensed = searched(**alone)
    assert find_pair(base(), log(**alone), step, first, sensed, lambda line: None) == ()


@pytest.mark.parametrize(("sizes", "names"), [({**OFFSET, **RUBBING}, {"offset", "rubbing"}),
                                              (OFFSET, set())])  # fmt: skip
def test_a_search_goes_on_from_what_is_not_proven_alone(monkeypatch, sizes, names):
    def doubtful(base, whole, step, *rest):
        new, rejected, hopeful = select_effect(base, whole, step, *rest)
        if not step.candidates:  # nothing is proven alone
            return None, rejected, new.step
        return new, rejected, hopeful

    monkeypatch.setattr("identification.discovery.search.select_effect", doubtful)
    answer = discover(base(), log(**sizes), EFFECTS)
    assert {n.candidate.effect.name for n in answer.named} == names
