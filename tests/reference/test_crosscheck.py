"""The cross-check agrees, and sees what it should when the models are made to disagree."""

import json
from dataclasses import replace

import numpy as np
import pytest
from reference_cases import differing

from inca_mj.reference import rest
from inca_mj.robot.geometry import INCA
from inca_mj.robot.parameters import SETS, parameter_set
from inca_mj.robot.spread import deviations, displacements, with_spread
from inca_mj.twin.twin import build_twin
from inca_mj.verification.check import STEPS, CrossCheck, crosscheck
from inca_mj.verification.derivatives import DerivativeErrors, _compare, compare_derivatives
from inca_mj.verification.trajectories import CASES, crossing, leading_slope, slope


def derivative_errors(**some):
    zero = dict.fromkeys(("linear", "angular", "motor", "no_load", "tension"), 0.0)
    return DerivativeErrors(**{**zero, **some}, states=1, slack=0.5)


GOOD = derivative_errors()


def row(case, step, error):
    return {"case": case, "step": step, "max_angle_error": error,
            "max_position_error": error and error / 50, "max_tension_error": error}  # fmt: skip


def test_accelerations_agree_at_random_states():
    found = compare_derivatives(3000, seed=1)
    assert found.largest < 1e-9
    assert 0.4 < found.slack < 0.6


@pytest.mark.parametrize("name", ["J", "m"])
def test_a_wrong_number_in_one_model_is_seen(name, monkeypatch):
    from inca_mj.verification import derivatives

    def wrong(p, geometry):
        return build_twin(p.with_values({name: p[name].value * (1 + 1e-6)}), geometry)

    def pack_right(p, geometry):
        return pack(p.with_values({name: p[name].value / (1 + 1e-6)}), geometry)

    pack = derivatives.pack
    monkeypatch.setattr(derivatives, "build_twin", wrong)
    monkeypatch.setattr(derivatives, "pack", pack_right)
    assert compare_derivatives(300).largest > 1e-9


@pytest.mark.parametrize("name", SETS)
def test_one_second_passes(name):
    said = []
    result = crosscheck(
        parameter_set(name), duration=1.0, steps=STEPS, states=200, progress=said.append
    )
    assert result.passed, result.sentences
    assert [(r["case"], r["step"]) for r in result.rows] == [
        (case, h) for case in CASES for h in STEPS
    ]
    assert len(said) == 17
    plain = json.loads(json.dumps(result.to_json(), allow_nan=False))
    assert set(plain["rows"][0]) == {
        "case", "step", "max_angle_error", "max_position_error", "max_tension_error"
    }  # fmt: skip
    assert plain["passed"] is True
    assert set(plain["orders"]) == set(CASES)


def test_a_diverged_run_is_shown_and_named():
    result = crosscheck(duration=0.5, steps=(1e-2,), cases=("prbs",), states=9)
    assert result.rows[0]["max_angle_error"] is None
    assert any("prbs at 10 ms: the simulation diverged" in s for s in result.sentences)
    assert result.order is None
    json.dumps(result.to_json(), allow_nan=False)


def test_limits_are_judged():
    h = [1e-3, 5e-4]
    rows = lambda *e: tuple(row("prbs", s, x) for s, x in zip(h, e, strict=True))  # noqa: E731
    assert CrossCheck(GOOD, rows(8e-6, 5e-7)).passed
    assert not CrossCheck(GOOD, rows(1.1e-5, 6.9e-7)).passed
    assert not CrossCheck(GOOD, rows(8e-6, 1.1e-6)).passed
    assert not CrossCheck(GOOD, rows(8e-6, None)).passed
    assert not CrossCheck(GOOD, (*rows(8e-6, 5e-7), row("spin", 1e-3, None))).passed
    assert CrossCheck(GOOD, (*rows(8e-6, 5e-7), row("spin", 2e-3, None))).passed
    bad = derivative_errors(angular=2e-9)
    assert not CrossCheck(bad, rows(8e-6, 5e-7)).passed
    lost = derivative_errors(angular=np.nan)
    assert not CrossCheck(lost, rows(8e-6, 5e-7)).passed
    assert "DISAGREE" in CrossCheck(bad, ()).sentences[0]


def test_the_order_tells_two_terms_apart():
    h = np.array([2e-3, 1e-3, 5e-4, 2.5e-4])
    assert slope(h, 1e5 * h**4) == pytest.approx(4)
    assert leading_slope(h, 1e5 * h**4) == pytest.approx(4)
    both = 1e6 * h**4 + 1e6 * (6e-4) ** 2 * h**2
    assert crossing(h, both) == pytest.approx(6e-4, rel=1e-6)
    assert slope(h, both) < 3.5 < leading_slope(h, both) < 4
    assert leading_slope(h[:2], both[:2]) is None
    assert leading_slope(h, h**2) is None
    assert slope(h, [None, None, 1.0, None]) is None


@pytest.mark.parametrize("what", ["angle", "position", "tension"])
@pytest.mark.parametrize("case", CASES)
def test_every_column_of_every_case_can_fail(case, what):
    """A position off by a millimetre, or a tension by a newton, is not lost among good angles."""
    good = [
        {"case": c, "step": h, "max_angle_error": 1e-8, "max_position_error": 1e-10,
         "max_tension_error": 1e-6} for c in CASES for h in STEPS
    ]  # fmt: skip
    assert CrossCheck(GOOD, tuple(good)).passed
    bad = [dict(r) for r in good]
    size = {"angle": 0.1, "position": 0.02, "tension": 200.0}[what]
    for r in bad:
        if r["case"] == case:
            r[f"max_{what}_error"] = size
    assert not CrossCheck(GOOD, tuple(bad)).passed


NAMES = [p.name for p in (*deviations(), *displacements())]


@pytest.mark.parametrize("seed", [1, 2])
def test_accelerations_of_drives_that_differ_agree(seed):
    p = differing(seed)
    assert all(p[name].value for name in NAMES)
    assert compare_derivatives(2000, seed, p).largest < 1e-9


def test_the_start_is_the_same():
    p = differing(3)
    theirs, ours = build_twin(p).start, rest(p, INCA)
    np.testing.assert_allclose(theirs.tension, ours.tension, rtol=1e-11)
    np.testing.assert_allclose(theirs.no_load_length, ours.no_load, rtol=1e-14)


def test_trajectories_agree_to_the_limits_of_equal_drives():
    steps = (2e-3, 1e-3, 5e-4, 2.5e-4)
    result = crosscheck(differing(4), duration=3.0, steps=steps, cases=("prbs",), states=9)
    assert result.passed, result.sentences
    # Tensions show RK4's order at all steps, angles the quaternion's second order at short ones.
    assert result.tension_orders["prbs"] == pytest.approx(4, abs=0.3)


@pytest.fixture(scope="module")
def robot():
    return build_twin(with_spread(parameter_set()))


@pytest.mark.parametrize("name", NAMES)
def test_every_deviation_moves_both_models_alike(robot, name):
    moved = robot.with_values({name: 1e-3})
    lacking = replace(moved, parameters=robot.parameters)  # what the reference is told
    alike, apart = (max(_compare(r, 30, np.random.default_rng(0))[0]) for r in (moved, lacking))
    assert alike < 1e-9
    assert apart > 1e-8  # a smoothness β shows only where a motor is slow
