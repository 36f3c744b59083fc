"""A horizon that diverges from where the last one ended is reached in smaller steps."""

import numpy as np
import pytest
from estimation_plants import record, slider

from identification import DivergenceError
from identification.estimation.estimation import Options, estimate
from identification.estimation.search import Search

HORIZONS = Options(horizons=(0.2, 1.0))


def lost_beyond(monkeypatch, stride):
    """Make a start diverge on a horizon more than `stride` samples longer than the one before."""
    solve, reached = Search.solve, [0]

    def brittle(self, samples, tolerance):
        if reached[-1] and samples > reached[-1] + stride:
            raise DivergenceError("the simulation diverged")
        status = solve(self, samples, tolerance)
        reached.append(samples)
        return status

    monkeypatch.setattr(Search, "solve", brittle)
    return reached


def test_a_late_divergence_is_walked_around(monkeypatch):
    log = record(slider(), ("position",), n=200)
    reached = lost_beyond(monkeypatch, 80)
    found = estimate(slider(), log, ("stiffness",), {"stiffness": 25.0}, HORIZONS)
    assert found.values["stiffness"] == pytest.approx(20.0, rel=1e-6)
    assert reached == [0, 40, 80, 120, 200] or np.all(np.diff(reached) > 0)
    assert len(reached) > 3


def test_a_divergence_that_stays_is_said(monkeypatch):
    log = record(slider(), ("position",), n=200)
    lost_beyond(monkeypatch, 0)
    with pytest.raises(DivergenceError):
        estimate(slider(), log, ("stiffness",), {"stiffness": 25.0}, HORIZONS)
