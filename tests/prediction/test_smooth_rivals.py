"""A law that draws what a smooth force does is no name, wherever the law acts.

The records are integrated in plain numpy (`servo_cases`).
"""

from dataclasses import dataclass, replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from servo_cases import DAMPING, WEIGHT, J, Servo, servo_log, setpoints

from identification import Parameter
from identification.discovery.candidates import list_common
from identification.discovery.nominal_model import NominalModel
from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Candidate, places
from identification.effects.plant.joint_plant import candidates, joint_plant
from identification.prediction.moves.add_curve import add_curve
from identification.prediction.moves.add_effect import add_effect
from identification.prediction.scoring.scores import window_scores
from identification.prediction.scoring.screening import at_several, single_places
from identification.prediction.selection import selection, smooth_rivals
from identification.prediction.selection.selection import refit_contenders
from identification.prediction.selection.smooth_rivals import (
    does_as_much,
    is_smooth_force,
    without_imitated,
)
from identification.prediction.state import first_state
from identification.prediction.task import RecordsTask
from identification.windows.records import as_records

AT_REST = Servo(weight=0.0)
# What the model of a servo at rest lacks: a force of the angle, or what its servo sums up.
SMOOTH, SUMMED = replace(AT_REST, weight=0.3 * WEIGHT), replace(AT_REST, k_i=25.0)
FREE = ("kp", "damping")
PARAMETERS = (
    Parameter(name="kp", value=8.0, unit="N m/rad", where="actuator/aim.kp", lower=1.0, upper=50.0),
    Parameter(name="damping", value=DAMPING, unit="N m s/rad", where="joint/pivot.damping",
              lower=1e-4, upper=10.0),
)  # fmt: skip


@cache
def plant():
    """The servo's lever with two free parameters, and all candidates."""
    return joint_plant(AT_REST.text(), PARAMETERS, servo_log(setpoints(0, 100)))


def record(truth, seed, samples=900):
    """A log with noise."""
    u, rng = setpoints(seed, samples), np.random.default_rng(seed)
    q = truth.moved(u, q=u[0])
    return replace(servo_log(u, q + 2e-4 * rng.standard_normal(q.shape)), name=f"log {seed}")


@cache
def searched(truth, without=()):
    """The model without a law, and what was refitted beside it."""
    base = NominalModel(plant(), FREE, np.full(2, 0.2), 0.3)
    logs = [record(truth, seed) for seed in (1, 2)]
    task = RecordsTask(
        nominal_model=base, records=as_records(logs[:1], logs[1:]), effects=(summing(),),
        options=DiscoveryOptions(without=without),
    )  # fmt: skip
    state = first_state(task, print)
    return refit_contenders(state.model, state.scores, 0.3, task.confirm, task.options, print)


def summing():
    """The law of a servo that sums up its error."""
    return next(e for e in candidates(plant(), FREE) if e.name == "integral_part")


def explaining(model, share):
    """A model in which such a law explains a share of what a model leaves."""
    law = SimpleNamespace(effect=summing(), where="joint pivot")
    return SimpleNamespace(candidates=(law,), fitted_power=(1 - share) * model.fitted_power)


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_a_force_of_the_angle_speaks_against_a_law_with_states_that_gains_no_more(share):
    model, _ = searched(SMOOTH)
    assert is_smooth_force(model, explaining(model, share))


def test_what_gains_far_more_than_any_smooth_force_is_none():
    model, _ = searched(SMOOTH)
    assert not is_smooth_force(model, explaining(model, 1 - 1e-9))


def test_a_law_without_states_is_not_asked():
    model, _ = searched(SMOOTH)
    plain = next(e for e in candidates(plant(), FREE) if e.name == "offset")
    law = SimpleNamespace(effect=plain, where="joint pivot")
    assert not is_smooth_force(model, SimpleNamespace(candidates=(law,), fitted_power=0.0))


@pytest.mark.parametrize("without", [(), ("free_states",)])
def test_what_a_servo_does_sum_up_is_proven(without):
    model, (law,) = searched(SUMMED, without)
    assert law.doubt is None
    assert not is_smooth_force(model, law.model)
    assert law.model.values["integral_part.k_i@pivot"] == pytest.approx(25.0, rel=0.05)


def test_the_search_refuses_what_a_smooth_force_explains(monkeypatch):
    model, (law,) = searched(SUMMED)
    monkeypatch.setattr(smooth_rivals, "is_smooth_force", lambda *_: True)
    assert without_imitated(model, law, DiscoveryOptions()).doubt == "smooth"
    without = DiscoveryOptions(without=("free_states",))
    assert without_imitated(model, law, without) is law


def test_where_a_smooth_force_refutes_all_laws_the_force_is_drawn(monkeypatch):
    """Laws are asked first, and curves where none of them is proven."""
    base = NominalModel(plant(), FREE, np.full(2, 0.2), 0.3)
    every = {e.name: e for e in candidates(plant(), FREE)}
    logs = [record(SMOOTH, seed) for seed in (1, 2)]
    task = RecordsTask(
        nominal_model=base, records=as_records(logs[:1], logs[1:]),
        effects=(every["gravity_force"], every["curve_position"]), options=DiscoveryOptions(),
    )  # fmt: skip
    state = first_state(task, print)
    scores = [replace(s, p_value=0.0) for s in state.scores]  # of a record as long as is needed

    def names(are_curves=False):
        asked = (state.model, scores, 0.3, task.confirm, task.options, print)
        _, found = refit_contenders(*asked, are_curves=are_curves)
        return [(c.candidate.effect.name, c.doubt) for c in found]

    assert names() == [("gravity_force", None)]

    def refuted(model, c, options):
        is_law = c.is_proven and not c.candidate.effect.is_curve
        return replace(c, doubt="smooth") if is_law else c

    monkeypatch.setattr(selection, "without_imitated", refuted)
    assert names() == [("gravity_force", "smooth")]
    assert ("curve_position", None) in names(are_curves=True)
    after = add_effect(replace(state, scores=tuple(scores)), print)
    assert [c.candidate.effect.name for c in after.rejected] == ["gravity_force"]
    (curve,) = add_curve(after, print).accepted
    assert curve.candidate.effect.name == "curve_position"
    assert curve.refits == 2  # chance pays for the law that was refused too


LATE = 4  # samples by which a setpoint comes late
CUBE = 20.0  # of a spring that hardens [N m/rad^3]


class Hardening(Servo):
    """A servo at rest with a spring that hardens."""

    def rate(self, s, x):
        """Of q, v and z."""
        return super().rate(s, x) - np.array([0.0, CUBE * s[0] ** 3 / J, 0.0])


@cache
def beside(kind, name):
    """The model of a record in which a kind of thing is hidden, and the model with one law more."""
    logs = []
    for seed in (1, 2):
        u = setpoints(seed, 900)
        if kind == "late":
            moved = AT_REST.moved(np.concatenate([np.full(LATE, u[0]), u[:-LATE]]), q=u[0])
        else:
            moved = Hardening(weight=0.0).moved(u, q=u[0])
        noise = 2e-4 * np.random.default_rng(seed).standard_normal(moved.shape)
        logs.append(replace(servo_log(u, moved + noise), name=f"{kind} {seed}"))
    base = NominalModel(plant(), FREE, np.full(2, 0.2), 0.3)
    every = candidates(plant(), FREE)
    task = RecordsTask(
        nominal_model=base, records=as_records(logs[:1], logs[1:]),
        effects=tuple(e for e in every if e.name == name), options=DiscoveryOptions(),
    )  # fmt: skip
    state = first_state(task, print)
    model, (law, *_) = refit_contenders(
        state.model, state.scores, 0.3, task.confirm, task.options, print
    )
    return model, law


def scored(model, name):
    """A law and what it explains of what a model leaves, as if it had been refitted."""
    law = next(c for c in list_common(candidates(plant(), FREE)) if c.effect.name == name)
    (score,) = window_scores(model.fit, [law])
    new = SimpleNamespace(candidates=(law,), fitted_power=(1 - score.fall) * model.fitted_power)
    return Proven(new)


@dataclass(frozen=True)
class Proven:
    """What is asked of a contender that is proven."""

    model: SimpleNamespace
    doubt: str | None = None

    @property
    def is_proven(self):
        """Whether nothing speaks against it."""
        return self.doubt is None


def test_a_force_of_the_angle_speaks_against_a_lag_of_the_setpoint_that_gains_less():
    model, law = beside("force", "hardening")
    assert not does_as_much(model, law.model)  # the force of one joint is asked in another way
    lag = scored(model, "lag")
    assert does_as_much(model, lag.model)
    assert without_imitated(model, lag, DiscoveryOptions()).doubt == "smooth"
    assert without_imitated(model, lag, DiscoveryOptions(without=("smooth_rivals",))) is lag


def test_a_setpoint_that_does_come_late_is_no_smooth_force():
    model, law = beside("late", "delay")
    assert law.is_proven
    assert not does_as_much(model, law.model)


@pytest.mark.parametrize(("where", "at"), [
    ("all joints", ["joint a", "joint b", "joint c"]), ("joint b", ["joint b"]),
    ("joint a and joint c", ["joint a", "joint c"]),
])  # fmt: skip
def test_a_law_acts_at_single_places(where, at):
    every = replace(summing(), places=places("joint", ("a", "b", "c")))
    effect = every if where in every.places else at_several(every, at)
    assert single_places(Candidate(effect, where, {})) == at
