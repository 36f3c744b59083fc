"""Models compared at their best: no window begins where another model knows a better state."""

from __future__ import annotations

from dataclasses import fields, replace
from functools import cache

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from records_cases import HORIZON, nominal_model, records

from identification.prediction import problem
from identification.prediction.crossing import at_their_best, crossed
from identification.prediction.nominal_fit import fit_nominal
from identification.prediction.records import as_records
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


def test_the_cost_of_a_crossed_fit_is_that_of_its_windows():
    _, model = fitted()
    freed = crossed(stuck(model.fit), [model.fit])
    r = freed.problem.held(freed.q).residuals(freed.moves)
    np.testing.assert_allclose(freed.problem.cost_of(freed.q, r), freed.cost, rtol=1e-9)


def test_a_crossed_fit_is_linearised_where_its_windows_begin():
    _, model = fitted()
    freed = crossed(stuck(model.fit), [model.fit])
    r = freed.problem.held(freed.q).residuals(freed.moves)
    anew = freed.problem.tangents(freed.q, freed.moves, r)
    for mine, right in zip(freed.tangents, anew, strict=True):
        for field in fields(mine):
            got, wanted = (getattr(t, field.name) for t in (mine, right))
            np.testing.assert_allclose(got, wanted, rtol=1e-9, atol=1e-9)


def test_only_windows_that_begin_elsewhere_are_linearised_again(monkeypatch):
    _, model = fitted()
    whole, count = problem.tangent, []

    def counted(part, q, d, *rest, **more):
        count.append(len(d))
        return whole(part, q, d, *rest, **more)

    bad = stuck(model.fit)
    monkeypatch.setattr(problem, "tangent", counted)
    crossed(bad, [model.fit])
    assert count == [1]


def test_parent_and_child_that_are_one_model_are_equal_whichever_is_stuck():
    every, model = fitted()
    confirm = [r for r in every if r.role == "confirm"]
    bad = replace(model, fit=stuck(model.fit))
    for parent, child in ((bad, model), (model, bad)):
        one, (other,) = at_their_best(parent, [child], HORIZON, confirm)
        np.testing.assert_allclose(one.fit.cost, other.fit.cost, rtol=2e-3)
        mine, others = (np.concatenate(m.unseen.at_horizon) for m in (one, other))
        np.testing.assert_allclose(mine.mean(), others.mean(), rtol=2e-3)


def test_without_children_a_model_stays_as_it_is():
    every, model = fitted()
    assert at_their_best(model, [], HORIZON, every) == (model, ())


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


def test_a_start_that_diverges_is_passed_over():
    _, model = fitted()
    held, moves = model.fit.problem.held(model.fit.q), model.fit.moves
    starts = [(np.full_like(d, np.inf), np.ones(len(d), bool)) for d in moves]
    for s, d in zip(sought_from_others(held, moves, starts), moves, strict=True):
        np.testing.assert_array_equal(s.d, d)
