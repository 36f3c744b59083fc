"""Effects that hide each other: none is proven alone, and all are named together."""

from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from records_cases import listed, nominal_model, records, roles, search, with_law

from identification.discovery.candidates import list_common
from identification.discovery.options import DiscoveryOptions
from identification.prediction.discovery import WINDOWS
from identification.prediction.fits.nominal_fit import fit_nominal
from identification.prediction.moves import add_set
from identification.prediction.scoring.scores import condensed
from identification.prediction.task import RecordsTask

NAMES = ("quadratic_friction", "hardening", "gravity_force", "offset", "stiffness", "encoder_scale")
HIDDEN = {
    "hardening.k_3@hinge": 0.1, "gravity_force.alpha@hinge": 0.3, "quadratic_friction.c@hinge": 0.02
}  # fmt: skip


@cache
def found(*without):
    said = []
    logs = records(4, HIDDEN, samples=400)
    return search(logs, NAMES, progress=said.append, without=without), said


def test_three_effects_are_named_together_with_their_sizes():
    discovery, said = found()
    sizes = {n.candidate.effect.name: n.parameters for n in discovery.named}
    assert {*sizes} == {name.partition(".")[0] for name in HIDDEN}, said
    for name, true in HIDDEN.items():
        ((value, std, _),) = sizes[name.partition(".")[0]].values()
        assert value == pytest.approx(true, abs=max(4 * std, 0.1 * true))
    assert discovery.moves[0] == "add_set"
    assert all(n.proof.fall > 0 for n in discovery.named)


def test_without_sets_they_are_not():
    discovery, _ = found("add_set")
    assert {n.name for n in discovery.named} != {name.partition(".")[0] for name in HIDDEN}


def test_members_compete_for_their_places_as_if_they_were_not_there():
    """Held sizes make no room: a member's column is what it was, and the residual with it too."""
    logs = records(3, {"offset.f_0@hinge": 0.06}, samples=200)
    every = roles(logs)
    with_it = with_law(fit_nominal(nominal_model(), every), "offset", every)
    (offset,) = list_common(listed("offset"))
    size = offset.sizes[0]
    known = condensed(with_it.fit, [offset], held={size})
    G, a, hidden = known.G, known.a, condensed(with_it.fit, [offset]).G
    assert hidden.sum() < 1e-6 * G.sum()
    again = a.sum() + G.sum() * with_it.values[size]  # Sᵀ(r + S η)
    assert again / G.sum() == pytest.approx(with_it.values[size], rel=0.02)
    assert np.abs(a.sum()) < 0.02 * again


def test_members_of_a_set_with_which_unseen_records_are_predicted_no_better_are_not_asked(
    monkeypatch,
):
    logs = records(3, {"offset.f_0@hinge": 0.06}, samples=200)
    task = RecordsTask(
        nominal_model=nominal_model(), records=roles(logs), effects=listed(*NAMES),
        options=DiscoveryOptions(without=("untouched_part",)),
    )  # fmt: skip
    state = WINDOWS.begin(task, lambda line: None)
    monkeypatch.setattr(add_set, "is_much_left", lambda model, options: True)
    monkeypatch.setattr(add_set, "_with_set", lambda state, *given, **more: state.model)
    monkeypatch.setattr(add_set, "each_at_its_best", None)
    assert add_set.add_set(state, lambda line: None).accepted == ()


@pytest.mark.parametrize("is_worse", [True, False])
def test_a_set_that_predicts_worse_is_asked_without_the_members_that_spoil_it(
    monkeypatch, is_worse
):
    chosen, less = (SimpleNamespace(candidates=()) for _ in range(2))
    state = SimpleNamespace(
        task=SimpleNamespace(options=DiscoveryOptions()), model=None, room=3, scores=[1],
        seconds={},
    )  # fmt: skip
    asked = []

    def at_its_best(state, model, progress):
        asked.append(model)
        raise LookupError

    monkeypatch.setattr(add_set, "is_much_left", lambda model, options: True)
    monkeypatch.setattr(add_set, "_with_set", lambda *given: chosen)
    monkeypatch.setattr(add_set, "_is_worse", lambda *given: is_worse)
    monkeypatch.setattr(add_set, "proven_members", lambda *given: [SimpleNamespace(model=less)])
    monkeypatch.setattr(add_set, "each_at_its_best", at_its_best)
    with pytest.raises(LookupError):
        add_set.add_set(state, print)
    assert asked[0] is (less if is_worse else chosen)


@pytest.mark.parametrize(
    ("without", "names"), [((), {"offset"}), (("plain_sets",), {"offset", "presliding"})]
)
def test_sets_are_chosen_among_laws_without_states(monkeypatch, without, names):
    asked = []

    def choose(model, members, scores, options, room):
        asked.append({s.candidate.effect.name for s in scores})
        return ()

    monkeypatch.setattr(add_set, "find_members", lambda model, parent: [])
    monkeypatch.setattr(add_set, "choose", choose)
    state = SimpleNamespace(
        task=SimpleNamespace(options=DiscoveryOptions(without=without)), model=None, room=3,
        scores=[SimpleNamespace(candidate=c) for c in list_common(listed("offset", "presliding"))],
    )  # fmt: skip
    add_set._with_set(state, None, print)
    assert asked == [names]
