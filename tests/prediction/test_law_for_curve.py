"""A law stands in the place of a curve that says no more than it does, and only then."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from records_cases import HORIZON, nominal_model, pendulum, records

from identification.discovery.options import DiscoveryOptions
from identification.effects.joint_plant import candidates
from identification.prediction.extension import left_out
from identification.prediction.moves.add_effect import add_effect
from identification.prediction.moves.law_for_curve import law_for_curve
from identification.prediction.state import first_state
from identification.prediction.task import RecordsTask
from identification.windows.records import as_records

TRUTH = {"hardening.k_3@hinge": 0.06}
LAWS = ("hardening", "stiffness", "quadratic_friction")


def effects(*names):
    return tuple(e for e in candidates(pendulum(), ("J", "d")) if e.name in names)


@cache
def drawn():
    """A search that knew no law, and drew the hidden spring as a curve of the position."""
    logs = records(4, TRUTH, samples=400)
    task = RecordsTask(
        nominal_model=nominal_model(), records=as_records(logs[:2], logs[2:]),
        effects=effects("curve_position"), options=DiscoveryOptions(),
    )  # fmt: skip
    state = add_effect(first_state(task, lambda line: None), lambda line: None)
    assert [a.candidate.effect.name for a in state.accepted] == ["curve_position"]
    return state


def asked(*names):
    state, told = drawn(), []
    task = replace(state.task, effects=effects("curve_position", *names))
    model, accepted, lost = law_for_curve(replace(state, task=task), told.append)
    return model, [a.candidate.effect.name for a in accepted], lost, told


def test_the_hidden_law_takes_the_place_of_its_curve_with_its_size():
    model, names, lost, told = asked(*LAWS)
    assert names == ["hardening"]
    assert [c.effect.name for c in model.candidates] == names
    value, std = (m["hardening.k_3@hinge"] for m in (model.values, model.std))
    assert abs(value - TRUTH["hardening.k_3@hinge"]) < 4 * std
    assert [(a.candidate.effect.name, a.doubt) for a in lost] == [("curve_position", "numbers")]
    assert "hardening, joint hinge: says what the curve does, with fewer numbers" in told


def test_laws_that_say_less_than_the_curve_stay_out():
    model, names, lost, _ = asked("quadratic_friction", "stiffness")
    assert names == ["curve_position"]
    assert model is drawn().model
    assert lost == ()


def test_what_is_left_out_has_all_other_values_as_they_are():
    model = drawn().model
    bare = left_out(model, (), nominal_model())
    assert bare.fit.steps == 1
    for name, value in bare.fit.values.items():
        assert value == pytest.approx(model.fit.values[name], rel=1e-9)
    assert bare.candidates == ()
    assert bare.fit.cost > 3 * model.fit.cost
    rms = np.sqrt(np.mean(np.concatenate([e.ravel() for e in bare.fit.errors]) ** 2))
    with_it = np.sqrt(np.mean(np.concatenate([e.ravel() for e in model.fit.errors]) ** 2))
    assert rms > 1.5 * with_it
    assert model.fit.problem.parts[0].cut.outputs.shape[1] == round(HORIZON / 0.01)
