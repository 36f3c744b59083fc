"""Replacing effects of a fit to first order, against the slow obvious way."""

import numpy as np
import pytest
from discovery_cases import EFFECTS, SENSOR, record, slider, task, wander
from scipy.linalg import lstsq

from identification.discovery.fitted_model import fit_model
from identification.discovery.replacement import replace_effect
from identification.discovery.scoring.sensitivities import compute_sensitivities
from identification.effects.effect import Candidate
from identification.kalman.problem import linearise_criterion

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
    problem = linearise_criterion(fit.point, fit.level, fit.mean, fit.prior)
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
