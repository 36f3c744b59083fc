"""An effect that a base parameter imitates rests on what was known of that parameter."""

from dataclasses import replace

import numpy as np
import pytest
from discovery_cases import (
    FREE,
    OPTIONS,
    RECORDS,
    effect,
    linear_plant,
    point_of,
    record,
    refit_at,
    slider,
)

from identification import Parameter, ParameterSet
from identification.discovery.nominal_model import NominalModel, fit_with_effects
from identification.discovery.retuning import PRIOR_WIDENING, retune
from identification.effects.effect import Candidate, Effect, Size
from identification.kalman.noise_fit import NoiseLevel
from identification.kalman.noise_model import Noise
from identification.model.plant import ModelPlant

PRIOR, SIGMA = 0.2, 0.5  # std of what is known, of the noise
CANDIDATE = Candidate(effect(), "joint", {})


def _known(**more):
    """A nominal model of which p0 is free."""
    plant = linear_plant(np.random.default_rng(0))
    return NominalModel(plant, ("p0",), np.array([PRIOR]), **more)


def _fit(J, q):
    """A fit of a base parameter p0 and of an effect's size, where the noise is white."""
    plant = linear_plant(np.random.default_rng(0))
    at = point_of(plant, np.zeros(J.shape[:2]), J)
    at = replace(at, space=replace(at.space, names=("p0", *CANDIDATE.free)), q=np.array(q))
    level = NoiseLevel(Noise(0.0, 0.1), SIGMA, 0.0)
    return refit_at(at, level, np.array([1 / PRIOR, 0.0]))


def _rows(seed):
    return np.linalg.qr(np.random.default_rng(seed).standard_normal((80, 2)))[0]


def test_what_nothing_imitates_loses_all_that_it_explains():
    J = 7 * _rows(1).reshape(40, 2, 2)
    loss, _ = retune(_fit(J, [0.0, 0.3]), _known(), CANDIDATE)
    assert loss == pytest.approx((7 * 0.3 / SIGMA) ** 2, rel=1e-9)


def test_a_limit_has_no_size_that_could_go_to_zero():
    size = Size("c", "", 1.0, 0.02, 1, present=1.0)
    limit = Candidate(Effect("limit", "c", (size,), places={"joint": ""}), "joint", {})
    loss, other = retune(_fit(7 * _rows(1).reshape(40, 2, 2), [0.0, 0.3]), _known(), limit)
    assert loss == np.inf
    assert other.distance == 0


def test_what_a_base_parameter_imitates_loses_what_the_wider_prior_holds_against_it():
    column = 7 * _rows(2)[:, :1]
    J = np.hstack([column, column]).reshape(40, 2, 2)
    loss, other = retune(_fit(J, [0.1, 0.3]), _known(), CANDIDATE)
    data, held, total = 49 / SIGMA**2, 1 / (PRIOR_WIDENING * PRIOR) ** 2, 0.1 + 0.3
    assert loss == pytest.approx(data * held / (data + held) * total**2, rel=1e-6)
    assert other.parameter == "p0"
    assert other.distance == pytest.approx(data / (data + held) * total / PRIOR, rel=1e-6)


def test_a_part_that_deviates_is_not_made_ordinary_by_a_wider_prior_of_its_own_kind():
    column = 7 * _rows(2)[:, :1]
    fit = _fit(np.hstack([column, column]).reshape(40, 2, 2), [0.1, 0.3])
    kind = {"p0": (CANDIDATE.effect.name, "another joint")}
    loss, _ = retune(fit, _known(deviants=kind), CANDIDATE)
    data, held = 49 / SIGMA**2, 1 / PRIOR**2
    assert loss == pytest.approx(data * held / (data + held) * (0.1 + 0.3) ** 2, rel=1e-6)


def test_a_brake_is_no_more_than_damping_that_nobody_expected():
    records = (
        *RECORDS,
        Parameter(
            name="brake.b", value=0.0, unit="N s/m", where="actuator/force.biasprm[2]", symbol="b"
        ),
    )
    brake = Effect("brake", "b v", (Size("b", "N s/m", 30.0, 1e-2),), places={"joint": ""})
    plant, braked = (
        ModelPlant(slider().model, ParameterSet("slider", records).with_values({"brake.b": b}))
        for b in (0.0, -3.0)
    )
    log = record(braked, 500, seed=11)
    known = NominalModel(
        plant, FREE, np.array([0.3, 0.06, 0.05, 0.05])
    )  # damping to 6 %: it looks doubled
    candidate = Candidate(brake, "joint", {})
    fit = fit_with_effects(known, log, (candidate,), {"brake.b": -2.0}, OPTIONS)
    loss, other = retune(fit, known, candidate)
    assert other.parameter == "damping"
    assert other.distance == pytest.approx(1 / 0.06, rel=0.05)  # linearised: Δd = d
    assert loss == pytest.approx((other.distance / PRIOR_WIDENING) ** 2, rel=0.05)
