"""Parts that deviate by more than parts do become effects; those that do not stay parts."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from discovery_cases import (
    EFFECTS,
    FREE,
    KNOWN,
    OPTIONS,
    RECORDS,
    SENSOR,
    SLIDER,
    STEP,
    steps,
    wander,
)

from identification import Log, Parameter, ParameterSet
from identification.discovery.nominal_model import NominalModel
from identification.innovations.fitted_model import fit_model
from identification.innovations.moves.deviants import accept_deviants, find_deviants
from identification.innovations.task import DiscoveryTask
from identification.model.plant import ModelPlant
from identification.model.predictor import Predictor

# A second spring and a second constant force, which every such cart has a little of.
PARTS = {"part.k": 0.3, "part.f": 0.02}  # name: std [N/m, N]
PLACES = {"part.k": "tendon/belt.stiffness", "part.f": "actuator/hand.biasprm[0]"}
XML = SLIDER.replace(
    "<actuator>", '<tendon><fixed name="belt"><joint joint="slide" coef="1"/></fixed></tendon>'
    '<actuator><general name="hand" joint="slide" gainprm="0" biastype="affine"/>',
)  # fmt: skip


def cart(**values):
    parts = tuple(Parameter(name=n, value=0.0, unit="", where=PLACES[n]) for n in PARTS)
    parameters = ParameterSet("cart", (*RECORDS, *parts)).with_values(values)
    return ModelPlant(mujoco.MjModel.from_xml_string(XML), parameters)


def record(plant):
    """What the position sensor says of a force that wanders a little; nobody's hand moves."""
    still = np.zeros((500, 1))
    error = wander(500, 0.003, 0.1, 8)
    u = np.hstack([still, steps(500)])
    of = {
        "time": STEP * np.arange(500), "input_names": ("hand", "force"),
        "output_names": ("position",), "units": {"hand": "N", "force": "N", "position": "m"},
    }  # fmt: skip
    fed = Log(inputs=u + np.hstack([still, error]), outputs=still, **of)
    y = Predictor(plant, fed, ()).predict(np.empty((1, 0)))[0]
    return Log(inputs=u, outputs=y + SENSOR * np.random.default_rng(11).normal(size=y.shape), **of)


def asked(**values):
    """What does the cart lack whose parts are such?"""
    model = NominalModel(
        cart(), (*FREE, *PARTS), np.array([*KNOWN, *PARTS.values()]),
        groups={name: (name,) for name in PARTS},
        deviants={"part.k": ("spring", "joint"), "part.f": ("offset", "joint")},
    )  # fmt: skip
    truth = {"mass": 2.2, "damping": 2.7, "x0": 0.01, "v0": 0.02, **values}
    task = DiscoveryTask(
        nominal_model=model, log=record(cart(**truth)), effects=EFFECTS, options=OPTIONS
    )
    return task, fit_model(task, (), {})


def names(accepted):
    return [a.candidate.effect.name for a in accepted]


def test_a_part_far_off_is_an_effect_and_one_near_the_others_is_none():
    task, model = asked(**{"part.k": 6.0, "part.f": 0.02})
    assert [c.effect.name for c in find_deviants(task, model)] == ["spring"]
    parent, accepted = accept_deviants(task, model, 8, print)
    assert names(accepted) == ["spring"]
    fitted = accepted[0].model
    assert fitted.refit.point.values["spring.k"] == pytest.approx(6.0, rel=0.15)
    assert abs(fitted.refit.point.values["part.k"]) <= OPTIONS.max_scatter * PARTS["part.k"]
    # The model with the effect contains the one without.
    assert fitted.refit.log_posterior > parent.refit.log_posterior
    assert parent.candidates == ()


def test_two_parts_far_off_are_two_effects_each_proven_beside_the_other():
    task, model = asked(**{"part.k": 6.0, "part.f": 0.4})
    parent, accepted = accept_deviants(task, model, 8, print)
    assert sorted(names(accepted)) == ["offset", "spring"]
    assert all(a.gain > 0 and a.model.candidates[-1] is a.candidate for a in accepted)
    for a in accepted:
        assert {c.effect.name for c in a.model.candidates} == {"offset", "spring"}
    assert parent.candidates == ()


def test_parts_as_parts_are_change_nothing():
    task, model = asked(**{"part.k": 0.5, "part.f": 0.03})
    assert accept_deviants(task, model, 8, print) == (model, ())


@pytest.mark.parametrize(("share", "found"), [(1.05, ["spring"]), (0.95, [])])
def test_a_part_that_may_as_well_be_within_its_bound_is_none(share, found):
    """Held there it must cost more than BIC asks, of what the data and not the prior say of it."""
    task, model = asked(**{"part.k": 6.0})
    at = model.refit.point.space.names.index("part.k")
    beyond = abs(model.refit.point.values["part.k"]) - OPTIONS.max_scatter * PARTS["part.k"]
    of_data = share * np.log(len(model.refit.point.log)) / beyond**2
    std = model.refit.std.copy()
    std[at] = (of_data + PARTS["part.k"] ** -2) ** -0.5
    unsure = replace(model, refit=replace(model.refit, std=std))
    assert [c.effect.name for c in find_deviants(task, unsure)] == found
