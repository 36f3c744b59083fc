"""What a search will take is told before, and refused where the machine lacks it."""

import tracemalloc
from dataclasses import replace

import numpy as np
import pytest
from joint_cases import ARM, DAMPING, arm_log, joint_plant, run, slider, slider_log, steps

from identification import InputError
from identification.discovery.nominal_model import NominalModel
from identification.discovery.options import DiscoveryOptions
from identification.innovations import forecast as module
from identification.innovations.discovery import INNOVATIONS, discover
from identification.innovations.forecast import Forecast, forecast, refuse_large
from identification.innovations.task import DiscoveryTask

FREE = ("mass", "damping")


def task(samples, effects=None):
    plant = slider()
    model = NominalModel(plant, FREE, np.full(len(FREE), 0.3))
    chosen = plant.effects if effects is None else effects
    return DiscoveryTask(
        nominal_model=model,
        log=slider_log(np.ones((samples, 1))),
        effects=chosen,
        options=DiscoveryOptions(),
    )


FACTOR = 1.5  # the goal of the forecast


def arm_task(samples):
    """Two joints, whose inputs both move."""
    log = arm_log(steps(samples, 2))
    damping = replace(DAMPING, where="joint/elbow.damping", unit="N m s/rad", value=0.1)
    plant = joint_plant(ARM, (damping,), log)
    model = NominalModel(plant, ("damping",), np.full(1, 0.3))
    y = run(plant, log) + 1e-4 * np.random.default_rng(1).standard_normal(log.outputs.shape)
    return DiscoveryTask(
        nominal_model=model,
        log=replace(log, outputs=y),
        effects=plant.effects,
        options=DiscoveryOptions(),
    )


def slider_task(samples):
    given = task(samples)
    log = slider_log(steps(samples))
    y = run(given.nominal_model.plant, log)
    y = y + 1e-4 * np.random.default_rng(1).standard_normal(y.shape)
    return replace(given, log=replace(log, outputs=y))


def without_fixed(samples, effects=None):
    needs = forecast(task(samples, effects))
    return needs.memory - needs.fixed


def test_memory_grows_with_the_candidates_and_their_sizes():
    without, few, every = ((), slider().effects[:3], slider().effects)
    assert 0 < without_fixed(300, without) < without_fixed(300, few) < without_fixed(300, every)


def test_memory_is_linear_in_the_samples():
    effects = None
    assert without_fixed(900, effects) == pytest.approx(3 * without_fixed(300, effects))
    one, other = (forecast(task(n, effects)).fixed for n in (300, 900))
    assert one == other > 0  # code, libraries and copies of the model


@pytest.mark.long
@pytest.mark.parametrize("make", [slider_task, arm_task])
def test_a_search_holds_the_arrays_of_its_forecast(make):
    """The most that arrays take at once, once all code is loaded."""
    given = make(500)
    needs, copies = forecast(given), float(given.nominal_model.plant.model.nbuffer)
    fixed = module.BASE_BYTES + module.MODEL_COPIES * copies
    data = (needs.memory - fixed) / (1 + module.KEPT_SHARE)
    INNOVATIONS.begin(make(200), lambda line: None)
    tracemalloc.start()
    try:
        INNOVATIONS.begin(given, lambda line: None)
        held = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert data / FACTOR < held < data * FACTOR


def test_a_log_that_is_cut_as_it_says_is_not_refused_again(monkeypatch):
    monkeypatch.setattr(module, "free_memory", lambda: 2.0**30)
    needs = Forecast(1000, 2.0**31, 1.0, fixed=2.0**28)
    told = "cut the log to 428 samples, or keep one sample of 3 .every = 3 in a robot's TOML"
    with pytest.raises(InputError, match=told):
        refuse_large(needs, 1.0, 200)
    each = (needs.memory - needs.fixed) / needs.samples
    refuse_large(Forecast(428, needs.fixed + 428 * each, 1.0, needs.fixed), 1.0, 200)


def test_a_search_is_refused_before_it_begins(monkeypatch):
    monkeypatch.setattr(module, "free_memory", lambda: 1e3)
    said = []
    given = task(500)
    with pytest.raises(InputError, match="allow more by the option max_memory_share"):
        discover(given.nominal_model, given.log, given.effects, said.append)
    assert said == []
