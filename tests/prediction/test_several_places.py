"""An effect at several of its places, with a size for each."""

import numpy as np
import pytest

from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Candidate, Effect, Size
from identification.prediction.scores import WindowScore
from identification.prediction.several_places import at_several, felt_places

PLACES = {"all joints": "", "joint a": "@a", "joint b": "@b", "joint c": "@c"}
EFFECT = Effect("friction", "μ |f|", (Size("mu", "", 0.2, 0.002, 1),), places=PLACES)


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
