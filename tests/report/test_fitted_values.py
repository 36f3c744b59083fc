"""Of many deviations a terminal shows the worst known; common values and effects always."""

from dataclasses import replace

import numpy as np
import pytest
from fake_discovery import fit

from identification.report.fitted_values import FEW, MANY, shown_values, unknown_shares

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
    assert len(left_out) == len(parts) - FEW
    assert min(shares[n] for n in names[len(COMMON) :]) > max(shares[n] for n in left_out)
    assert "Of 16 deviations" in said
    assert "report" in said


@pytest.mark.parametrize("count", [0, MANY])
def test_few_are_all_shown(count):
    parts = [f"K_t@{k}" for k in range(count)]
    every = rows((*COMMON, *parts))
    assert shown_values(every, dict.fromkeys(parts, 0.5)) == (every, "")


def test_what_a_log_does_not_tell_has_the_std_that_was_known_before():
    found = fit({"b_v": 2e-4, "x": 0.0})
    space = replace(found.point.space, names=("K_t@3", "stribeck_friction.delta@3"))
    point = replace(found.point, space=space)
    priors = replace(found.priors, weight=np.array([50.0, 1.0]))
    left = unknown_shares(replace(found, point=point, std=np.array([0.02, 0.1]), priors=priors))
    assert left == {"K_t@3": pytest.approx(1.0)}
