"""A law that leaves much to a curve of the data has the name of a neighbour of what is missing."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import pytest
from joint_cases import arm
from records_cases import FREE, nominal_model, pendulum, records, roles
from records_cases import with_law as fitted_with

from identification.discovery.candidates import list_common
from identification.discovery.effect_results import Neighbour
from identification.discovery.options import DiscoveryOptions
from identification.effects.axes import Axis
from identification.effects.catalogue import joint_effects
from identification.effects.effect import Candidate
from identification.effects.plant.joint_plant import candidates
from identification.prediction.fits.nominal_fit import fit_nominal
from identification.prediction.verdict.neighbours import (
    MOST_OF_BOTH,
    Explained,
    _may_be_of,
    explained_by,
    find_neighbour,
    has_neighbours_name,
    share_a_joint,
)
from identification.prediction.verdict.yardstick import measure

LAWS = ("hardening", "stiffness", "offset")
EFFECTS = [e for e in candidates(pendulum(), FREE) if e.is_curve or e.name in LAWS]
OPTIONS = DiscoveryOptions()
WITHOUT = DiscoveryOptions(without=("neighbours_names",))
STIFF = 0.06  # of a spring that hardens [N m/rad³]


@cache
def logs():
    return roles(records(4, {"hardening.k_3@hinge": STIFF}, samples=500))


@cache
def with_law(name):
    """The fit without effects, and with one law."""
    bare = fit_nominal(nominal_model(), logs())
    return bare, fitted_with(bare, name, logs())


def test_gravity_at_all_joints_shares_none_with_a_vertical_axis():
    axes = [Axis(joint=j, kind="hinge", force=1.0, speed=1.0, travel=1.0, plain=True,
                 heavy=j != "pan", duration=1.0) for j in ("pan", "lift", "flex")]  # fmt: skip
    of = {(e.name, at): Candidate(e, at, {}) for e in joint_effects(axes) for at in e.places}
    gravity, drag = of["gravity_force", "all joints"], of["quadratic_friction", "all joints"]
    for joint, is_shared in (("pan", False), ("lift", True), ("flex", True)):
        stiff = of["hardening", f"joint {joint}"]
        assert share_a_joint(gravity, stiff) == share_a_joint(stiff, gravity) == is_shared
        assert share_a_joint(drag, stiff)
    assert share_a_joint(gravity, drag)


@cache
def forces_beside(name):
    return measure(with_law(name)[1], EFFECTS)


def neighbour_of(name):
    bare, model = with_law(name)
    explained = Explained((bare.fit.cost - model.fit.cost) / model.fit.cost)
    return find_neighbour(model.candidates[-1], explained, forces_beside(name))


def test_the_right_law_leaves_luck_to_a_curve_and_its_neighbour_leaves_the_pattern():
    right, wrong = neighbour_of("hardening"), neighbour_of("stiffness")
    assert not has_neighbours_name(right, OPTIONS)
    assert (wrong.curve, wrong.where) == ("curve_position", "joint hinge")
    assert wrong.of_both > MOST_OF_BOTH > 10 * right.of_both
    assert wrong.chance < 1e-4
    assert has_neighbours_name(wrong, OPTIONS)
    assert not has_neighbours_name(wrong, WITHOUT)


@pytest.mark.parametrize(("chance", "of_both", "has"), [
    (0.6, 0.5, False), (1e-9, 0.9 * MOST_OF_BOTH, False), (0.4, 1.1 * MOST_OF_BOTH, True),
])  # fmt: skip
def test_what_may_be_luck_or_is_little_is_no_reason_against_a_law(chance, of_both, has):
    found = Neighbour("curve_speed", "joint a", 0.5, chance, of_both)
    assert has_neighbours_name(found, OPTIONS) == has
    assert not has_neighbours_name(None, OPTIONS)


def test_the_chance_is_paid_for_by_the_number_of_curves_at_the_joint():
    _, model = with_law("offset")
    forces = forces_beside("offset")
    curves = forces.curves
    found = find_neighbour(model.candidates[-1], Explained(9.0), forces)
    assert len(curves) > 2
    assert found.chance == pytest.approx(len(curves) * min(s.p_value for s in curves))
    assert found.of_both == pytest.approx(found.share / (9.0 + found.share))
    assert find_neighbour(curves[0].candidate, Explained(9.0), forces) is None
    assert find_neighbour(model.candidates[-1], Explained(9.0), None) is None


def test_what_a_curve_of_the_model_explains_counts_as_what_is_beside_a_law():
    """The law would else look exact, because the curve has taken away what it misses."""
    _, model = with_law("stiffness")
    forces = forces_beside("stiffness")
    law = model.candidates[-1]
    alone = find_neighbour(law, Explained(9.0), forces)
    beside = find_neighbour(law, Explained(9.0, 3.0, 1e-6), forces)
    assert beside.of_both == pytest.approx((3 + alone.share) / (12 + alone.share))
    assert beside.chance <= 1e-6
    luck = replace(alone, share=0.0, chance=1.0, of_both=Explained(9.0).of_both(0.0))
    assert not has_neighbours_name(luck, OPTIONS)
    assert Explained(0.0).of_both(0.0) == 0.0


@pytest.mark.parametrize(("law", "curve", "counts"), [
    ("coulomb_friction", "curve_speed", True),
    ("coulomb_friction", "curve_position", False),  # another force that is missing
    ("hardening", "curve_position", True),
    ("offset", "curve_position", True),  # any curve may draw a constant
    ("delay", "curve_speed", True),
    ("delay", "curve_position", False),  # an input that is late is no force of the position
])  # fmt: skip
def test_a_curve_of_the_model_counts_where_it_may_draw_what_the_law_misses(law, curve, counts):
    known = {e.name: e for e in candidates(pendulum(), FREE)}
    model = SimpleNamespace(fitted_power=1.0)

    def found(name):
        (c, *_) = list_common([known[name]])
        return SimpleNamespace(
            candidate=c, explained=3.0, prediction=SimpleNamespace(chance=1e-6)
        )  # fmt: skip

    both = [found(law), found(curve)]
    explained = explained_by(both[0], both, model)
    assert explained.law == 3.0
    assert (explained.curves, explained.chance) == ((3.0, 1e-6) if counts else (0.0, 1.0))


@pytest.mark.parametrize(("law", "other", "counted"), [
    ((1.0, 0.0), (1.0, 0.0), 3.0),
    ((1.0, 0.0), (0.0, 1.0), 0.0),  # of an output that the law does not move
    ((1.0, 0.0), (0.5, 0.5), 1.5),
    ((0.5, 0.5), (0.0, 1.0), 3.0),
    ((0.8, 0.2), (0.0, 1.0), 0.75),
    ((), (0.0, 1.0), 3.0),  # not known
])  # fmt: skip
def test_what_is_beside_a_law_counts_at_the_outputs_that_the_law_moves(law, other, counted):
    known = {e.name: e for e in candidates(pendulum(), FREE)}

    def found(name, outputs):
        (c, *_) = list_common([known[name]])
        return SimpleNamespace(
            candidate=c, explained=3.0, prediction=SimpleNamespace(chance=1e-6), outputs=outputs
        )  # fmt: skip

    both = [found("encoder_scale", law), found("hardening", other)]
    explained = explained_by(both[0], both, SimpleNamespace(fitted_power=1.0), both[1:])
    assert explained.curves == pytest.approx(counted)


def test_a_law_of_a_sensor_is_one_of_the_joint_that_it_measures():
    every = {e.name: e for e in candidates(arm(), ())}
    zero = Candidate(every["encoder_offset"], "sensor b", {})
    stiff = [Candidate(every["hardening"], f"joint {j}", {}) for j in ("shoulder", "elbow")]
    assert [share_a_joint(zero, c) for c in stiff] == [False, True]


@pytest.mark.parametrize(("law", "doubtful", "counts"), [
    ("coulomb_friction", "asymmetric_viscous_friction", True),
    ("coulomb_friction", "offset", False),
    ("coulomb_friction", "encoder_offset", False),  # it acts as a force of the position
    ("coulomb_friction", "delay", True),  # an input that is late acts as a damping
    ("hardening", "encoder_offset", True),
    ("hardening", "quadratic_friction", False),
    ("offset", "stiffness", True),
    ("encoder_offset", "offset", True),  # what is not of a joint has no variables of its own
])  # fmt: skip
def test_an_effect_without_a_sure_name_may_be_what_a_law_misses(law, doubtful, counts):
    known = {e.name: next(iter(list_common([e]))) for e in candidates(pendulum(), FREE)}
    assert _may_be_of(known[doubtful], known[law]) == counts
