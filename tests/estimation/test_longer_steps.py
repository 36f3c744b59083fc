"""Simulations may take longer steps than the model, as long as predictions and slopes stay."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from records_cases import AXIS, MJCF, PARAMETERS, STEP, record

from identification.effects.plant.joint_plant import joint_plant
from identification.estimation.levenberg_marquardt import SLOPE_ERROR
from identification.estimation.priors import Priors
from identification.model.coordinates import coordinates
from identification.model.predictor import Predictor
from identification.model.rollout import substeps
from identification.prediction.fits.model import WindowModel, predict_fitted
from identification.prediction.judging.extension import as_last_fit
from identification.windows.batches import slower
from identification.windows.coarse import OUTPUT_ERROR, with_longest_slope_steps, with_longest_steps
from identification.windows.fit import solve
from identification.windows.problem import Problem, no_moves, problem, with_longer_steps
from identification.windows.records import Record
from identification.windows.shooting import Shooting, tangent
from identification.windows.unknowns import Unknowns
from identification.windows.windows import first_states, windows

pytestmark = pytest.mark.usefixtures("few_effects")

FINE = 0.00125  # [s], an eighth of the sampling time
TRUTH = {"J": 2e-3, "d": 0.02}


@cache
def plant(stiffness=0.0, timestep=FINE):
    xml = MJCF.replace('timestep="0.005"', f'timestep="{timestep}"')
    xml = xml.replace('damping="0.02"', f'damping="0.02" stiffness="{stiffness}"')
    return joint_plant(xml, PARAMETERS, record(seed=0, samples=50), joints=(AXIS,))


def cut(own, length=0.2, seed=3):
    """Windows of a record, the model begun 20 % off."""
    log = record(seed=seed, samples=400, plant=own)
    names = ("J", "d")
    space = coordinates(own.parameters, names, np.array([1.6e-3, 0.024]))
    predictor = Predictor(own, log, names, {})
    here = windows(log, length)
    first = first_states(predictor, space.decode(np.zeros(2)), here)
    return Shooting(predictor, space, here, first, np.eye(1) / 1e-3, True)


def columns(part, q, d, steps):
    own = replace(part.predictor.plant, slope_steps=steps)
    t = tangent(replace(part, predictor=replace(part.predictor, plant=own)), q, d)
    X = (t.U * t.s[:, None]) @ t.Vt * t.size[:, None]
    return np.concatenate([X, t.S], axis=2).reshape(-1, X.shape[2] + t.S.shape[2])


def chosen(part):
    q, d = np.zeros(2), np.zeros((len(part.cut.starts), 2))
    (slow,) = with_longest_slope_steps([part], [q], [d])
    return slow.predictor.plant.slope_steps


def error(part, steps):
    """The largest relative error of a column of slopes."""
    q, d = np.zeros(2), np.zeros((len(part.cut.starts), 2))
    exact, other = columns(part, q, d, 1), columns(part, q, d, steps)
    return np.max(np.linalg.norm(other - exact, axis=0) / np.linalg.norm(exact, axis=0))


def test_the_steps_divide_the_sampling_time_and_keep_the_bound_nearly_everywhere():
    part = cut(plant())
    n = chosen(part)
    assert substeps(STEP, FINE) % n == 0
    assert error(part, n) < 1.5 * SLOPE_ERROR  # chosen on some windows, judged on all


def test_errors_of_slopes_are_of_the_first_order_of_the_step():
    part = cut(plant())
    two, four = error(part, 2), error(part, 4)
    assert 1.6 < four / two < 4.5  # (4 - 1)/(2 - 1) = 3, beyond what friction does


def test_the_residual_is_the_same_to_the_bit_whatever_steps_slopes_take():
    part = cut(plant())
    own = replace(part.predictor.plant, slope_steps=8)
    other = replace(part, predictor=replace(part.predictor, plant=own))
    q, d = np.array([0.1, -0.2]), np.full((len(part.cut.starts), 2), 1e-3)
    np.testing.assert_array_equal(part.residual(q, d), other.residual(q, d))


def test_a_fit_ends_at_the_same_values_with_fewer_steps_of_simulation():
    part = cut(plant())
    own = Priors(part.space, np.zeros(2), np.zeros(2))
    task = Problem((part,), Unknowns(own, Priors(), ("record",)))
    slow = with_longer_steps(task, np.zeros(2), no_moves(task), is_for_slopes=True)
    assert slow.plant.slope_steps > 1
    moves, _ = task.settled(np.zeros(2), no_moves(task))
    fits = [solve(t, np.zeros(2), moves, tolerance=1e-8, most=40) for t in (task, slow)]
    np.testing.assert_allclose(fits[1].cost, fits[0].cost, rtol=1e-6)
    values = [np.array([*f.values.values()]) for f in fits]
    np.testing.assert_allclose(values[1], values[0], rtol=1e-3)
    np.testing.assert_allclose(values[1], [*TRUTH.values()], rtol=0.05)


def predicted(part, steps):
    """The windows' outputs where the states are the best of the model's own steps."""
    q, d = np.zeros(2), settled(part)
    own = replace(part.predictor.plant, steps=steps)
    return replace(part, predictor=replace(part.predictor, plant=own)).outputs(q[None], [d])[0]


def settled(part):
    q = np.zeros(2)
    own = Priors(part.space, q, q)
    task = Problem((part,), Unknowns(own, Priors(), ("record",)))
    return task.settled(q, no_moves(task))[0][0]


def steps_of(part, d=None):
    (slow,) = with_longest_steps([part], [np.zeros(2)], [settled(part) if d is None else d])
    return slow.predictor.plant.steps


def test_simulations_take_the_longest_steps_that_leave_predictions_as_they_are():
    part = cut(plant())  # begun 20 % off: something is left to explain
    n, exact = steps_of(part), predicted(part, 1)
    left = np.linalg.norm(part.cut.outputs - exact)
    assert n > 1
    assert np.linalg.norm(predicted(part, n) - exact) <= OUTPUT_ERROR * left
    longer = [k for k in (2, 4, 8) if k > n]
    assert all(np.linalg.norm(predicted(part, k) - exact) > OUTPUT_ERROR * left for k in longer[:1])


def test_predictions_of_longer_steps_err_by_a_high_order_of_the_step():
    smooth = cut(plant(stiffness=900.0))
    exact = predicted(smooth, 1)
    two, four = (np.linalg.norm(predicted(smooth, k) - exact) for k in (2, 4))
    assert four / two > 4.0  # RK4 gives 17 where no joint sticks


@given(st.integers(1, 4), st.integers(1, 5), st.sampled_from([1, 2, 4, 8]))
def test_inputs_of_longer_steps_are_means_of_those_of_the_model(samples, k, n):
    inputs = np.random.default_rng(samples).standard_normal((k, 8 * samples + 1, 2))
    own, other = (plant().model, replace(plant(), slope_steps=n).smooth)
    made, every = slower(inputs, 8, own, other)
    assert (made.shape[1] - 1) * n == inputs.shape[1] - 1
    assert every * n == 8
    np.testing.assert_allclose(made[:, :-1].mean(axis=1), inputs[:, :-1].mean(axis=1), atol=1e-12)
    np.testing.assert_array_equal(made[:, -1], inputs[:, -1])


def rough_model(own, noise, steps):
    """A fit whose simulations take so many steps of the model at once, and what confirms it."""
    logs = [record(seed=k, samples=300, plant=own, noise=noise) for k in (3, 4)]
    fitted, confirm = Record(logs[0], "fit"), [Record(logs[1], "confirm")]
    names, scale = ("J", "d"), np.array([1e-3])
    space = coordinates(own.parameters, names, np.array([*TRUTH.values()]))
    prior = Priors(space, space.encode(np.array([*TRUTH.values()])), np.zeros(2))
    long = replace(own, steps=steps)
    task = problem(long, [fitted], prior, Priors(), 0.2, {}, scale)
    q = prior.mean
    found = solve(task, q, task.settled(q, no_moves(task))[0])
    seen = predict_fitted(long, confirm, 0.2, scale, found, {})
    return WindowModel((), found, seen, scale), confirm


@pytest.mark.long
def test_the_last_fit_is_that_of_a_search_with_the_steps_of_the_model():
    own = plant(stiffness=900.0)
    rough, confirm = rough_model(own, 1e-6, 4)
    exact, _ = rough_model(own, 1e-6, 1)
    last = as_last_fit(rough, 0.2, confirm, is_weighed=False)
    assert last.plant.steps == 1
    assert as_last_fit(last, 0.2, confirm, is_weighed=False) is last
    std = np.array([*exact.std.values()])
    far, left = (
        np.abs(np.array([*m.fit.values.values()]) - [*exact.fit.values.values()]) / std
        for m in (rough, last)
    )
    assert far.max() > 2  # what the longer steps moved [std]
    assert left.max() < 0.1
    assert last.fit.cost == pytest.approx(exact.fit.cost, rel=1e-2)
    seen, want = (np.mean(np.concatenate(m.unseen.at_horizon)) for m in (last, exact))
    assert seen == pytest.approx(want, rel=0.1)
