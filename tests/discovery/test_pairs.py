"""Two effects of which neither is proven without the other are found together, or not at all."""

import pytest
from discovery_cases import EFFECTS, OPTIONS, nominal_model, record, slider, task, wander

from identification.discovery.fitted_model import fit_model, is_confirmed, score_candidates
from identification.discovery.scoring.sensitivities import compute_sensitivities, list_common
from identification.discovery.search import discover
from identification.discovery.selection.forward_selection import Selection, select_effect
from identification.discovery.selection.pairs import find_pair

OFFSET, RUBBING = {"offset.f": -0.8}, {"rubbing.c": 1.0}


def log(**sizes):
    error = wander(500, 0.03, 0.1, seed=8)
    robot = slider(mass=2.2, damping=2.7, x0=0.01, v0=0.02, **sizes)
    return record(robot, 500, seed=11, error=error)


def pair(**sizes):
    """The nominal fit, and what is found beside the best effect, taken as not proven."""
    asked = task(log(**sizes))
    nominal = fit_model(asked, (), {})
    sensitivities = compute_sensitivities(nominal.refit.point, list_common(EFFECTS))
    scores = score_candidates(nominal, sensitivities, OPTIONS)
    (first,) = select_effect(asked, nominal, scores, print).accepted
    return find_pair(asked, nominal, first.model, sensitivities, print)


def test_each_is_proven_beside_the_other():
    found = pair(**OFFSET, **RUBBING)
    assert {a.candidate.effect.name for a in found} == {"offset", "rubbing"}
    assert all(is_confirmed(a.proof, OPTIONS) for a in found)
    assert len(found[-1].model.candidates) == 2


@pytest.mark.parametrize("alone", [OFFSET, RUBBING])
def test_one_effect_gets_no_companion(alone):
    assert pair(**alone) == ()


@pytest.mark.parametrize(("sizes", "names"), [({**OFFSET, **RUBBING}, {"offset", "rubbing"}),
                                              (OFFSET, set())])  # fmt: skip
def test_a_search_goes_on_from_what_is_not_proven_alone(monkeypatch, sizes, names):
    def doubtful(asked, model, *rest):
        selection = select_effect(asked, model, *rest)
        if model.candidates:
            return selection
        return Selection(unproven=selection.accepted[0].model)  # nothing is proven alone

    monkeypatch.setattr("identification.discovery.state.select_effect", doubtful)
    answer = discover(nominal_model(), log(**sizes), EFFECTS)
    assert {n.candidate.effect.name for n in answer.named} == names
