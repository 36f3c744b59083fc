"""What the steps of a simulation make is no effect: the search goes on with finer ones."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from records_cases import AXIS, FREE, HORIZON, KNOWN, MJCF, PARAMETERS, record
from state_cases import COULOMB

from identification.discovery.nominal_model import NominalModel
from identification.discovery.options import DiscoveryOptions
from identification.effects.plant.joint_plant import joint_plant
from identification.model.predictor import Predictor
from identification.model.protocol import FINER
from identification.prediction.discovery import discover_records
from identification.prediction.selection.finer_steps import (
    MOVED,
    STEPS_SHARE,
    is_made_by_steps,
    is_of_steps,
)
from identification.report.discovery.report import discovery_text

LEVEL, NOISE = COULOMB.name, 1e-4
FEW = ("coulomb_friction", "time_shift", "stribeck_friction", "sublinear_friction", "offset")


@cache
def pendulum():
    """A pendulum whose dry friction is known to be there, at steps of 10 ms."""
    text, log = MJCF.replace('timestep="0.005"', 'timestep="0.01"'), record(samples=50)
    given = (*PARAMETERS, replace(COULOMB, value=0.1))
    every = joint_plant(text, given, log, joints=(AXIS,)).effects
    effects = [e for e in every if e.name in FEW]
    return joint_plant(text, given, log, joints=(AXIS,), effects=effects)


def measured(seed, **values):
    """A record of the pendulum as it is: simulated with steps of half a millisecond."""
    return record(seed, 600, {LEVEL: 0.1, **values}, NOISE, pendulum().with_step(0.05))


@cache
def found(without=(), **values):
    logs = [measured(k, **values) for k in range(1, 5)]
    base = NominalModel(pendulum(), (*FREE, LEVEL), np.append(KNOWN, 0.3), HORIZON)
    effects = [e for e in pendulum().effects if e.name != "coulomb_friction"]
    options = DiscoveryOptions(without=without)
    return discover_records(base, logs[:2], logs[2:], effects, options=options)


def test_steps_of_a_share_are_those_of_a_model_with_that_step():
    plant, log = pendulum(), record(3, 100)
    for factor in (1 / FINER, 0.1):
        share = replace(plant, steps=factor)
        assert share.model.opt.timestep == pytest.approx(0.01 * factor)
        one, other = (Predictor(p, log, ()).predict(np.zeros((1, 0)))
                      for p in (share, plant.with_step(factor)))  # fmt: skip
        np.testing.assert_array_equal(one, other)


def model(cost=1.0, error=np.nan, shift=0.0):
    """A fitted model; `error` and `shift` are those of finer steps, the shift in std."""
    return SimpleNamespace(
        fitted_power=cost, finer=SimpleNamespace(error=error),
        told_std={"law.size [a]": 2.0 * np.hypot(1, shift), "d": 10.0},
        step_shift={"law.size [a]": 2.0 * shift, "d": 9.0},
    )  # fmt: skip


def best(explains, shift=0.0, is_curve=False):
    effect = SimpleNamespace(is_curve=is_curve)
    candidate = SimpleNamespace(effect=effect, free=("law.size",))
    return SimpleNamespace(model=model(1 - explains, shift=shift), candidate=candidate)


@pytest.mark.parametrize("times", [0.9, 1.1])
def test_an_effect_is_of_the_steps_where_these_do_half_of_it_or_move_it_far(times):
    half = np.sqrt(1 - times * STEPS_SHARE * 0.4)
    assert is_of_steps(model(error=half), best(0.4)) == (times > 1)
    assert is_made_by_steps(model(error=half), best(0.4)) == (times > 1)
    assert is_of_steps(model(error=1.0), best(0.4, -times * MOVED)) == (times > 1)
    assert not is_of_steps(model(error=1.0), best(0.4, times * MOVED, is_curve=True))
    assert not is_of_steps(model(), best(0.4))  # where finer steps cannot be simulated


@pytest.mark.long
def test_a_name_that_the_steps_make_is_none():
    """Ten milliseconds are too long for a friction that holds: without the pass they get a name."""
    wrong, answer = found(("finer_steps",)), found()
    assert wrong.verdict == "named"
    assert answer.named == ()
    assert answer.verdict == "nothing missing"
    assert "steps of 2.50 ms where the model has 10 ms" in discovery_text(answer)
    made = [r.name for r in answer.rejected if r.doubt == "steps"]
    assert wrong.named[0].name in made


@pytest.mark.long
def test_what_is_missing_is_named_with_finer_steps():
    name = "offset.f_0@hinge"
    answer = found(**{name: 0.02})
    assert [n.name for n in answer.named] == ["offset"]
    ((value, std, _),) = answer.named[0].parameters.values()
    assert value == pytest.approx(0.02, abs=max(4 * std, 4e-4))
