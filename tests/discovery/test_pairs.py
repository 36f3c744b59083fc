"""Two effects of which neither is proven without the other are found together, or not at all."""

from dataclasses import replace

import pytest
from discovery_cases import EFFECTS, OPTIONS, disturbed, nominal_model

from identification.innovations.discovery import discover
from identification.innovations.fitted_model import is_confirmed
from identification.innovations.moves.forward_selection import Selection, select_effect
from identification.innovations.moves.pairs import find_pair
from identification.innovations.proof import prove

OFFSET, RUBBING = {"offset.f": -0.8}, {"rubbing.c": 1.0}


@pytest.mark.parametrize("sizes", [{**OFFSET, **RUBBING}, OFFSET], ids="+".join)
def test_a_search_goes_on_from_what_is_not_proven_alone(monkeypatch, sizes):
    """Each of two effects is proven beside the other; one effect gets no companion."""
    pairs = []

    def doubtful(asked, model, *rest):
        selection = select_effect(asked, model, *rest)
        if model.candidates:
            return selection
        return Selection(unproven=selection.accepted[0].model)  # nothing is proven alone

    def spy(*arguments):
        pairs.append(find_pair(*arguments))
        return pairs[-1]

    monkeypatch.setattr("identification.innovations.state.select_effect", doubtful)
    monkeypatch.setattr("identification.innovations.state.find_pair", spy)
    answer = discover(nominal_model(), disturbed(**sizes), EFFECTS)
    hidden = {name.partition(".")[0] for name in sizes} if len(sizes) == 2 else set()
    assert {n.candidate.effect.name for n in answer.named} == hidden
    (pair,) = pairs
    assert {a.candidate.effect.name for a in pair} == hidden
    assert all(is_confirmed(a.proof, OPTIONS) for a in pair)
    assert not pair or len(pair[-1].model.candidates) == 2


@pytest.mark.parametrize(("fall", "hidden"), [(0.9, {"offset", "rubbing"}), (0.0, set())])
def test_what_the_fitted_samples_want_and_the_free_run_confirms_begins_a_pair(
    monkeypatch, fall, hidden
):
    """As where a second effect makes the one-step errors of the unseen samples larger."""

    def astray(without, with_it, options):
        proof = prove(without, with_it, options)
        if len(without.refit.point.q) > len(nominal_model().names):
            return proof
        return replace(proof, gain=-100.0, t=-1.6, chance=0.94, fall=fall, above=fall)

    monkeypatch.setattr("identification.innovations.moves.forward_selection.prove", astray)
    # The log is short.
    monkeypatch.setattr("identification.innovations.fitted_model.NEEDED_BIC_RATIO", 1.0)
    answer = discover(nominal_model(), disturbed(**OFFSET, **RUBBING), EFFECTS)
    assert {n.candidate.effect.name for n in answer.named} == hidden
    assert hidden or answer.verdict == "unknown effect"
