"""An effect that was named at several places keeps those where it does something."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from arm_cases import LOG, text

from identification.discovery.nominal_model import NominalModel
from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Candidate
from identification.effects.joint_plant import candidates, joint_plant
from identification.model.parameter import Parameter
from identification.model.predictor import Predictor
from identification.prediction.extension import with_effect
from identification.prediction.first_fit import begin
from identification.prediction.moves.drop_places import drop_places
from identification.prediction.nominal_fit import fit_nominal
from identification.prediction.records import as_records
from identification.prediction.scores import window_scores
from identification.prediction.selection import Contender
from identification.prediction.several_places import at_places, at_several, places_of
from identification.prediction.unseen import compare

PLACES, HORIZON, NOISE = ["joint shoulder", "joint elbow"], 0.2, 3e-4
SIZES = ("quadratic_friction.c@shoulder", "quadratic_friction.c@elbow")
FREE = Parameter(
    name="d", value=0.05, unit="N m s/rad", where="joint/elbow.damping", lower=0.0, upper=1.0
)


@cache
def plant():
    return joint_plant(text(0.002, "implicitfast"), (FREE,), LOG)


def record(seed, **sizes):
    rng = np.random.default_rng(seed)
    u = np.repeat(rng.uniform(-1, 1, (15, 2)) * (4.0, 1.5), 20, axis=0)
    log = replace(LOG, time=0.01 * np.arange(300), inputs=u, outputs=np.zeros((300, 2)))
    y = Predictor(plant(), log, tuple(sizes)).predict(np.array([[*sizes.values()]]))[0]
    return replace(log, outputs=y + NOISE * rng.standard_normal(y.shape), name=f"record {seed}")


@cache
def named(shoulder, elbow):
    """The nominal model, what confirms, the model with friction at both joints, its claim."""
    truth = dict(zip(SIZES, (shoulder, elbow), strict=True))
    roles = as_records([record(k, **truth) for k in (1, 2)], [record(k, **truth) for k in (3, 4)])
    base = NominalModel(plant(), ("d",), np.array([0.5]), HORIZON)
    parent = fit_nominal(base, roles)
    every = next(e for e in candidates(plant(), ("d",)) if e.name == "quadratic_friction")
    effect = at_several(every, PLACES)
    shape = {s.name: s.values[0] for s in effect.shapes}
    (score,) = window_scores(parent.fit, [Candidate(effect, next(iter(effect.places)), shape)])
    model = with_effect(parent, begin(parent, [score]), HORIZON, roles[2:])
    claim = Contender(
        model=model, prediction=compare(parent.unseen, model.unseen), gains=np.zeros(0),
        numbers=2, criterion=0.0, doubt=None,
    )  # fmt: skip
    return base, roles[2:], model, claim


def pruned(shoulder, elbow):
    base, confirm, model, claim = named(shoulder, elbow)
    said = []
    task = SimpleNamespace(
        nominal_model=base, confirm=confirm, horizon=base.horizon, options=DiscoveryOptions()
    )
    found = drop_places(SimpleNamespace(model=model, accepted=[claim], task=task), said.append)
    return model, *found, said


def test_a_place_without_the_effect_is_left_out_and_the_other_keeps_its_size():
    before, after, (claim,), _, said = pruned(0.0, 0.01)
    assert claim.candidate.where == "joint elbow"
    assert claim.candidate.sizes == after.candidates[-1].sizes == SIZES[1:]
    assert after.fit.values[SIZES[1]] == pytest.approx(0.01, abs=4 * after.std[SIZES[1]])
    assert after.std[SIZES[1]] <= 1.1 * before.std[SIZES[1]]
    assert SIZES[0] not in after.fit.values
    assert said == ["quadratic_friction: no longer needed at joint shoulder"]


def test_a_model_with_the_effect_at_all_its_places_stays_as_it_is():
    before, after, (claim,), _, said = pruned(0.02, 0.01)
    assert after is before
    assert places_of(claim.candidate.where) == PLACES
    assert said == []


def test_places_that_stay_have_the_parameters_that_they_had():
    every = next(e for e in candidates(plant(), ("d",)) if e.name == "quadratic_friction")
    both = at_several(every, PLACES)
    for where, name in zip(PLACES, SIZES, strict=True):
        assert Candidate(at_places(both, [where]), where, {}).sizes == (name,)
    assert at_places(both, PLACES) == both


def test_an_effect_at_one_place_is_not_asked():
    c = SimpleNamespace(where="joint elbow", effect=SimpleNamespace(own=False))
    claim = SimpleNamespace(candidate=c)
    task = SimpleNamespace(options=DiscoveryOptions())
    state = SimpleNamespace(model="model", accepted=[claim], task=task)
    assert drop_places(state, print) == ("model", (claim,), ())
