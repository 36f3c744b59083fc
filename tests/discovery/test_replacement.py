"""Replacing effects of a fit to first order, against the slow obvious way."""

from dataclasses import replace

import numpy as np
import pytest
from discovery_cases import (
    EFFECTS,
    FREE,
    OPTIONS,
    RECORDS,
    SENSOR,
    effect,
    linear_plant,
    point_of,
    record,
    refit_at,
    slider,
    task,
    wander,
)
from scipy.linalg import lstsq

from identification import Parameter, ParameterSet
from identification.discovery.nominal_model import NominalModel
from identification.effects.effect import Candidate, Effect
from identification.effects.sizes import Size
from identification.innovations.fit import fit_with_effects
from identification.innovations.fitted_model import fit_model
from identification.innovations.replacement import PRIOR_WIDENING, replace_effect, retune
from identification.innovations.scoring.sensitivities import compute_sensitivities
from identification.kalman.noise_fit import NoiseLevel
from identification.kalman.noise_model import Noise
from identification.model.plant import ModelPlant

SPRING, OFFSET, RUBBING = (Candidate(effect, "joint", {}) for effect in EFFECTS)


@pytest.fixture(scope="module")
def fitted():
    """A slider with a spring and an offset, fitted with both, and the sensitivities of all."""
    robot = slider(
        **{"mass": 2.2, "damping": 2.7, "x0": 0.01, "v0": 0.02, "spring.k": 5.0, "offset.f": -0.8}
    )
    log = record(robot, 500, 11, wander(500, 0.003, 0.1, 8), SENSOR)
    start = {"spring.k": 4.0, "offset.f": -0.5}
    fit = fit_model(task(log), (SPRING, OFFSET), start).refit
    found = compute_sensitivities(fit.point, (SPRING, OFFSET, RUBBING))
    return fit, {s.candidate.effect.name: s.S for s in found}


def dense(fit, gone, new):
    """The least criterion without some effects and with new columns, from all samples."""
    problem = fit.problem
    names = [*fit.point.space.names]
    away = [names.index(n) for n in gone]
    kept = [j for j in range(len(names)) if j not in away]
    target = problem.target + problem.rows[:, away] @ fit.point.q[away]
    W = [problem.filter(S).reshape(fit.point.e.size, -1) / fit.level.sigma for S in new]
    W = [np.vstack([w, np.zeros((len(names), w.shape[1]))]) for w in W]
    rows = np.hstack([problem.rows[:, kept], *W])
    move = lstsq(rows, target)[0]
    return np.sum((target - rows @ move) ** 2), move[len(kept) :]


def test_a_replacement_is_the_least_criterion_with_other_columns(fitted):
    fit, S = fitted
    found = replace_effect(fit, SPRING, S["rubbing"], fit.level)
    law = dense(fit, (), ())[0]
    least, size = dense(fit, ("spring.k",), (S["rubbing"],))
    neither = dense(fit, ("spring.k",), ())[0]
    assert found.loss == pytest.approx(least - law, rel=1e-6)
    assert found.size == pytest.approx(size, rel=1e-6)
    assert found.share == pytest.approx((neither - law) / (neither - least), rel=1e-6)


def test_an_effect_that_replaces_itself_loses_nothing_and_keeps_its_size(fitted):
    fit, S = fitted
    same = replace_effect(fit, SPRING, S["spring"], fit.level)
    assert abs(same.loss) < 0.5
    assert same.size == pytest.approx(fit.point.values["spring.k"], rel=0.02)
    # Columns in another unit are the same columns.
    scaled = replace_effect(fit, SPRING, 1e3 * S["spring"], fit.level)
    assert scaled.loss == pytest.approx(same.loss, abs=1e-6)
    assert scaled.size == pytest.approx(same.size / 1e3, rel=1e-6)


def test_more_columns_never_lose_more(fitted):
    fit, S = fitted
    wide = np.concatenate([S["rubbing"], S["offset"]], axis=2)
    few, many = (replace_effect(fit, SPRING, s, fit.level) for s in (S["rubbing"], wide))
    assert many.loss <= few.loss + 1e-9


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
