"""A curve that acts on several joints: its nodes are told at each of them, in all that is written.

Each joint has a range of its own, so that a curve over two joints has eight sizes at each of them.
"""

import json
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from arm_cases import LOG, text
from page_text import text_of

from identification.discovery.nominal_model import NominalModel
from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Candidate
from identification.effects.joint_plant import candidates, joint_plant
from identification.model.parameter import Parameter
from identification.model.predictor import Predictor
from identification.prediction.extension import with_effect
from identification.prediction.first_fit import begin
from identification.prediction.moves.curve_for_laws import _joints_of_several
from identification.prediction.moves.drop_drawn_laws import drop_drawn_laws
from identification.prediction.records import as_records
from identification.prediction.scores import window_scores
from identification.prediction.selection import Contender
from identification.prediction.several_places import at_several
from identification.prediction.state import first_state
from identification.prediction.task import RecordsTask
from identification.prediction.unseen import compare
from identification.prediction.verdict import conclude
from identification.report.curve_nodes import curve_nodes
from identification.report.discovery_json import discovery_to_json
from identification.report.discovery_report import write_discovery_report
from identification.report.discovery_text import discovery_text
from identification.report.effect_words import describe_there

JOINTS, HORIZON, NOISE = ("shoulder", "elbow"), 0.2, 3e-4
BOTH = "joint shoulder and joint elbow"
TRUTH = {"quadratic_friction.c@shoulder": 0.08, "quadratic_friction.c@elbow": 0.03}
FREE = Parameter(
    name="d", value=0.05, unit="N m s/rad", where="joint/elbow.damping", lower=0.0, upper=1.0
)


@cache
def plant():
    return joint_plant(text(0.002, "implicitfast"), (FREE,), LOG)


def record(seed):
    rng = np.random.default_rng(seed)
    u = np.repeat(rng.uniform(-1, 1, (10, 2)) * (4.0, 1.5), 20, axis=0)
    log = replace(LOG, time=0.01 * np.arange(200), inputs=u, outputs=np.zeros((200, 2)))
    y = Predictor(plant(), log, tuple(TRUTH)).predict(np.array([[*TRUTH.values()]]))[0]
    return replace(log, outputs=y + NOISE * rng.standard_normal(y.shape), name=f"record {seed}")


def effect(name):
    return next(e for e in candidates(plant(), ("d",)) if e.name == name)


def over_both(name):
    several = at_several(effect(name), [f"joint {joint}" for joint in JOINTS])
    return Candidate(several, BOTH, {})


@cache
def state_with_a_curve():
    """A state whose model has a curve of speed at both joints; nothing judged whether it should."""
    task = RecordsTask(
        nominal_model=NominalModel(plant(), ("d",), np.array([0.5]), HORIZON), horizon=HORIZON,
        records=as_records([record(1)], [record(2), record(3)]),
        effects=(effect("curve_speed"),), options=DiscoveryOptions(),
    )  # fmt: skip
    state = first_state(task, lambda line: None)
    parent = state.model
    (score,) = window_scores(parent.fit, [over_both("curve_speed")])
    model = with_effect(parent, begin(parent, [score]), HORIZON, task.confirm)
    claim = Contender(
        model=model, prediction=compare(parent.unseen, model.unseen), gains=np.ones(9),
        numbers=16, criterion=50.0, doubt=None,
    )  # fmt: skip
    return replace(
        state, model=model, accepted=(claim,), moves=(),
        rejected=(replace(claim, doubt="chance"),),
    )  # fmt: skip


@cache
def found():
    return conclude(state_with_a_curve())


@pytest.mark.parametrize(
    "name", ["curve_speed", "curve_load", "curve_position", "curve_before", "curve_speed_behind"]
)
def test_nodes_at_several_joints_are_those_at_each_of_them(name):
    each = curve_nodes(over_both(name), plant())
    assert [n.joint for n in each] == [*JOINTS]
    for n in each:
        (alone,) = curve_nodes(Candidate(effect(name), f"joint {n.joint}", {}), plant())
        np.testing.assert_array_equal(n.at, alone.at)
        assert (n.reads, n.unit, n.depends_on) == (alone.reads, alone.unit, alone.depends_on)
    assert BOTH in describe_there(over_both(name), plant())


def test_the_json_has_the_nodes_by_joint():
    told = json.loads(json.dumps(discovery_to_json(found())))
    for curve in (*told["effects"], *told["rejected"]):
        assert (curve["name"], curve["where"], curve["depends_on"]) == ("unlisted", BOTH, "speed")
        assert list(curve["joints"]) == [f"joint {joint}" for joint in JOINTS]
        assert [len(n["nodes"]) for n in curve["joints"].values()] == [8, 8]
        assert curve["joints"]["joint elbow"]["reads"] == "rate of elbow"
    assert told["effects"]
    assert told["rejected"]


def test_sentences_and_page_tell_the_nodes_of_each_joint(tmp_path):
    said = discovery_text(found())
    assert "c_1 to c_8 of joint shoulder stand at" in said
    assert "; c_1 to c_8 of joint elbow stand at" in said
    page = text_of(write_discovery_report(found(), tmp_path).read_text())
    assert "c_1 to c_8 of joint elbow stand at" in page


def claimed(name, where):
    claim = state_with_a_curve().accepted[0]
    model = replace(claim.model, candidates=(Candidate(effect(name), where, {}),))
    return replace(claim, model=model)


def test_laws_at_a_joint_that_has_a_curve_already_need_no_other_one():
    laws = [claimed(name, "joint elbow") for name in ("quadratic_friction", "offset")]
    curve = state_with_a_curve().accepted[0]
    assert _joints_of_several(laws) == ["joint elbow"]
    assert _joints_of_several([*laws, curve]) == []


def test_a_curve_over_several_joints_does_what_a_law_at_one_of_them_did():
    state = state_with_a_curve()
    law = claimed("quadratic_friction", "joint elbow")
    law = replace(law, prediction=replace(law.prediction, fall=0.5))
    said = []
    both = replace(state, accepted=(law, *state.accepted))
    _, kept, lost = drop_drawn_laws(both, said.append)
    assert [*kept] == [*state.accepted]
    assert [a.doubt for a in lost] == ["drawn"]
    assert said == ["quadratic_friction, joint elbow: a curve does the same, and more"]
