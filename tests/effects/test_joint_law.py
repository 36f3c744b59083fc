"""Sets of effects of the catalogue share one compiled law, which moves a robot as its own would."""

from dataclasses import replace

import numpy as np
import pytest
from joint_cases import ARM, SLIDER, arm_log, slider_log, steps

from identification.effects.axes import axes
from identification.effects.catalogue import joint_effects
from identification.effects.plant import rows
from identification.effects.plant.joint_law import JointTerms, _listed, joint_terms
from identification.effects.plant.joint_plant import joint_plant
from identification.effects.plant.rows import JointLayout
from identification.effects.values import terms_of
from identification.model.predictor import Predictor
from identification.native.joints.joint_callback import JOINT

VALUES = {"coulomb_friction.f_c@elbow": 0.05, "stiffness.k": 0.4, "cogging.a@shoulder": 0.1}


def arm_effects(*names):
    log = arm_log(steps(80, 2))
    known = axes(rows.read_model(ARM).compile(), log)
    return tuple(e for e in joint_effects(known) if not names or e.name in names)


def outputs(effects):
    log = arm_log(steps(80, 2))
    plant = joint_plant(ARM, (), log, effects=effects)
    return Predictor(plant, log, tuple(VALUES)).predict(np.array([[*VALUES.values()]]))[0]


def test_a_set_moves_a_robot_to_the_bit_as_its_own_law_does(monkeypatch):
    effects = arm_effects("coulomb_friction", "stiffness", "cogging")
    shared = outputs(effects)
    monkeypatch.setattr(rows, "joint_terms", lambda own: JointTerms(own, own))
    np.testing.assert_array_equal(shared, outputs(effects))


def test_different_sets_have_one_law_and_each_parameter_a_column_of_its_own():
    every = JointLayout(arm_effects())
    for names in (("stiffness",), ("cogging", "offset"), ("curve_speed", "push")):
        some = JointLayout(arm_effects(*names))
        assert (some.key, some.entries, some.terms.law) == (
            every.key, every.entries, every.terms.law,
        )  # fmt: skip
        columns = {t.effect: t.column for t in every.on_joints}
        assert {t.effect: t.column for t in some.on_joints} == {n: columns[n] for n in names}
    assert JointLayout(arm_effects("stiffness"), has_states=True).key != every.key


def test_columns_of_a_robot_with_each_law_twice_do_not_overlap():
    once = _listed(False)
    twice = [*once, *(replace(t, effect=f"slide_{t.effect}") for t in once)]
    found = joint_terms(tuple(twice))
    spans = [range(t.column, t.column + len(t.names)) for t in found.own]
    assert len({c for span in spans for c in span}) == sum(map(len, spans))
    assert len(found.law) == len(twice)
    for own in found.own:
        (of,) = [t for t in found.law if t.column == own.column]
        assert (of.functions, len(of.names), of.sizes) == (
            own.functions, len(own.names), own.sizes,
        )  # fmt: skip


@pytest.mark.parametrize("names", [(), ("own",), ("own", "stiffness")])
def test_an_effect_of_ones_own_and_an_empty_set_have_their_own_law(names):
    log = slider_log(steps(80))
    effects = joint_plant(SLIDER, (), log).effects
    stiff = next(e for e in effects if e.name == "stiffness")
    own = replace(stiff, name="own", sizes=(*stiff.sizes, replace(stiff.sizes[0], name="more")))
    terms = terms_of([e for e in (own, stiff) if e.name in names], JOINT)
    assert joint_terms(terms) == JointTerms(terms, terms)
