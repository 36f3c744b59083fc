"""A search whose steps are kept answers as one that makes all of them."""

from dataclasses import dataclass, replace
from functools import partial

import kept_steps
import numpy as np
import pytest
from records_cases import nominal_model, records

from identification.discovery.options import DiscoveryOptions
from identification.effects.plant.joint_plant import candidates
from identification.prediction.discovery import discover_records

FORCE = {"coulomb_friction.f_c@hinge": 0.08}
CHOICES = (
    DiscoveryOptions(),
    DiscoveryOptions(without=("own_weights",)),
    DiscoveryOptions(without=("drop_places",)),  # an effect at one place has none to drop
)


@pytest.fixture(autouse=True)
def one_thread(monkeypatch):
    monkeypatch.setenv("INCA_MJ_THREADS", "1")


def search(options):
    model = nominal_model()
    effects = [e for e in candidates(model.plant, model.names) if e.name == "coulomb_friction"]
    logs = records(values=FORCE, samples=120)
    return discover_records(model, logs[:2], logs[2:], effects, options=options)


def answer(found):
    return found.verdict, [n.name for n in found.named], found.final.values, found.after.rms


def test_searches_with_kept_steps_answer_as_searches_from_nothing():
    plain = [answer(search(options)) for options in CHOICES[:2]]
    assert plain[0][:2] == ("named", ["coulomb_friction"])
    made = []
    with kept_steps.kept_steps():
        for options, expected in zip(CHOICES, (*plain, plain[0]), strict=True):
            before = kept_steps.COUNTS["made"]
            assert answer(search(kept_steps.asked(options))) == expected
            made.append(kept_steps.COUNTS["made"] - before)
    assert made[0] > made[1] > 0  # fits change with the weights of outputs
    assert made[2] == 0


@dataclass(frozen=True)
class Case:
    name: str
    values: np.ndarray
    law: object = None


def shifted(by):
    return lambda x: x + by


def test_arguments_are_the_same_where_their_fields_are():
    case = Case("a", np.arange(3.0))
    mark = kept_steps._mark
    try:
        assert mark(case) == mark(Case("a", np.arange(3.0)))
        assert mark({"x": (case, [1.0])}) == mark({"x": (Case("a", np.arange(3.0)), [1.0])})
        for other in (
            replace(case, name="b"), replace(case, values=np.arange(3)),
            replace(case, values=np.arange(3.0)[:, None]), replace(case, law=shifted(1)),
        ):  # fmt: skip
            assert mark(case) != mark(other)
        assert mark(shifted(1)) == mark(shifted(1)) != mark(shifted(2))
        assert mark(partial(max, 1)) != mark(partial(max, 2))
        assert mark(object()) != mark(object())
    finally:
        kept_steps._MARKS.clear()
