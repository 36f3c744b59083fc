"""The last fit of a search: priors weigh against the errors of the model with what is named."""

from functools import cache

import numpy as np
import pytest
from records_cases import FREE, HORIZON, nominal_model, records, roles, search

from identification.discovery.nominal_model import NominalModel
from identification.prediction.fits.nominal_fit import fit_nominal

HIDDEN, SIZE = "hardening.k_3@hinge", 0.2
KNOWN = np.array([0.3, 0.3])  # of what is free, far from which the truth lies: 2e-3 of 1.5e-3


@cache
def logs():
    return records(4, {HIDDEN: SIZE}, samples=400)


def model(names=FREE, known=KNOWN):
    return NominalModel(nominal_model().plant, names, known, HORIZON)


@cache
def found(*without):
    return search(logs(), ["hardening"], model(), without=without).final


@cache
def told():
    """The fit of a model that has the effect from the beginning, whose size is free."""
    free = model((*FREE, HIDDEN), np.array([*KNOWN, 1e3]))
    return fit_nominal(free, roles(logs())).fit


@pytest.mark.parametrize("name", FREE)
def test_values_beside_a_named_effect_are_those_of_a_model_that_always_had_it(name):
    mine, theirs = found(), told()
    at = theirs.problem.names.index(name)
    std = theirs.std[at]
    assert mine.values[name] == pytest.approx(theirs.values[name], abs=2 * std)
    assert mine.std[name] == pytest.approx(std, rel=0.3)


def test_without_it_priors_pull_values_to_their_means():
    theirs = told()
    off = [abs(found("priors_of_last_fit").values[n] - theirs.values[n])
           / theirs.std[theirs.problem.names.index(n)] for n in FREE]  # fmt: skip
    assert max(off) > 10
