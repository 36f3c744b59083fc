"""The force recovered from data follows the true law, whichever law was fitted."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from joint_cases import DAMPING, MASS, SLIDER, STEP, run, slider_log
from joint_cases import slider as every_slider

from identification.discovery.effect_results import Rival
from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Candidate
from identification.effects.plant.joint_plant import joint_plant
from identification.estimation.priors import Priors
from identification.innovations.recovery import recover_force
from identification.kalman.point import evaluate_point
from identification.kalman.problem import estimate_noise
from identification.kalman.refit import conclude, refit
from identification.model.coordinates import coordinates
from identification.model.predictor import Predictor

NAMES = ("coulomb_friction", "stribeck_friction", "load_dependent_friction", "hardening",
         "stiffness", "friction_drift", "encoder_scale")  # fmt: skip
BASE = {"mass": 2.1, "damping": 3.3}
COULOMB = {"coulomb_friction.f_c@slide": 1.0}
NOISE = 2e-4  # [m]
TIME = np.arange(800) * STEP
U = np.clip(
    1.2 * np.sin(2.2 * TIME) + np.sin(0.8 * TIME + 1) + 0.5 * np.sin(5.7 * TIME), -2.9, 2.9
)[:, None]


@cache
def plant():
    effects = [e for e in every_slider().effects if e.name in NAMES]
    return joint_plant(SLIDER, (MASS, DAMPING), slider_log(U), effects=effects)


def fitted(name, true, start=None, shape=None, known=(), steps=0):
    """A model with an effect at the values at which a fit of it would end, or at others."""
    y = run(plant(), slider_log(U), **{**BASE, **true})
    y = y + NOISE * np.random.default_rng(0).standard_normal(y.shape)
    log = replace(slider_log(U, y), units={"force": "V", "position": "m"})
    effect = next(e for e in plant().effects if e.name == name)
    candidate = Candidate(effect, next(iter(effect.places)), shape or {})
    begin = {**BASE, **{n: v for n, v in true.items() if n.startswith(name)}, **(start or {})}
    fixed = {n: v for n, v in true.items() if n in known}
    names = tuple(n for n in begin if n not in fixed)
    values = np.array([begin[n] for n in names])
    space = coordinates(plant().parameters, names, values, linear=candidate.sizes)
    q = space.encode(values)
    point = evaluate_point(Predictor(plant(), log, names, fixed), space, q)
    weak = Priors(space, q, np.full(len(q), 1e-3))
    if steps:
        return refit(point, weak, DiscoveryOptions(), steps=steps), candidate
    level = estimate_noise(point, weak, None)
    return conclude(point, level, weak, 0), candidate


V_S = 0.15  # [m/s]
STRIBECK = {"stribeck_friction.f_s@slide": 2.0, "stribeck_friction.v_s": V_S,
            "stribeck_friction.n": 2.0}  # fmt: skip
LAWS = {
    "stribeck_friction": (
        STRIBECK, (), "rate", False, lambda v: -np.sign(v) * 2 * np.exp(-((v / V_S) ** 2))
    ),
    "hardening": ({"hardening.k_3@slide": 8.0}, (), "position", False, lambda q: -8 * q**3),
    "load_dependent_friction": (
        {"load_dependent_friction.mu@slide": 0.1, **COULOMB}, (*COULOMB,), "drive", True,
        lambda f: 0.1 * np.abs(f),
    ),
    "friction_drift": (
        {"friction_drift.f_t@slide": 0.1, **COULOMB}, (*COULOMB,), "time", True, lambda t: 0.1 * t
    ),
    "encoder_scale": (
        {"encoder_scale.s@position": 0.03, "stiffness.k@slide": 4.0}, ("stiffness.k@slide",),
        "reading", False, lambda y: 0.03 * y,
    ),
}  # fmt: skip


SLOW = [
    pytest.param(name, marks=pytest.mark.long)
    for name in ("load_dependent_friction", "friction_drift")
]


@pytest.mark.parametrize("name", ["stribeck_friction", "hardening", "encoder_scale", *SLOW])
def test_recovered_points_and_the_band_hold_the_true_law(name):
    true, known, along, resists, law = LAWS[name]
    shape = {"v_s": V_S, "n": 2.0} if name == "stribeck_friction" else {}
    fit, candidate = fitted(name, true, shape=shape, known=known)
    of = recover_force(fit, candidate)
    assert (of.along, of.resists, of.places) == (along, resists, 1)
    assert len(of.points.x) >= 6
    off = (of.points.force - law(of.points.x)) / of.points.std
    assert np.abs(off).max() < 5
    assert np.sqrt(np.mean(off**2)) < 2
    # The line is a mean over bins, in which a curved law is off by its curvature.
    bent = 2e-3 * np.abs(of.law.force).max()
    inside = np.abs(of.law.force - law(of.law.x)) < 1.96 * of.law.std + bent
    assert inside.mean() > 0.9


def test_points_leave_a_wrong_law_for_the_true_one():
    fit, candidate = fitted(
        "stiffness", {"hardening.k_3@slide": 1.0}, {"stiffness.k@slide": 1.0}, steps=6
    )  # fmt: skip
    of = recover_force(fit, candidate)
    truth = -(of.points.x**3)
    wrong = np.interp(of.points.x, of.law.x, of.law.force) - truth
    right = of.points.force - truth
    assert np.linalg.norm(right) < 0.5 * np.linalg.norm(wrong)


def test_a_rival_is_drawn_with_all_values_of_its_own_fit():
    fit, candidate = fitted("hardening", {"hardening.k_3@slide": 8.0})
    same = Rival(candidate, 0.3, 1.0, fit.point.values)
    damped = Rival(candidate, 0.2, 1.0, {**fit.point.values, "damping": 4.0})
    unknown = Rival(candidate, 0.1, 1.0)
    of = recover_force(fit, candidate, (same, damped, unknown))
    (_, first), (_, second) = of.rivals
    np.testing.assert_allclose(first.force, of.law.force, rtol=1e-9, atol=1e-12)
    assert np.abs(second.force - of.law.force).max() > 0.1  # more damping is a force too
