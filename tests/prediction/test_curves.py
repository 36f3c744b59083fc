"""Curves drawn from the data: a listed law wins over them, and alone they are no name of a law."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from records_cases import nominal_model, records, roles, search, with_law

from identification.discovery.effect_results import Rival
from identification.prediction.fits.nominal_fit import fit_nominal
from identification.prediction.verdict.recovery import recover_over_horizon

CURVES = ("curve_speed", "curve_load", "curve_position")


def found(values, names, samples=260):
    return search(records(4, values, samples=samples), names)


@pytest.mark.long
def test_a_law_that_is_listed_wins_over_curves():
    answer = found({"hardening.k_3@hinge": 0.06}, ("hardening", "curve_position"))
    assert answer.verdict == "named"
    assert [n.candidate.effect.name for n in answer.named] == ["hardening"]


@pytest.mark.long
def test_a_law_that_is_not_listed_is_drawn_as_a_curve_of_what_it_depends_on():
    answer = found({"hardening.k_3@hinge": 0.06}, CURVES[1:], samples=500)
    assert answer.verdict == "unlisted effect"
    (named,) = answer.named
    assert named.candidate.effect.name == "curve_position"
    assert answer.share > 0.7


def test_records_without_an_effect_get_no_curve():
    answer = found(None, CURVES[:2])
    assert answer.verdict == "nothing missing"


TRUE = {
    "quadratic_friction": ({"quadratic_friction.c@hinge": 0.02}, "rate",
                           lambda v: -0.02 * v * np.abs(v)),
    "hardening": ({"hardening.k_3@hinge": 0.3}, "position", lambda q: -0.3 * q**3),
    "hardening.k_3": ({"hardening.k_3@hinge": 0.03}, "position", lambda q: -0.03 * q**3),
    "encoder_scale": ({"encoder_scale.s@angle": 0.05, "stiffness.k@hinge": 0.5}, "reading",
                      lambda y: 0.05 * y),
}  # fmt: skip


@cache
def fitted(true, name):
    """A model with an effect, fitted to records of a pendulum that has perhaps another."""
    values = TRUE[true][0]
    samples = 500 if true == "hardening.k_3" else 300  # a little of it shows in more of them
    logs = roles(records(4, values, samples=samples))
    base = nominal_model()
    known = {n: v for n, v in values.items() if not n.startswith(true)}
    parent = fit_nominal(replace(base, plant=base.plant.with_values(known)), logs)
    model = with_law(parent, name, logs)
    return model, model.candidates[-1]


@pytest.mark.parametrize("name", ["hardening", "encoder_scale"])
def test_recovered_points_and_the_band_hold_the_true_law(name):
    model, candidate = fitted(name, name)
    of = recover_over_horizon(model, candidate)
    _, along, law = TRUE[name]
    assert (of.along, of.places) == (along, 1)
    assert len(of.points.x) >= 5
    # Base parameters are those of the fit, and a force takes over by how much these are wrong.
    close = 0.08 * np.abs(of.law.force).max()
    assert np.abs(of.points.force - law(of.points.x)).max() < close
    assert np.abs(of.law.force - law(of.law.x)).max() < close
    off = of.points.force - np.interp(of.points.x, of.law.x, of.law.force)
    inner = slice(1, -1)  # the ends of a line are means over bins
    assert np.median(np.abs(off / of.points.std)[inner]) < 3


def test_points_leave_a_wrong_law_for_the_true_one():
    model, candidate = fitted("hardening.k_3", "stiffness")
    of = recover_over_horizon(model, candidate)
    truth = TRUE["hardening.k_3"][2](of.points.x)
    wrong = np.interp(of.points.x, of.law.x, of.law.force) - truth
    assert np.linalg.norm(of.points.force - truth) < 0.5 * np.linalg.norm(wrong)


def test_a_rival_is_drawn_with_the_sizes_of_its_own_fit():
    model, candidate = fitted("hardening", "hardening")
    of = Rival(candidate, 0.1, values={"hardening.k_3@hinge": 0.6})
    found = recover_over_horizon(model, candidate, [of])
    ((rival, line),) = found.rivals
    assert rival is candidate
    size = model.values["hardening.k_3@hinge"]
    np.testing.assert_allclose(line.force, found.law.force * 0.6 / size, rtol=1e-6, atol=1e-9)
