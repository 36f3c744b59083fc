"""Effects that begin at a time: one evaluation serves all times, as each of them alone would."""

from dataclasses import replace

import numpy as np
import pytest
from effect_cases import full

from identification import Log, Predictor
from identification.discovery.scoring.sensitivities import compute_sensitivities
from identification.effects.effect import Candidate
from identification.kalman.point import evaluate_point
from identification.model.coordinates import coordinates
from inca_mj.effects.catalogue import CATALOGUE
from inca_mj.effects.hooks import Drive
from inca_mj.robot.inputs import make_input
from inca_mj.twin.logs import ANGLES, CURRENTS

BEGINNING = [e for e in CATALOGUE if e.onset is not None]


@pytest.mark.parametrize("effect", BEGINNING, ids=lambda e: e.name)
def test_what_an_effect_adds_is_its_course_times_what_it_adds_in_the_end(effect):
    rng = np.random.default_rng(3)
    (law,) = (f.py_func for hook, f in effect.hooks.items() if hook != "rate")
    for t in (0.0, 1.96, 1.99, 2.0, 2.03, 2.06, 9.0):
        known = dict(zip(Drive._fields, rng.normal(size=25), strict=True))
        s = Drive(**{**known, "time": t, "F_s": 100.0})  # a spring that is far from slack
        course = float(effect.onset.course(np.array(t), 2.0))
        expected = course * law(s, (0.1, -1e6))
        np.testing.assert_allclose(law(s, (0.1, 2.0)), expected, rtol=1e-6, atol=1e-12)


def test_every_jump_of_the_robots_numbers_says_when_it_begins():
    jumps = {e.name for e in CATALOGUE if e.name.endswith("_jump") and "reading" not in e.hooks}
    assert {e.name for e in BEGINNING} == jumps
    assert len(jumps) > 5


def test_columns_of_many_times_are_those_of_each_time_alone():
    plant, u = full(), make_input("prbs", 2.0)
    log = Log(time=0.01 * np.arange(len(u)), inputs=u, outputs=np.zeros_like(u),
              input_names=CURRENTS, output_names=ANGLES)  # fmt: skip
    names = ("b_c", "K_t", "lambda")
    first = np.array([plant.parameters[name].value for name in names])
    space = coordinates(plant.parameters, names, first)
    point = evaluate_point(Predictor(plant, log, names), space, space.encode(first))
    chosen = {"friction_jump", "drum_radius_jump", "torque_constant_jump"}
    with_onset = [
        Candidate(e, "drive 3", {"t_s": t})
        for e in BEGINNING if e.name in chosen for t in (0.3, 0.7, 1.2, 1.9)
    ]  # fmt: skip
    alone = [
        replace(c, effect=replace(c.effect, onset=None, name=c.effect.name)) for c in with_onset
    ]
    found, expected = (compute_sensitivities(point, each) for each in (with_onset, alone))
    assert len(found) == len(expected) == len(with_onset)
    for one, other in zip(found, expected, strict=True):
        assert one.candidate.shape == other.candidate.shape
        size = np.linalg.norm(other.S)
        assert size > 0
        assert np.linalg.norm(one.S - other.S) < 1e-5 * size
