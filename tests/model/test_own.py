"""Values of each record by itself: a joined log is predicted as its records are."""

from dataclasses import replace

import numpy as np
import pytest
from estimation_plants import SLIDER_PARAMETERS, slider

from identification import Log
from identification.kalman.linear import linearise
from identification.kalman.noise_model import Noise, build_whitener
from identification.logs.joined import join_logs
from identification.model.parameter import with_own
from identification.model.predictor import Predictor

H = 0.02


def log_of(n, seed):
    rng = np.random.default_rng(seed)
    return Log(time=H * np.arange(n), inputs=rng.standard_normal((n, 1)),
               outputs=rng.standard_normal((n, 2)), input_names=("force",),
               output_names=("position", "rate"), name=f"log {seed}")  # fmt: skip


A, B = log_of(60, 1), log_of(45, 2)
PLANT = slider()
OWN = replace(PLANT, parameters=with_own(SLIDER_PARAMETERS, ("x0", "v0"), 2))
NAMES = ("mass", "x0", "v0", "x0 [2]", "v0 [2]")
SETS = np.array([[2.0, 0.1, 0.0, -0.2, 0.3], [2.5, 0.1, 0.0, 0.4, 0.1], [2.0, 0.3, 1.0, -0.2, 0.3]])


def test_a_joined_log_is_predicted_as_its_records_are():
    both = Predictor(OWN, join_logs([A, B]), NAMES).predict(SETS)
    first = Predictor(PLANT, A, ("mass", "x0", "v0")).predict(SETS[:, :3])
    second = Predictor(PLANT, B, ("mass", "x0", "v0")).predict(SETS[:, [0, 3, 4]])
    np.testing.assert_array_equal(both, np.concatenate([first, second], axis=1))
    some = Predictor(OWN, join_logs([A, B]), NAMES).predict(SETS, 70)
    np.testing.assert_array_equal(some, both[:, :70])


def test_fixed_values_reach_their_own_record():
    fixed = {"mass": 2.5, "x0 [2]": 0.4, "v0 [2]": 0.1}
    both = Predictor(OWN, join_logs([A, B]), ("x0",), fixed).predict(np.array([[0.1]]))
    known = {"mass": 2.5, "x0": 0.4, "v0": 0.1}
    second = Predictor(PLANT, B, (), known).predict(np.empty((1, 0)))
    np.testing.assert_array_equal(both[:, 60:], second)


@pytest.fixture(scope="module")
def plants():
    joined = linearise(Predictor(OWN, join_logs([A, B]), NAMES), SETS[1])
    own = [linearise(Predictor(PLANT, log, ("mass", "x0", "v0")), row)
           for log, row in ((A, SETS[1, :3]), (B, SETS[1, [0, 3, 4]]))]  # fmt: skip
    return joined, own


def test_a_predictor_begins_anew_with_each_record(plants):
    joined, own = plants
    e, noise = np.random.default_rng(5).standard_normal((105, 2)), Noise(0.4, 0.1)
    both = build_whitener(joined, noise, H)
    each = [build_whitener(plant, noise, H) for plant in own]
    alone = np.concatenate([each[0](e[:60]), each[1](e[60:])])
    np.testing.assert_allclose(both(e), alone, atol=1e-12)
    assert both.log_determinant == pytest.approx(sum(w.log_determinant for w in each), rel=1e-12)
