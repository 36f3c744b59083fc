"""An effect that the free run does not feel is named where the innovations surely show it."""

from dataclasses import replace

import pytest
from discovery_cases import EFFECTS, disturbed, nominal_model

from identification.discovery.proof import prove
from identification.discovery.search import discover

SIZES = {"offset.f": -0.8, "rubbing.c": 1.0}
SELECTION = "identification.discovery.selection.forward_selection"


def names_where_the_second_moves_nothing(monkeypatch, times=10.0, structure=()):
    """What is named where the second effect brings the free run no nearer.

    Args:
        monkeypatch: of the test.
        times: what BIC asks, that the fitted samples must gain.
        structure: what the model with the first effect leaves unexplained.
    """

    def still(without, with_it, options):
        proof = prove(without, with_it, options)
        is_first = len(without.refit.point.q) == len(nominal_model().names)
        return proof if is_first else replace(proof, fall=-0.1, above=-0.1)

    def left(model, options):
        return structure if model.candidates else ()

    monkeypatch.setattr(f"{SELECTION}.prove", still)
    monkeypatch.setattr(f"{SELECTION}.find_structure", left)
    monkeypatch.setattr("identification.discovery.fitted_model.NEEDED_BIC_RATIO", times)
    answer = discover(nominal_model(), disturbed(**SIZES), EFFECTS)
    return {n.candidate.effect.name for n in answer.named}


@pytest.mark.parametrize(
    ("times", "structure", "count"), [(1.0, (), 2), (1e3, (), 1), (1.0, ("structure",), 1)]
)
def test_it_must_be_wanted_far_more_than_bic_asks_and_be_all_that_is_left(
    monkeypatch, times, structure, count
):
    names = names_where_the_second_moves_nothing(monkeypatch, times, structure)
    assert len(names) == count
    assert names <= {"offset", "rubbing"}
