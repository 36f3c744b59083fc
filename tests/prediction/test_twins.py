"""A constant force and a Coulomb level that differs by direction are one force while small."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from records_cases import FREE, pendulum, record

from identification.discovery.candidates import list_common
from identification.effects.joint_plant import candidates
from identification.model.predictor import Predictor
from identification.prediction.twins import LEVEL, TWINS, find_twin

LEVEL_THERE = 0.1  # Coulomb friction [N m]
NAMES = (f"{LEVEL}@hinge", "offset.f_0@hinge", "asymmetric_friction.f_a@hinge")


def angles(offset: float, asymmetry: float, seed: int) -> np.ndarray:
    """Of the pendulum, which rests now and then."""
    log = record(seed, samples=200, largest=0.3)
    values = np.array([[LEVEL_THERE, offset, asymmetry]])
    return np.asarray(Predictor(pendulum(), log, NAMES).predict(values)[0])


@settings(max_examples=10, deadline=None)
@given(st.floats(-0.9, 0.9), st.integers(0, 4))
def test_they_are_one_force_while_friction_is_larger(share: float, seed: int) -> None:
    f = share * LEVEL_THERE
    np.testing.assert_allclose(angles(f, 0.0, seed), angles(0.0, -f, seed), atol=1e-9)


def test_they_differ_where_the_force_is_larger_than_friction() -> None:
    f = 1.5 * LEVEL_THERE
    assert np.abs(angles(f, 0.0, 1) - angles(0.0, -f, 1)).max() > 1e-3


@pytest.mark.parametrize("name", [*TWINS])
@pytest.mark.parametrize("share", [0.9, 1.1])
def test_a_twin_is_told_only_below_the_level(name: str, share: float) -> None:
    (effect,) = (e for e in candidates(pendulum(), FREE) if e.name == name)
    (candidate,) = (c for c in list_common([effect]) if c.where == "joint hinge")
    values = {f"{LEVEL}@hinge": LEVEL_THERE, candidate.sizes[0]: share * LEVEL_THERE}
    model = SimpleNamespace(plant=pendulum(), values=values, fit=SimpleNamespace(shared={}))
    assert find_twin(model, candidate) == (TWINS[name] if share < 1 else "")


def test_without_friction_there_is_no_twin() -> None:
    (effect,) = (e for e in candidates(pendulum(), FREE) if e.name == "offset")
    candidate = list_common([effect])[0]
    values = {candidate.sizes[0]: 0.01}
    model = SimpleNamespace(plant=pendulum(), values=values, fit=SimpleNamespace(shared={}))
    assert find_twin(model, candidate) == ""


def test_slides_of_a_robot_that_has_hinges_too_have_twins() -> None:
    effect = SimpleNamespace(name="slide_offset", places={"joint rail": "@rail"})
    candidate = SimpleNamespace(effect=effect, sizes=("slide_offset.f_0@rail",))
    values = {f"slide_{LEVEL}@rail": LEVEL_THERE, "slide_offset.f_0@rail": 0.9 * LEVEL_THERE}
    model = SimpleNamespace(plant=pendulum(), values=values)
    assert find_twin(model, candidate) == "slide_asymmetric_friction"
