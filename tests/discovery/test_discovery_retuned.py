"""An effect that a base parameter imitates rests on what was known of that parameter."""

from dataclasses import replace

import numpy as np
import pytest
from discovery_cases import (
    EFFECTS,
    RECORDS,
    effect,
    linear_plant,
    point_of,
    record,
    slider,
    wander,
)

from identification import Parameter, ParameterSet
from identification.discovery.discover import discover
from identification.discovery.extend import Base
from identification.discovery.retuned import WIDER, retuned
from identification.effect import Candidate, Effect, Size
from identification.kalman.noise_fit import Level
from identification.kalman.noise_model import Noise
from identification.kalman.refit import Refit
from identification.plant import ModelPlant

PRIOR, SIGMA = 0.2, 0.5  # std of what is known, of the noise
CANDIDATE = Candidate(effect(), "joint", {})


def _fit(J, q):
    """A fit of a base parameter p0 and of an effect's size, where the noise is white."""
    plant = linear_plant(np.random.default_rng(0))
    at = point_of(plant, np.zeros(J.shape[:2]), J)
    at = replace(at, space=replace(at.space, names=("p0", *CANDIDATE.free)), q=np.array(q))
    level = Level(Noise(0.0, 0.1), SIGMA, 0.0)
    return Refit(at, level, np.ones(2), np.zeros(2), np.array([1 / PRIOR, 0.0]), 1)


def _rows(seed):
    return np.linalg.qr(np.random.default_rng(seed).standard_normal((80, 2)))[0]


def test_what_nothing_imitates_loses_all_that_it_explains():
    J = 7 * _rows(1).reshape(40, 2, 2)
    loss, _ = retuned(_fit(J, [0.0, 0.3]), ("p0",), CANDIDATE)
    assert loss == pytest.approx((7 * 0.3 / SIGMA) ** 2, rel=1e-9)


def test_what_a_base_parameter_imitates_loses_what_the_wider_prior_holds_against_it():
    column = 7 * _rows(2)[:, :1]
    J = np.hstack([column, column]).reshape(40, 2, 2)
    loss, other = retuned(_fit(J, [0.1, 0.3]), ("p0",), CANDIDATE)
    data, held, total = 49 / SIGMA**2, 1 / (WIDER * PRIOR) ** 2, 0.1 + 0.3
    assert loss == pytest.approx(data * held / (data + held) * total**2, rel=1e-6)
    assert other.parameter == "p0"
    assert other.distance == pytest.approx(data / (data + held) * total / PRIOR, rel=1e-6)


def test_a_brake_that_may_be_damping_is_said_to_be_one_or_the_other():
    records = (
        *RECORDS,
        Parameter("brake.b", 0.0, "N s/m", "actuator/force.biasprm[2]", symbol="b"),
    )
    brake = Effect("brake", "b v", (Size("b", "N s/m", 30.0, 1e-2),), places={"joint": ""})

    def plant(**values):
        model = slider().model
        return ModelPlant(model, ParameterSet("slider", records).with_values(values))

    log = record(plant(damping=6.0), 500, seed=11, error=wander(500, 0.03, 0.1, seed=8))
    known = np.array([0.3, 0.06, 0.05, 0.05])  # "to 6 %", and it is twice as large
    names = ("mass", "damping", "x0", "v0")
    (named,) = discover(Base(plant(), names, known), log, (*EFFECTS, brake)).named
    assert named.candidate.effect.name == "brake"
    assert named.retuned.parameter == "damping"
    assert named.retuned.distance > 5
    assert named.retuned.confidence > 0.05
