"""A curve takes the place of a law only where the law does not predict better."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from identification.discovery.options import DiscoveryOptions
from identification.prediction.moves.curve_for_laws import _does_what_they_do
from identification.windows.unseen import Unseen

OPTIONS = DiscoveryOptions()
WINDOWS = 30


def model(rms, seed):
    """A model of one output whose unseen windows err by some rms, over every length alike."""
    rng = np.random.default_rng(seed)
    each = ((rms**2 * rng.chisquare(20, (WINDOWS, 1)) / 20,),) * 3
    return SimpleNamespace(unseen=Unseen(
        lengths=(0.5, 1.0, 2.0), powers=each, moves=each,
        noise=np.array([1.0]), fit_percent=np.zeros(1), places=each, parts=(None,),
    ))  # fmt: skip


@given(st.floats(1.5, 20.0), st.integers(0, 2**31 - 1))
def test_a_curve_that_predicts_worse_than_a_law_does_not_take_its_place(times, seed):
    law, worse = model(1.0, seed), SimpleNamespace(model=model(times, seed + 1))
    assert not _does_what_they_do(worse, [None], None, law, OPTIONS)


@pytest.mark.parametrize("times", [1.0, 3.0])
def test_a_curve_that_predicts_as_well_or_better_takes_the_place_of_one_law(times):
    """The law has a neighbour's name: this is why it is asked."""
    taken = sum(
        _does_what_they_do(
            SimpleNamespace(model=model(1.0, k)), [None], None, model(times, 1000 + k), OPTIONS
        )
        for k in range(100)
    )
    assert taken >= 97  # a law that is no better is proven to be in 1 % of worlds
