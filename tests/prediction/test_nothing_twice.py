"""What is known of windows is not simulated again, and changes nothing."""

from __future__ import annotations

from functools import cache

import numpy as np
from records_cases import nominal_model, records

from identification.discovery.candidates import list_common
from identification.effects.joint_plant import candidates
from identification.prediction.fit import solve
from identification.prediction.nominal_fit import fit_nominal
from identification.prediction.records import as_records
from identification.prediction.scores import find_imitated, window_scores
from identification.windows.held import HeldWindows
from identification.windows.settling import sought_from_others

AWAY = 0.2  # of what is believed of a state


@cache
def fitted():
    logs = records(4, samples=300)
    return fit_nominal(nominal_model(), as_records(logs[:2], logs[2:]))


def counted(monkeypatch):
    """How many windows each call of `HeldWindows.residual` simulates."""
    whole, count = HeldWindows.residual, []

    def residual(self, d):
        count.append(len(d))
        return whole(self, d)

    monkeypatch.setattr(HeldWindows, "residual", residual)
    return count


def test_windows_whose_residuals_are_known_are_sought_from_others_without_them(monkeypatch):
    fit = fitted().fit
    held = fit.problem.held(fit.q)
    starts = [(d + AWAY, np.arange(len(d)) % 2 == 0) for d in fit.moves]
    count = counted(monkeypatch)
    without = sought_from_others(held, fit.moves, starts)
    simulated = sum(count)
    count.clear()
    with_them = sought_from_others(held, fit.moves, starts, [t.r for t in fit.tangents])
    assert sum(count) == simulated - sum(map(len, fit.moves))
    for one, other in zip(without, with_them, strict=True):
        np.testing.assert_array_equal(one.d, other.d)
        np.testing.assert_array_equal(one.r, other.r)


def test_each_other_state_is_simulated_once_before_windows_are_sought_from_there(monkeypatch):
    fit = fitted().fit
    starts = [(np.full_like(d, np.inf), np.ones(len(d), bool)) for d in fit.moves]
    count = counted(monkeypatch)
    sought_from_others(fit.problem.held(fit.q), fit.moves, starts, [t.r for t in fit.tangents])
    assert sum(count) == sum(map(len, fit.moves))


def test_a_fit_whose_first_residuals_are_known_ends_where_it_ends_without_them(monkeypatch):
    fit = fitted().fit
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


def test_what_free_parameters_imitate_is_the_same_for_candidates_together_and_one_by_one():
    model = fitted()
    names = ("inertia_mismatch", "offset", "quadratic_friction", "cogging")
    effects = [e for e in candidates(model.plant, ()) if e.name in names]
    scores = window_scores(model.fit, list_common(effects))
    together = find_imitated(model.fit, scores)
    assert ("inertia_mismatch", "body arm") in together
    assert len(together) < len({s.candidate.key for s in scores})
    assert together == set().union(*(find_imitated(model.fit, [s]) for s in scores))
