"""Several starts find what one start misses, and one start is enough where it finds it."""

import numpy as np
import pytest
from estimation_plants import record, slider

from identification import DivergenceError, InputError
from identification.estimation import multistart
from identification.estimation.estimation import Options
from identification.estimation.multistart import estimate_from

ONCE = Options(horizons=(1.0,), max_evaluations=20)


def test_several_starts_escape_a_local_minimum():
    log = record(
        slider(x0=1.0, damping=0.05, stiffness=200.0), ("position",), inputs=np.zeros((200, 1)),
        noise=1e-3,
    )  # fmt: skip
    far = slider(x0=1.0, damping=0.05, stiffness=110.0)
    found = estimate_from(far, log, ("stiffness",), 12, 0, spread=0.8, options=ONCE)
    assert found.rms[0] > 0.1
    assert found.rms.min() < 2e-3
    assert found.best.values["stiffness"] == pytest.approx(200.0, rel=1e-2)


def test_a_start_that_ends_at_the_noise_is_the_only_one():
    log = record(slider(), ("position",), noise=1e-3)
    assert len(estimate_from(slider(stiffness=18.0), log, ("stiffness",), 9, 0).rms) == 1


def test_starts_that_all_diverge_are_said_to():
    log = record(slider(), ("position",), n=20)
    with pytest.raises(DivergenceError):
        estimate_from(slider(), log, ("stiffness",), 2, 0, start={"stiffness": 1e9})
    with pytest.raises(InputError, match="give one or more"):
        estimate_from(slider(), log, ("stiffness",), 0, 0)


def test_a_start_that_the_plant_cannot_have_is_passed_over(monkeypatch):
    log = record(slider(), ("position",), noise=1e-3)
    search, seen = multistart.estimate, []

    def picky(plant, log, names, start, *rest):
        seen.append(start)
        if len(seen) == 2:
            raise InputError("no such start")
        return search(plant, log, names, start, *rest)

    monkeypatch.setattr(multistart, "estimate", picky)
    monkeypatch.setattr(multistart, "ENOUGH", 0.0)
    found = estimate_from(slider(stiffness=18.0), log, ("stiffness",), 3, 0)
    assert np.isfinite(found.rms).tolist() == [True, False, True]
