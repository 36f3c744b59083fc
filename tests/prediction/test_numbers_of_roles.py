"""Records contradict a law only where its numbers differ between the roles of the records."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from exchange_cases import LOAD, MU, NAME, SAMPLES, other_side, pair, unproven
from records_cases import HORIZON, nominal_model, pendulum, record, with_law

from identification.discovery.options import DiscoveryOptions
from identification.prediction.fits.nominal_fit import fit_nominal
from identification.prediction.judging.trial import compared
from identification.prediction.selection.exchange import _differ, exchanged, is_contradicted
from identification.prediction.selection.set_proof import _by_both_roles
from identification.windows.records import as_records

OPTIONS = DiscoveryOptions()


def test_a_worse_prediction_contradicts_only_where_the_numbers_of_both_roles_differ():
    """A record that hardly tells a size predicts the others worse with it."""
    _, _, with_it = pair("has it")
    without, other = other_side("has it")
    worse = replace(without, unseen=other.unseen), replace(other, unseen=without.unseen)
    assert compared(worse[0].unseen, worse[1].unseen, OPTIONS).gain < 0
    assert not is_contradicted(*worse, with_it, OPTIONS)
    assert is_contradicted(*worse, with_it, DiscoveryOptions(without=("numbers_of_roles",)))
    bound = replace(with_it, fit=replace(with_it.fit, q=np.zeros_like(with_it.fit.q)))
    assert is_contradicted(*worse, bound, OPTIONS)  # its size is zero there


@pytest.mark.parametrize(("mu", "most", "least"), [(0.15, 2, 0), (0.05, 12, 10)])
def test_numbers_of_one_law_seldom_differ_between_roles_and_those_of_two_nearly_always(
    mu, most, least
):
    differ = []
    for seed in range(12):
        fitted = [record(k, SAMPLES, LOAD, plant=pendulum()) for k in (50 + seed, 70 + seed)]
        last = record(90 + seed, SAMPLES, {MU: mu}, plant=pendulum())
        every = as_records(fitted, [last])
        with_it = with_law(fit_nominal(nominal_model(), every), NAME, every)
        other = exchanged(with_it, every, HORIZON)
        differ.append(_differ(with_it, other, with_it.candidates, OPTIONS.significance))
    assert least <= sum(differ) <= most


@pytest.mark.parametrize(("without", "doubt"), [((), None), (("proof_by_both_roles",), "chance")])
def test_a_member_of_a_set_that_misses_chance_alone_is_judged_by_both_roles(without, doubt):
    every, bare, _ = pair("has it")
    options = DiscoveryOptions(without=without)
    task = SimpleNamespace(options=options, records=every, horizon=HORIZON)
    found = _by_both_roles(SimpleNamespace(task=task), bare, unproven("has it"))
    assert found.doubt == doubt
