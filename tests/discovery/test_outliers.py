"""Times at which outputs jump: planted ones are found, and noise has none."""

import numpy as np
import pytest
from discovery_cases import OPTIONS, record, slider, wander

from identification.effects.effect import Candidate, Effect
from identification.effects.laws.sensors import encoder_jump
from identification.effects.sizes import Shape, Size
from identification.innovations.scoring.outliers import (
    MAX_JUMPS,
    find_outlier_times,
    list_at_outliers,
)
from identification.logs.joined import join_logs

T_S = Shape("t_s", "s", (1.0, 2.0), 0.1, 9.0, about="", step=0.1)
PLACES = {"drive 1": "@1", "drive 2": "@2"}


def effect(hook, shape=T_S):
    return Effect(
        "jump", "", (Size("c", "rad", 0.5, 1e-3, about=""),), (shape,), places=PLACES,
        hooks={hook: encoder_jump},
    )  # fmt: skip


@pytest.fixture(scope="module")
def log():
    return record(slider(), 400, 3, wander(400, 0.0, 0.1, 1), 1e-3)


def noise(log, seed, outputs=2):
    return np.random.default_rng(seed).standard_normal((len(log), outputs))


def test_noise_has_outliers_in_as_many_logs_as_chance_allows(log):
    found = [find_outlier_times(noise(log, k), log, 0.1, OPTIONS) for k in range(300)]
    # One per cent of 300 are 3; twelve or more would come once in 10 000 tries.
    assert sum(bool(times) for times in found) < 12


def test_the_largest_outliers_come_first_each_once(log):
    E = noise(log, 1)
    h = log.sampling_time
    E[100, 1], E[102, 1], E[300, 0] = 40.0, -30.0, 60.0
    apart = 5 * h
    assert find_outlier_times(E, log, apart, OPTIONS) == pytest.approx((300 * h, 100 * h))
    near = find_outlier_times(E, log, h, OPTIONS)
    assert near == pytest.approx((300 * h, 100 * h, 102 * h))
    E[200:210] = 20.0
    assert len(find_outlier_times(E, log, h, OPTIONS)) == MAX_JUMPS


def test_times_are_those_of_the_record(log):
    both = join_logs([log, record(slider(), 400, 4, wander(400, 0.0, 0.1, 2), 1e-3)])
    E = noise(both, 2)
    E[len(log) + 50, 0] = 50.0
    assert find_outlier_times(E, both, 0.1, OPTIONS) == pytest.approx((50 * log.sampling_time,))


def test_sensors_that_jump_are_tried_there_at_each_place_and_nothing_else(log):
    E = noise(log, 3)
    k = int(0.5 / log.sampling_time)
    E[k, 0] = 50.0
    jumps = [
        Candidate(effect(hook), where, {"t_s": t})
        for hook in ("reading", "torque")
        for where in PLACES
        for t in T_S.grid
    ]
    found = list_at_outliers(jumps, E, log, OPTIONS)
    assert [c.where for c in found] == [*PLACES]
    assert all("reading" in c.effect.hooks for c in found)
    assert [c.shape["t_s"] for c in found] == pytest.approx(2 * [k * log.sampling_time])
    E[k, 0], E[0, 0] = 0.0, 50.0  # a sensor that jumps as the record begins has an offset
    assert list_at_outliers(jumps, E, log, OPTIONS) == ()
    without = Shape("t_s", "s", (1.0,), 0.1, 9.0, about="")
    plain = Candidate(effect("reading", without), "drive 1", {"t_s": 1.0})
    assert list_at_outliers([plain], E, log, OPTIONS) == ()
