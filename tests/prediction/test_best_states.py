"""Of two states of a window the better one; one that ends well enough asks for no other."""

from __future__ import annotations

from functools import cache

import numpy as np
from records_cases import HORIZON, nominal_model, records

from identification.estimation.priors import Priors
from identification.prediction.problem import best_of, no_moves, problem
from identification.prediction.records import as_records
from identification.windows.held import HeldWindows

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


def test_only_windows_with_more_than_enough_are_simulated_at_the_other_state(monkeypatch):
    held, moves, away = windows()
    there = squares(held.residuals(moves))
    enough = [np.full(len(s), np.median(s)) for s in there]
    whole, count = HeldWindows.residual, []

    def counted(self, d):
        count.append(len(d))
        return whole(self, d)

    monkeypatch.setattr(HeldWindows, "residual", counted)
    _, r = best_of(held, moves, away, enough)
    more = sum(int((s > e).sum()) for s, e in zip(there, enough, strict=True))
    assert sum(count) == sum(map(len, moves)) + more
    for k, s in enumerate(squares(r)):
        at = there[k] <= enough[k]
        np.testing.assert_array_equal(s[at], there[k][at])
