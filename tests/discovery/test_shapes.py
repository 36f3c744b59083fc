"""Of kinds of one effect that a log does not tell apart the usual one is taken."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from discovery_cases import OPTIONS
from effect_cases import BY_NAME, full
from plain_logs import plain_log

from identification import Predictor
from identification.discovery.candidates import list_between
from identification.effects.effect import Candidate, Effect
from identification.effects.sizes import Shape, Size
from identification.innovations.moves import shapes
from identification.innovations.moves.shapes import BARE_BIC, improve_shape
from identification.innovations.scoring.sensitivities import compute_sensitivities
from identification.kalman.point import evaluate_point
from identification.model.coordinates import coordinates
from inca_mj.effects.catalogue import CATALOGUE
from inca_mj.effects.hooks import Drive
from inca_mj.robot.inputs import make_input
from inca_mj.studies.worlds import HiddenSetting, effect, world
from inca_mj.twin.logs import ANGLES, CURRENTS
from inca_mj.workflows.discovery import discover
from inca_mj.workflows.spread import spread_of

KINDS = Effect(
    "limit",
    "clip",
    (Size("c", "", 1.0, 0.1),),
    (
        Shape("at", "N", (1.0, 2.0), 0.1, 9.0),
        Shape("soft", "", (0.0, 1.0), 0.0, 1.0, free=False, usual=0.0),
    ),
    places={"joint": ""},
)


def candidate(soft):
    return Candidate(KINDS, "joint", {"at": 1.0, "soft": soft})


def of(soft, negative_bic):
    refit = SimpleNamespace(log_posterior=negative_bic / 2)
    return SimpleNamespace(candidates=(candidate(soft),), negative_bic=negative_bic, refit=refit)


def choose(monkeypatch, best, other, white=True):
    """What becomes of the best fit, and the kinds that were refitted."""
    asked = []

    def fit_shape(asked_of, model, s, least):
        asked.append(s.candidate.shape["soft"])
        behind = [f.refit.log_posterior - least for f in (best, other) if f is not None]
        assert any(0 <= b <= BARE_BIC / 2 for b in behind)
        return other

    monkeypatch.setattr(shapes, "is_structured", lambda model, options: not white)
    monkeypatch.setattr(shapes, "_fit_shape", fit_shape)
    gains = {1.0: 20.0, 0.0: 10.0}
    ranked = [SimpleNamespace(candidate=candidate(s), gain=g, size=[1.0]) for s, g in gains.items()]
    more = SimpleNamespace(candidates=(None,))
    return improve_shape(SimpleNamespace(options=OPTIONS), more, best, ranked), asked


@pytest.mark.parametrize(("ahead", "usual"), [(BARE_BIC - 0.1, True), (BARE_BIC + 0.1, False)])
def test_another_kind_must_be_better_by_more_than_a_bare_mention(monkeypatch, ahead, usual):
    best, other = of(1.0, 100.0 + ahead), of(0.0, 100.0)
    chosen, asked = choose(monkeypatch, best, other)
    assert chosen is (other if usual else best)
    assert asked == [0.0]


def test_where_structure_is_left_the_next_kind_is_tried_and_the_likelier_kept(monkeypatch):
    best, other = of(0.0, 100.0), of(1.0, 130.0)
    chosen, asked = choose(monkeypatch, best, other, white=False)
    assert asked[0] == 1.0
    assert chosen is other


@pytest.mark.long
def test_a_limit_that_two_levels_of_current_reach_alike_is_a_hard_one():
    setting = HiddenSetting(duration=4.5)  # PRBS: 0.5 and 1 A
    log, truth = world(71, [replace(effect("current_saturation"), i_max=0.9)], setting=setting)
    assert np.unique(log.inputs).size == 2
    answer = discover(log, effects=(BY_NAME["current_saturation"],), spread=spread_of("none"))
    (named,) = answer.named
    assert named.candidate.shape["soft"] == 0.0
    assert named.parameters["i_max"][0] == pytest.approx(truth.effects[0].i_max, rel=0.02)


@pytest.mark.parametrize(("here", "first", "last"), [(1.0, 1.25, 1.75), (2.0, 1.25, 3.75)])
def test_between_the_neighbours_of_a_value_all_steps_are_tried(here, first, last):
    late = replace(KINDS, shapes=(Shape("at", "s", (1.0, 2.0, 4.0), 0.1, 9.0, step=0.25),))
    tried = [c.shape["at"] for c in list_between(Candidate(late, "joint", {"at": here}))]
    assert tried == pytest.approx(np.arange(first, last + 0.1, 0.25))
    assert list_between(candidate(0.0)) == ()


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


def test_columns_of_many_times_are_those_of_each_time_alone():
    plant, u = full(), make_input("prbs", 2.0)
    log = plain_log(u, np.zeros_like(u), CURRENTS, ANGLES)
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
