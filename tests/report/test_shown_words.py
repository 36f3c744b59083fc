"""What a log would have shown: every effect once, with its place, and the hardest to see first."""

from dataclasses import replace

import numpy as np
import pytest
from fake_discovery import fit

from identification.discovery.effect_results import Detectable
from identification.effects.effect import Candidate, Effect
from identification.effects.sizes import Size
from identification.report.discovery.shown_words import shown_effects
from identification.report.fit.fitted_values import FEW as FEW_PARTS
from identification.report.fit.fitted_values import shown_values, unknown_shares
from identification.report.words.values import parameter_words
from inca_mj.robot.parameters import parameter_set
from inca_mj.robot.spread import with_spread


def effect(name, *sizes):
    made = Effect(name, "-f", sizes or (Size("f", "N", 2.0, 0.01),), places={"joint hip": "@hip"})
    return Candidate(made, "joint hip", {})


def one(name, smallest):
    return Detectable(effect(name), "f", smallest, "N")


MANY = [one(f"law_{k}", 0.01 * (k + 1)) for k in range(60)]
BLIND = [one("creep", np.inf), one("backlash", 3.0)]


def test_the_hardest_is_first_and_what_never_shows_before_it():
    seen, never = shown_effects([*MANY, *BLIND])
    names = [s.sizes[0].candidate.effect.name for s in (*never, *seen)]
    assert names == ["creep", "backlash", *(f"law_{k}" for k in reversed(range(60)))]


COMMON = ("R", "K_t", "stribeck_friction.f_s", "torque_constant_mismatch.delta@3")


def rows(names):
    return [[name, "0 %"] for name in names]


def test_the_worst_known_are_shown_and_their_number_is_told():
    parts = [f"K_t@{k}" for k in range(1, 9)] + [f"exit_x@{k}" for k in range(1, 9)]
    rng = np.random.default_rng(0)
    shares = dict(zip(parts, rng.permutation(np.linspace(0.1, 0.9, 16)).tolist(), strict=True))
    shown, said = shown_values(rows((*COMMON, *parts)), shares)
    names = [row[0] for row in shown]
    assert names[: len(COMMON)] == [*COMMON]
    left_out = {*parts} - {*names}
    assert len(left_out) == len(parts) - FEW_PARTS
    assert min(shares[n] for n in names[len(COMMON) :]) > max(shares[n] for n in left_out)
    assert "Of 16 deviations" in said
    assert "report" in said


def test_what_a_log_does_not_tell_has_the_std_that_was_known_before():
    found = fit({"b_v": 2e-4, "x": 0.0})
    space = replace(found.point.space, names=("K_t@3", "stribeck_friction.delta@3"))
    point = replace(found.point, space=space)
    priors = replace(found.priors, weight=np.array([50.0, 1.0]))
    left = unknown_shares(replace(found, point=point, std=np.array([0.02, 0.1]), priors=priors))
    assert left == {"K_t@3": pytest.approx(1.0)}


EVERY = with_spread(parameter_set())


def test_words_tell_all_parameters_of_the_robot_apart_and_none_is_a_raw_name():
    words = parameter_words(EVERY)
    assert len({*words.values()}) == len(words) > 100
    assert not [w for w in words.values() if "@" in w or w in words]
