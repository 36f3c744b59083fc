"""A law whose states are free in each window is none where a smooth force gains as much.

The records are integrated in plain numpy (`servo_cases`).
"""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from servo_cases import DAMPING, WEIGHT, Servo, servo_log, setpoints

from identification import Parameter
from identification.discovery.nominal_model import NominalModel
from identification.discovery.options import DiscoveryOptions
from identification.effects.joint_plant import candidates, joint_plant
from identification.prediction import free_states
from identification.prediction.free_states import is_smooth_force, without_free_states
from identification.prediction.selection import refit_contenders
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
    monkeypatch.setattr(free_states, "is_smooth_force", lambda *_: True)
    assert without_free_states(model, law, DiscoveryOptions()).doubt == "drawn"
    without = DiscoveryOptions(without=("free_states",))
    assert without_free_states(model, law, without) is law
