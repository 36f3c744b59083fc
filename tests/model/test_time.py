"""What changes with time in a robot goes on in windows and in parts of a record."""

import numpy as np
import pytest
from joint_cases import DAMPING, MASS, SLIDER, run, slider_log, steps
from numba import njit

from identification.effects.effect import Effect, places
from identification.effects.plant.joint_plant import joint_plant
from identification.effects.sizes import Size
from identification.errors import DivergenceError
from identification.kalman.linear import linearise
from identification.model.predictor import Predictor
from identification.model.rollout import State, rollout
from identification.windows.window_error import window_error


@njit
def growing_drag(s, p):
    """-c t v."""
    return -p[0] * s.time * s.v


DRAG = {"growing_drag.c@slide": 2.0}


def plant(start=None):
    own = Effect(
        "growing_drag", "-c t v", (Size("c", "N/m", 5.0, 0.05),),
        places=places("joint", ("slide",)), hooks={"force": growing_drag},
    )  # fmt: skip
    log = slider_log(steps(400))
    return joint_plant(SLIDER, (MASS, DAMPING), log, effects=(own,), start=start)


def record():
    u = steps(400, hold=7)
    return slider_log(u, run(plant(), slider_log(u), **DRAG))


def test_a_law_of_time_is_the_same_in_one_long_run_and_in_windows_of_it():
    log = record()
    assert np.abs(window_error(plant(), log, 0.25, DRAG)).max() < 2e-8
    assert np.abs(window_error(plant(), log, 0.25)).max() > 1e-4


def test_it_goes_on_in_a_part_of_a_record():
    log = record()
    part = log.part("validation")
    assert part.begun == pytest.approx(2.0)
    assert part.between(2.5, 3.0).begun == pytest.approx(2.5)
    assert np.abs(window_error(plant(), part, 0.25, DRAG)).max() < 2e-8
    moving = plant(State(np.array([0.4]), np.array([0.3]), np.zeros(0)))
    again = slider_log(part.inputs)  # the same inputs, but begun at zero
    assert np.abs(run(moving, part, **DRAG) - run(moving, again, **DRAG)).max() > 0.01


def test_a_linearisation_knows_the_time_too():
    log = record()
    part = log.part("validation")
    A = linearise(Predictor(plant(), part, tuple(DRAG)), np.array([2.0])).A
    # of the rate, over a sample: damping (3 + 2 t)/2, its mean over the sample
    t = 2.0 + 0.01 * (np.arange(len(A)) + 0.5)
    np.testing.assert_allclose(A[:, 1, 1], np.exp(-(3 + 2 * t) / 2 * 0.01), rtol=1e-6)


def test_each_simulation_has_a_start_of_its_own_in_time():
    one = plant()
    settings = one.settings(tuple(DRAG), np.full((3, 1), 2.0))
    start, numbers = settings
    start = State(start.qpos, start.qvel + 1.0, start.act)
    u = np.zeros((101, 1))
    found = rollout(one.model, start, u, 0.01, numbers=numbers, record=("qvel",),
                    time=np.array([0.0, 1.0, 5.0]))["qvel"][:, -1, 0]  # fmt: skip
    expected = [np.exp(-(3 + 2 * (t + 0.5)) / 2) for t in (0.0, 1.0, 5.0)]
    np.testing.assert_allclose(found, expected, rtol=1e-8)


def test_a_divergence_is_found_whenever_a_simulation_begins():
    one = plant()
    start, numbers = one.settings(tuple(DRAG), np.array([[2.0], [-5e5]]))
    start = State(start.qpos, start.qvel + 1.0, start.act)
    with pytest.raises(DivergenceError, match="value set 2 of 2"):
        rollout(one.model, start, np.zeros((101, 1)), 0.01, numbers=numbers, time=100.0)
