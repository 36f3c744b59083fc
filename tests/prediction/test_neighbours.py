"""A law that leaves much to a curve of the data has the name of a neighbour of what is missing."""

from dataclasses import replace
from functools import cache

import pytest
from records_cases import FREE, HORIZON, nominal_model, pendulum, records

from identification.discovery.candidates import list_common
from identification.discovery.effect_results import Neighbour
from identification.discovery.neighbour import MOST_LEFT
from identification.discovery.options import DiscoveryOptions
from identification.effects.joint_plant import candidates
from identification.prediction.extension import with_effect
from identification.prediction.first_fit import begin
from identification.prediction.moves.curve_for_laws import curve_for_laws
from identification.prediction.neighbours import EXACT, find_neighbour, has_neighbours_name
from identification.prediction.nominal_fit import fit_nominal
from identification.prediction.scores import window_scores
from identification.prediction.screening import score_all
from identification.prediction.selection import judged
from identification.prediction.state import first_state
from identification.prediction.task import RecordsTask
from identification.windows.records import as_records

LAWS = ("hardening", "stiffness", "offset")
EFFECTS = [e for e in candidates(pendulum(), FREE) if e.is_curve or e.name in LAWS]
OPTIONS = DiscoveryOptions()
WITHOUT = DiscoveryOptions(without=("neighbours_names",))
STIFF = 0.06  # of a spring that hardens [N m/rad³]


@cache
def logs():
    made = records(4, {"hardening.k_3@hinge": STIFF}, samples=500)
    return as_records(made[:2], made[2:])


@cache
def with_law(name):
    """The fit without effects, and with one law."""
    bare = fit_nominal(nominal_model(), logs())
    (effect,) = (e for e in EFFECTS if e.name == name)
    (score, *_) = window_scores(bare.fit, list_common([effect]))
    confirm = [r for r in logs() if r.role == "confirm"]
    return bare, with_effect(bare, begin(bare, [score]), HORIZON, confirm)


@cache
def scores_beside(name):
    return score_all(with_law(name)[1], EFFECTS, OPTIONS)


def neighbour_of(name):
    return find_neighbour(with_law(name)[1].candidates[-1], 0.9, scores_beside(name))


def test_the_right_law_leaves_luck_to_a_curve_and_its_neighbour_leaves_the_pattern():
    right, wrong = neighbour_of("hardening"), neighbour_of("stiffness")
    assert not has_neighbours_name(right, OPTIONS)
    assert (wrong.curve, wrong.where) == ("curve_position", "joint hinge")
    assert wrong.share > MOST_LEFT
    assert wrong.chance < 1e-4
    assert has_neighbours_name(wrong, OPTIONS)
    assert not has_neighbours_name(wrong, WITHOUT)


@pytest.mark.parametrize(("share", "chance", "of_both", "has"), [
    (0.5, 0.02, 0.02, False), (0.9 * MOST_LEFT, 1e-9, 0.1, False), (0.9, 1e-9, 0.9 * EXACT, False),
    (1.1 * MOST_LEFT, 1e-3, 1.1 * EXACT, True), (0.5, 0.4, 0.1, True), (0.5, 0.6, 0.1, False),
])  # fmt: skip
def test_what_may_be_luck_or_is_little_is_no_reason_against_a_law(share, chance, of_both, has):
    found = Neighbour("curve_speed", "joint a", share, chance, of_both)
    assert has_neighbours_name(found, OPTIONS) == has
    assert not has_neighbours_name(None, OPTIONS)


def test_without_its_pass_a_law_that_is_far_off_needs_the_same_chance_as_others():
    found = Neighbour("curve_speed", "joint a", 0.5, 0.4, 0.1)
    assert not has_neighbours_name(found, DiscoveryOptions(without=("far_from_exact",)))


def test_the_chance_is_paid_for_by_the_number_of_curves_at_the_joint():
    _, model = with_law("stiffness")
    scores = scores_beside("stiffness")
    curves = [s for s in scores if s.candidate.effect.is_curve]
    found = find_neighbour(model.candidates[-1], 0.9, scores)
    assert len(curves) > 2
    assert found.chance == pytest.approx(len(curves) * min(s.p_value for s in curves))
    left = 0.1 * found.share
    assert found.of_both == pytest.approx(left / (0.9 + left))
    assert find_neighbour(curves[0].candidate, 0.9, scores) is None
    assert find_neighbour(model.candidates[-1], 0.9, []) is None


def test_a_proven_curve_takes_the_place_of_a_neighbours_name():
    bare, model = with_law("stiffness")
    effects = tuple(e for e in EFFECTS if e.name in ("stiffness", "curve_position"))
    task = RecordsTask(
        nominal_model=nominal_model(), records=logs(), effects=effects, options=OPTIONS
    )
    state = first_state(task, lambda line: None)
    law = judged(bare, model, 1, OPTIONS)
    scores = score_all(model, task.effects, OPTIONS)
    state = replace(state, model=model, accepted=(law,), scores=scores)
    _, kept, lost = curve_for_laws(state, lambda line: None)
    assert [a.candidate.effect.name for a in kept] == ["curve_position"]
    assert [a.doubt for a in lost] == ["drawn"]
