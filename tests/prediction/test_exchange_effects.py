"""Each of several effects is asked in its place, beside those that were found after it."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import pytest
from records_cases import listed, nominal_model, records, roles

from identification.discovery.candidates import list_common
from identification.discovery.options import DiscoveryOptions
from identification.prediction.discovery import WINDOWS
from identification.prediction.moves import exchange_effects as move
from identification.prediction.moves.exchange_effects import exchange_effects
from identification.prediction.task import RecordsTask

NAMES = ("offset", "stiffness", "hardening")
LAWS = ("offset", "stiffness")


@cache
def begun():
    task = RecordsTask(
        nominal_model=nominal_model(), effects=listed(*NAMES),
        records=roles(records(3, {"offset.f_0@hinge": 0.06}, samples=200)),
        options=DiscoveryOptions(without=("untouched_part",)),
    )  # fmt: skip
    return WINDOWS.begin(task, lambda line: None)


def effect(name):
    (c,) = list_common(listed(name))
    return SimpleNamespace(candidate=c, name=name)


def replace_model(effect, leaves_much):
    effect.model = SimpleNamespace(leaves_much=leaves_much)
    return effect


def with_effects(monkeypatch, names=LAWS, left=False, doubtful=("stiffness",)):
    """A state with some effects, of which much is left, or some are in doubt."""
    model = SimpleNamespace(candidates=[effect(n).candidate for n in LAWS])
    monkeypatch.setattr(
        move, "is_much_left", lambda model, options: left or getattr(model, "leaves_much", False)
    )
    monkeypatch.setattr(move, "sure_and_doubtful", lambda state: ([], doubtful))
    return replace(begun(), model=model, accepted=tuple(effect(n) for n in names))


def exchanged_for(monkeypatch, state, names, proven=None, leaves_much=False):
    """The state after other effects were found in the places."""
    found = [replace_model(effect(n), leaves_much) for n in (names if proven is None else proven)]
    model = SimpleNamespace(candidates=[effect(n).candidate for n in names])
    places = {("offset", "joint hinge"): SimpleNamespace(tried=(1, 2))}
    asked = []

    def proven_members(before, model, refits, progress):
        asked.append((before, refits))
        return found

    monkeypatch.setattr(move, "each_at_its_best", lambda *given: (model, places))
    monkeypatch.setattr(move, "proven_members", proven_members)
    monkeypatch.setattr(
        move, "with_members", lambda state, found, places: replace(state, accepted=tuple(found))
    )
    return exchange_effects(state, print), asked


def test_the_better_law_takes_the_place_and_chance_pays_for_all_refits(monkeypatch):
    state = with_effects(monkeypatch)
    found, ((before, refits),) = exchanged_for(monkeypatch, state, ("offset", "hardening"))
    assert [a.name for a in found.accepted] == ["offset", "hardening"]
    assert (before.model, before.accepted, refits) == (state.nominal, (), 2)


@pytest.mark.parametrize(("names", "proven", "leaves_much"), [
    (LAWS, None, False),  # the same as before
    (("offset", "hardening"), ("offset",), False),  # unseen records do not prove all of them
    (("offset", "hardening"), None, True),  # no better than what was there
])  # fmt: skip
def test_effects_stay_where_no_others_are_proven(monkeypatch, names, proven, leaves_much):
    state = with_effects(monkeypatch)
    found, _ = exchanged_for(monkeypatch, state, names, proven, leaves_much)
    assert found.accepted is state.accepted
    assert found.model is state.model


@pytest.mark.parametrize(("names", "left", "doubtful", "is_asked"), [
    (LAWS, False, (), False),  # nothing speaks against them
    (LAWS, False, ("stiffness",), True),
    (LAWS, True, (), True),
    (("offset",), True, (), False),  # it competed with all others when it was found
    (("offset", "curve_position"), True, (), False),
])  # fmt: skip
def test_effects_are_asked_where_one_is_in_doubt_or_much_is_left(
    monkeypatch, names, left, doubtful, is_asked
):
    state = with_effects(monkeypatch, names, left, doubtful)
    asked = []

    def at_its_best(*given):
        asked.append(given)
        return state.model, {}

    monkeypatch.setattr(move, "each_at_its_best", at_its_best)
    assert exchange_effects(state, print).accepted is state.accepted
    assert bool(asked) == is_asked
