"""What a search will take is told before, and refused where the machine lacks it."""

import numpy as np
import pytest
from joint_cases import slider, slider_log

from identification import InputError
from identification.discovery import forecast as module
from identification.discovery.forecast import Forecast, forecast, free_memory, refuse_large
from identification.discovery.nominal_model import NominalModel
from identification.discovery.options import DiscoveryOptions
from identification.discovery.search import discover
from identification.discovery.task import DiscoveryTask

FREE = ("mass", "damping")


def task(samples, effects=None):
    plant = slider()
    model = NominalModel(plant, FREE, np.full(len(FREE), 0.3))
    chosen = plant.effects if effects is None else effects
    return DiscoveryTask(model, slider_log(np.ones((samples, 1))), chosen, DiscoveryOptions())


def test_memory_is_that_of_the_sensitivities():
    one = forecast(task(300, ())).memory
    assert one == module.COPIES * 8 * 300 * 1 * len(FREE)  # no candidate: the parameters alone
    assert forecast(task(300)).memory > one


@pytest.mark.parametrize("effects", [(), None])
def test_memory_grows_with_the_samples(effects):
    assert forecast(task(900, effects)).memory == 3 * forecast(task(300, effects)).memory


@pytest.mark.parametrize(("least", "said"), [(200, "cut the log to 250 samples"),
                                             (300, "close other programs")])  # fmt: skip
def test_what_needs_more_than_is_free_is_refused(monkeypatch, least, said):
    monkeypatch.setattr(module, "free_memory", lambda: 2.0**30)
    needs = Forecast(1000, 2 * 2.0**30, 1.0)
    with pytest.raises(InputError, match=said):
        refuse_large(needs, 0.5, least)
    refuse_large(needs, 2.0, least)


def test_a_search_is_refused_before_it_begins(monkeypatch):
    monkeypatch.setattr(module, "free_memory", lambda: 1e3)
    said = []
    given = task(500)
    with pytest.raises(InputError, match="allow more by the option max_memory_share"):
        discover(given.nominal_model, given.log, given.effects, said.append)
    assert said == []


@pytest.mark.parametrize(("seconds", "said"), [(30.0, "30 s"), (90.0, "1.5 min"), (9e3, "2.5 h")])
def test_it_is_told_in_words(seconds, said):
    needs = Forecast(500, 2.0**29, seconds)
    assert f"500 samples need about 0.5 GB of memory and {said} of processor time" in str(needs)
    assert needs.is_large is (seconds > 60)


def test_there_is_free_memory():
    assert 2.0**20 < free_memory() <= np.inf
