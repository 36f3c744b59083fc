"""What a search will take is told before, and refused where the machine lacks it."""

import numpy as np
import pytest
from joint_cases import slider, slider_log

from identification import InputError
from identification.discovery import forecast as module
from identification.discovery.forecast import Forecast, forecast, free_memory, refuse_large
from identification.discovery.nominal_model import NominalModel
from identification.discovery.options import DiscoveryOptions
from identification.discovery.scoring.sensitivities import BATCH, list_common, list_single
from identification.discovery.search import discover
from identification.discovery.task import DiscoveryTask

FREE = ("mass", "damping")


def task(samples, effects=None):
    plant = slider()
    model = NominalModel(plant, FREE, np.full(len(FREE), 0.3))
    chosen = plant.effects if effects is None else effects
    return DiscoveryTask(model, slider_log(np.ones((samples, 1))), chosen, DiscoveryOptions())


def without_fixed(samples, effects=None):
    needs = forecast(task(samples, effects))
    return needs.memory - needs.fixed


def test_memory_grows_with_the_candidates_and_their_sizes():
    without, few, every = ((), slider().effects[:3], slider().effects)
    assert 0 < without_fixed(300, without) < without_fixed(300, few) < without_fixed(300, every)


def test_a_candidate_beyond_a_batch_costs_its_sensitivity_alone():
    every = slider().effects
    fewer = every[:-1]
    sizes = [
        sum(len(c.sizes) for c in (*list_common(some), *list_single([*first(some)])))
        for some in (fewer, every)
    ]
    assert sizes[1] > sizes[0] >= BATCH  # on one output, of the half that is fitted
    more = without_fixed(300) - without_fixed(300, fewer)
    assert more == pytest.approx(8 * 150 * (sizes[1] - sizes[0]))


def first(effects):
    return {c.effect.name: c for c in list_common(effects)}.values()


@pytest.mark.parametrize("effects", [(), None])
def test_memory_is_linear_in_the_samples(effects):
    assert without_fixed(900, effects) == pytest.approx(3 * without_fixed(300, effects))
    one, other = (forecast(task(n, effects)).fixed for n in (300, 900))
    assert one == other > 0  # code, libraries and copies of the model


def test_a_log_that_is_cut_as_it_says_is_not_refused_again(monkeypatch):
    monkeypatch.setattr(module, "free_memory", lambda: 2.0**30)
    needs = Forecast(1000, 2.0**31, 1.0, fixed=2.0**28)
    with pytest.raises(InputError, match="cut the log to 428 samples"):
        refuse_large(needs, 1.0, 200)
    each = (needs.memory - needs.fixed) / needs.samples
    refuse_large(Forecast(428, needs.fixed + 428 * each, 1.0, needs.fixed), 1.0, 200)


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
