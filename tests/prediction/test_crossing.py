"""Models compared at their best: no window begins where another model knows a better state."""

from dataclasses import fields, replace
from functools import cache

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from records_cases import HORIZON, nominal_model, records

from identification.estimation.priors import Priors
from identification.prediction.fits.crossing import at_their_best, crossed
from identification.prediction.fits.nominal_fit import fit_nominal
from identification.windows.fit import solve
from identification.windows.held import HeldWindows
from identification.windows.problem import best_of, no_moves, problem
from identification.windows.records import as_records
from identification.windows.settling import Starts, best_starts, sought_from_others

FAR = 3.0  # a speed, in units of what is believed of it, at which a window is left


@cache
def fitted():
    logs = records(4)
    every = as_records(logs[:2], logs[2:])
    return every, fit_nominal(nominal_model(), every)


def stuck(fit, window=2):
    """The same fit, a window of the first record left where its search began badly."""
    moves = [np.array(d) for d in fit.moves]
    moves[0][window] += FAR
    r = fit.problem.held(fit.q).residuals(moves)
    tangents = fit.problem.tangents(fit.q, moves, r)
    return replace(
        fit, moves=tuple(moves), tangents=tangents, cost=fit.problem.cost_of(fit.q, r)
    )  # fmt: skip


def test_a_window_that_is_stuck_is_freed_by_another_fit_and_its_parameters_stay():
    _, model = fitted()
    bad = stuck(model.fit)
    assert bad.cost > 1.1 * model.fit.cost
    freed = crossed(bad, [model.fit])
    np.testing.assert_allclose(freed.cost, model.fit.cost, rtol=2e-3)
    np.testing.assert_array_equal(freed.q, bad.q)


def test_no_window_gets_worse_and_a_fit_that_is_best_everywhere_stays_as_it_is():
    _, model = fitted()
    bad = stuck(model.fit)
    assert crossed(model.fit, [model.fit]) is model.fit
    same = crossed(model.fit, [bad])
    for mine, old in zip(same.tangents, model.fit.tangents, strict=True):
        assert np.all(np.sum(mine.r**2, axis=1) <= np.sum(old.r**2, axis=1))


def test_a_crossed_fit_is_linearised_where_its_windows_begin():
    _, model = fitted()
    freed = crossed(stuck(model.fit), [model.fit])
    r = freed.problem.held(freed.q).residuals(freed.moves)
    anew = freed.problem.tangents(freed.q, freed.moves, r)
    for mine, right in zip(freed.tangents, anew, strict=True):
        for field in fields(mine):
            got, wanted = (getattr(t, field.name) for t in (mine, right))
            np.testing.assert_allclose(got, wanted, rtol=1e-9, atol=1e-9)


def test_parent_and_child_that_are_one_model_are_equal_whichever_is_stuck():
    every, model = fitted()
    confirm = [r for r in every if r.role == "confirm"]
    bad = replace(model, fit=stuck(model.fit))
    for parent, child in ((bad, model), (model, bad)):
        one, (other,) = at_their_best(parent, [child], HORIZON, confirm)
        np.testing.assert_allclose(one.fit.cost, other.fit.cost, rtol=2e-3)
        mine, others = (np.concatenate(m.unseen.at_horizon) for m in (one, other))
        np.testing.assert_allclose(mine.mean(), others.mean(), rtol=2e-3)


@given(st.integers(0, 1000), st.integers(1, 4), st.integers(1, 3))
def test_each_window_begins_where_the_model_with_the_least_error_begins_it(seed, W, count):
    rng = np.random.default_rng(seed)
    own, *others = (
        Starts(rng.standard_normal((W, nx)), rng.uniform(size=W))
        for nx in (3, *rng.integers(2, 5, count))
    )
    d, is_better = best_starts(own, others)
    for w in range(W):
        every = [own, *others]
        best = min(every, key=lambda b: b.squares[w])
        n = min(3, best.d.shape[1])
        np.testing.assert_array_equal(d[w, :n], best.d[w, :n])
        np.testing.assert_array_equal(d[w, n:], own.d[w, n:])
        assert is_better[w] == (best is not own)


AWAY = 0.5  # of what is believed of a state


@cache
def windows():
    """The windows of two records, states of which every other one is as measured, and the rest."""
    logs = records(4)
    every = [r for r in as_records(logs[:2], logs[2:]) if r.role == "fit"]
    plant = nominal_model().plant
    task = problem(plant, every, Priors(), Priors(), HORIZON, {}, np.array([0.01]))
    measured = no_moves(task)
    first = [np.arange(len(d))[:, None] % 2 == 0 for d in measured]
    beside = [AWAY / p.first.weight + d for d, p in zip(measured, task.parts, strict=True)]
    each = [*zip(first, measured, beside, strict=True)]
    moves = tuple(np.where(at, d, away) for at, d, away in each)
    return task.held(np.zeros(0)), moves, tuple(np.where(at, away, d) for at, d, away in each)


def squares(residuals):
    return [np.sum(r**2, axis=1) for r in residuals]


def test_each_window_gets_the_state_with_the_smaller_sum_of_squares():
    held, moves, away = windows()
    none = [np.full(len(d), -1.0) for d in moves]
    d, r = best_of(held, moves, away, none)
    there, beside = squares(held.residuals(moves)), squares(held.residuals(away))
    assert any((b < a).any() for a, b in zip(there, beside, strict=True))
    for k in range(len(d)):
        np.testing.assert_array_equal(squares(r)[k], np.minimum(there[k], beside[k]))
        np.testing.assert_array_equal(d[k], np.where((beside[k] < there[k])[:, None], away[k],
                                                     moves[k]))  # fmt: skip


NEAR = 0.2  # of what is believed of a state


def counted(monkeypatch):
    """How many windows each call of `HeldWindows.residual` simulates."""
    whole, count = HeldWindows.residual, []

    def residual(self, d):
        count.append(len(d))
        return whole(self, d)

    monkeypatch.setattr(HeldWindows, "residual", residual)
    return count


def test_windows_whose_residuals_are_known_are_sought_from_others_without_them(monkeypatch):
    fit = fitted()[1].fit
    held = fit.problem.held(fit.q)
    starts = [(d + NEAR, np.arange(len(d)) % 2 == 0) for d in fit.moves]
    count = counted(monkeypatch)
    without = sought_from_others(held, fit.moves, starts)
    simulated = sum(count)
    count.clear()
    with_them = sought_from_others(held, fit.moves, starts, [t.r for t in fit.tangents])
    assert sum(count) == simulated - sum(map(len, fit.moves))
    for one, other in zip(without, with_them, strict=True):
        np.testing.assert_array_equal(one.d, other.d)
        np.testing.assert_array_equal(one.r, other.r)


def test_a_fit_whose_first_residuals_are_known_ends_where_it_ends_without_them(monkeypatch):
    fit = fitted()[1].fit
    q = fit.problem.prior.space.inside(fit.q + 0.1)
    moves, r = fit.problem.settled(q, fit.moves)
    count = counted(monkeypatch)
    one = solve(fit.problem, q, moves)
    simulated = sum(count)
    count.clear()
    other = solve(fit.problem, q, moves, known=r)
    assert sum(count) == simulated - sum(map(len, moves))
    np.testing.assert_array_equal(one.q, other.q)
    assert one.cost == other.cost
