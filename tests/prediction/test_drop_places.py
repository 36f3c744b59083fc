"""An effect that was named at several places keeps those where it does something."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from arm_cases import LOG, text

from identification.discovery.nominal_model import NominalModel
from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Candidate, Effect
from identification.effects.plant.joint_plant import candidates, joint_plant
from identification.effects.sizes import Size
from identification.model.parameter import Parameter
from identification.model.predictor import Predictor
from identification.prediction.discovery import WINDOWS
from identification.prediction.fits.nominal_fit import fit_nominal
from identification.prediction.judging.extension import with_effect
from identification.prediction.judging.trial import Contender
from identification.prediction.moves.drop_places import drop_places
from identification.prediction.scoring import screening
from identification.prediction.scoring.first_fit import begin
from identification.prediction.scoring.scores import WindowScore, window_scores
from identification.prediction.scoring.screening import at_several, felt_places, places_of
from identification.prediction.task import RecordsTask
from identification.prediction.verdict.verdict import conclude
from identification.report.discovery.named_words import curve_nodes
from identification.report.words.effects import describe_there
from identification.windows.comparison import compare
from identification.windows.records import as_records

PLACES, HORIZON, NOISE = ["joint shoulder", "joint elbow"], 0.2, 3e-4
SIZES = ("quadratic_friction.c@shoulder", "quadratic_friction.c@elbow")
FREE = Parameter(
    name="d", value=0.05, unit="N m s/rad", where="joint/elbow.damping", lower=0.0, upper=1.0
)


@cache
def plant():
    return joint_plant(text(0.002, "implicitfast"), (FREE,), LOG)


def record(seed, sizes, samples=300):
    rng = np.random.default_rng(seed)
    u = np.repeat(rng.uniform(-1, 1, (samples // 20, 2)) * (4.0, 1.5), 20, axis=0)
    log = replace(LOG, time=0.01 * np.arange(samples), inputs=u, outputs=np.zeros((samples, 2)))
    y = Predictor(plant(), log, tuple(sizes)).predict(np.array([[*sizes.values()]]))[0]
    return replace(log, outputs=y + NOISE * rng.standard_normal(y.shape), name=f"record {seed}")


@cache
def named(shoulder, elbow):
    """The nominal model, what confirms, the model with friction at both joints, its claim."""
    truth = dict(zip(SIZES, (shoulder, elbow), strict=True))
    first, second, *rest = (record(k, truth) for k in (1, 2, 3, 4))
    roles = as_records([first, second], rest)
    base = NominalModel(plant(), ("d",), np.array([0.5]), HORIZON)
    parent = fit_nominal(base, roles)
    every = next(e for e in candidates(plant(), ("d",)) if e.name == "quadratic_friction")
    effect = at_several(every, PLACES)
    shape = {s.name: s.values[0] for s in effect.shapes}
    (score,) = window_scores(parent.fit, [Candidate(effect, next(iter(effect.places)), shape)])
    model = with_effect(parent, begin(parent, [score]), HORIZON, roles[2:])
    claim = Contender(
        model=model, prediction=compare(parent.unseen, model.unseen), gains=np.zeros(0),
        numbers=2, criterion=0.0, explained=0.0, doubt=None,
    )  # fmt: skip
    return base, roles[2:], model, claim


def pruned(shoulder, elbow):
    base, confirm, model, claim = named(shoulder, elbow)
    said = []
    task = SimpleNamespace(
        nominal_model=base, confirm=confirm, horizon=base.horizon, options=DiscoveryOptions()
    )
    found = drop_places(SimpleNamespace(model=model, accepted=[claim], task=task), said.append)
    return model, *found, said


def test_a_place_without_the_effect_is_left_out_and_the_other_keeps_its_size():
    before, after, (claim,), _, said = pruned(0.0, 0.01)
    assert claim.candidate.where == "joint elbow"
    assert claim.candidate.sizes == after.candidates[-1].sizes == SIZES[1:]
    assert after.fit.values[SIZES[1]] == pytest.approx(0.01, abs=4 * after.std[SIZES[1]])
    assert after.std[SIZES[1]] <= 1.1 * before.std[SIZES[1]]
    assert SIZES[0] not in after.fit.values
    assert said == ["quadratic_friction: no longer needed at joint shoulder"]


def test_a_model_with_the_effect_at_all_its_places_stays_as_it_is():
    before, after, (claim,), _, said = pruned(0.02, 0.01)
    assert after is before
    assert places_of(claim.candidate.where) == PLACES
    assert said == []


WHERE = {"all joints": "", "joint a": "@a", "joint b": "@b", "joint c": "@c"}
EFFECT = Effect("friction", "μ |f|", (Size("mu", "", 0.2, 0.002, 1),), places=WHERE)


def test_its_parameters_are_those_of_the_single_places():
    several = at_several(EFFECT, ["joint a", "joint c"])
    (where,) = several.places
    assert where == "joint a and joint c"
    assert Candidate(several, where, {}).sizes == ("friction.mu@a", "friction.mu@c")
    singles = [Candidate(EFFECT, f"joint {x}", {}).sizes[0] for x in "ac"]
    assert [*Candidate(several, where, {}).sizes] == singles


def several(sizes, std, places=("joint a", "joint b", "joint c")):
    effect = at_several(EFFECT, places)
    return WindowScore(
        candidate=Candidate(effect, next(iter(effect.places)), {}), size=np.array(sizes),
        std=np.array(std), fall=0.2, p_value=1e-6, along=np.zeros(0),
    )  # fmt: skip


@pytest.mark.parametrize("is_among", [True, False])
def test_what_all_places_have_in_common_is_no_part_of_an_effect_beside_others(
    monkeypatch, is_among
):
    """All sensors that are late are inputs that are late: the least late one is the reference."""
    sizes = dict(zip("abc", (0.06, 0.02, 0.05), strict=True))
    effect = replace(EFFECT, is_among=is_among)

    def scored(fit, asked):
        ((c,),) = [asked]
        at = [sizes[p[-1]] for p in places_of(c.where)]
        return [replace(several(at, [0.001] * len(at), places_of(c.where)), candidate=c)]

    monkeypatch.setattr(screening, "window_scores", scored)
    single = replace(several((0.06,), (0.001,)), candidate=Candidate(effect, "joint a", {}))
    (found,) = screening.several_scores(SimpleNamespace(fit=None), [single], DiscoveryOptions())
    kept = ["joint a", "joint c"] if is_among else ["joint a", "joint b", "joint c"]
    assert places_of(found.candidate.where) == kept


@pytest.mark.parametrize(
    ("sizes", "std", "kept"),
    [
        ((0.06, 0.08, 0.05), (0.01, 0.01, 0.01), ["joint a", "joint b", "joint c"]),
        ((0.06, -0.08, 0.05), (0.01, 0.01, 0.01), ["joint a", "joint c"]),  # a sign
        ((0.06, 0.08, 0.01), (0.01, 0.01, 0.01), ["joint a", "joint b"]),  # within its std
        ((0.06, 1.5, 0.05), (0.01, 0.01, 0.01), ["joint a", "joint c"]),  # too large
        ((-0.06, -0.08, 0.01), (0.01, 0.01, 0.01), []),
    ],
)
def test_places_stay_where_the_size_is_admitted_and_beyond_its_std(sizes, std, kept):
    places = ["joint a", "joint b", "joint c"]
    assert felt_places(several(sizes, std), places, EFFECT, DiscoveryOptions()) == kept


JOINTS = "shoulder", "elbow"
BOTH = "joint shoulder and joint elbow"
TRUTH = dict(zip(SIZES, (0.08, 0.03), strict=True))


def effect(name):
    return next(e for e in candidates(plant(), ("d",)) if e.name == name)


def over_both(name):
    several = at_several(effect(name), [f"joint {joint}" for joint in JOINTS])
    return Candidate(several, BOTH, {})


@cache
def state_with_a_curve():
    """A state whose model has a curve of speed at both joints; nothing judged whether it should."""
    task = RecordsTask(
        nominal_model=NominalModel(plant(), ("d",), np.array([0.5]), HORIZON),
        records=as_records([record(1, TRUTH, 200)], [record(k, TRUTH, 200) for k in (2, 3)]),
        effects=(effect("curve_speed"),), options=DiscoveryOptions(),
    )  # fmt: skip
    state = WINDOWS.begin(task, lambda line: None)
    parent = state.model
    (score,) = window_scores(parent.fit, [over_both("curve_speed")])
    model = with_effect(parent, begin(parent, [score]), HORIZON, task.confirm)
    claim = Contender(
        model=model, prediction=compare(parent.unseen, model.unseen), gains=np.ones(9),
        numbers=16, criterion=50.0, explained=0.0, doubt=None,
    )  # fmt: skip
    return replace(
        state, model=model, accepted=(claim,), moves=(),
        rejected=(replace(claim, doubt="chance"),),
    )  # fmt: skip


@cache
def found():
    return conclude(state_with_a_curve())


@pytest.mark.parametrize("name", ["curve_speed", "curve_before"])
def test_nodes_at_several_joints_are_those_at_each_of_them(name):
    each = curve_nodes(over_both(name), plant())
    assert [n.joint for n in each] == [*JOINTS]
    for n in each:
        (alone,) = curve_nodes(Candidate(effect(name), f"joint {n.joint}", {}), plant())
        np.testing.assert_array_equal(n.at, alone.at)
        assert (n.reads, n.unit, n.depends_on) == (alone.reads, alone.unit, alone.depends_on)
    assert BOTH in describe_there(over_both(name), plant())


def test_what_changes_a_level_has_places_where_the_model_has_one(monkeypatch):
    monkeypatch.setattr(screening, "has_what_it_needs", lambda model, c: c.where != "joint b")
    monkeypatch.setattr(
        screening, "window_scores",
        lambda fit, asked: [several([0.06, 0.07], [0.001] * 2, places_of(asked[0].where))],
    )  # fmt: skip
    single = replace(several((0.06,), (0.001,)), candidate=Candidate(EFFECT, "joint a", {}))
    (found,) = screening.several_scores(SimpleNamespace(fit=None), [single], DiscoveryOptions())
    assert places_of(found.candidate.where) == ["joint a", "joint c"]
