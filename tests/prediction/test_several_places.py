"""An effect at several of its places, with a size for each."""

import numpy as np
import pytest

from identification.effects.effect import Candidate, Effect, Size
from identification.prediction.scores import WindowScore
from identification.prediction.several_places import at_several, list_several

PLACES = {"all joints": "", "joint a": "@a", "joint b": "@b", "joint c": "@c"}
EFFECT = Effect("friction", "μ |f|", (Size("mu", "", 0.2, 0.002, 1),), places=PLACES)


def score(where, fall):
    return WindowScore(
        candidate=Candidate(EFFECT, where, {}), size=np.array([0.05]), std=np.array([0.01]),
        fall=fall, p_value=1e-6,
    )  # fmt: skip


def test_its_parameters_are_those_of_the_single_places():
    several = at_several(EFFECT, ["joint a", "joint c"])
    (where,) = several.places
    assert where == "joint a and joint c"
    assert Candidate(several, where, {}).sizes == ("friction.mu@a", "friction.mu@c")
    singles = [Candidate(EFFECT, f"joint {x}", {}).sizes[0] for x in "ac"]
    assert [*Candidate(several, where, {}).sizes] == singles


def test_places_beyond_chance_are_taken_together_in_their_order():
    found = list_several([score("joint c", 0.2), score("all joints", 0.15), score("joint a", 0.1)])
    assert [c.where for c in found] == ["joint a and joint c"]


@pytest.mark.parametrize("where", [["joint b"], ["all joints"], ["all joints", "joint b"], []])
def test_one_place_is_no_new_candidate(where):
    assert list_several([score(w, 0.1) for w in where]) == []
