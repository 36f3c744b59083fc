"""Fewer samples of the same experiment: the inputs keep their work."""

import numpy as np
import pytest
from plain_logs import plain_log

from identification import InputError, Parameter
from identification.logs.stamps.decimation import decimate
from identification.logs.units import dimension, refuse_not_si, refuse_other_unit

T = 0.001
U = np.sin(np.arange(1001) * 0.01)[:, None] * [1.0, 2.0]
LOG = plain_log(U, np.cumsum(U, axis=0), "a b", "x y", T)


def test_outputs_are_every_nth_and_means_are_kept():
    few = decimate(LOG, 10, "zoh")
    assert len(few) == 101
    assert few.sampling_time == pytest.approx(0.01)
    np.testing.assert_array_equal(few.outputs, LOG.outputs[::10])
    np.testing.assert_allclose(few.inputs[:-1], U[:-1].reshape(100, 10, 2).mean(axis=1))


def test_what_makes_no_log_is_refused():
    for every in (0, 600):
        with pytest.raises(InputError, match="makes no log"):
            decimate(LOG, every)


def lines_of(u, every=7, hold="foh"):
    n = len(u)
    log = plain_log(u[:, None], np.arange(n)[:, None], "u", "y", T, hold="foh")
    return decimate(log, every, hold)


def test_straight_lines_between_samples_stay_what_they_are():
    t = np.arange(106) * T
    few = lines_of(3 - 40 * t)
    assert few.hold == "foh"
    np.testing.assert_allclose(few.inputs[:, 0], 3 - 40 * few.time, atol=1e-12)
    corners = np.interp(t, t[::7], np.random.default_rng(1).standard_normal(16))
    np.testing.assert_allclose(lines_of(corners).inputs[:, 0], corners[::7], atol=1e-12)
    np.testing.assert_array_equal(few.outputs[:, 0], np.arange(0, 106, 7))


@pytest.mark.parametrize("every", [2, 5])
def test_lines_that_are_thinned_do_the_same_work_at_the_same_time(every):
    rng = np.random.default_rng(every)
    u = np.where((np.arange(401) > 150) & (np.arange(401) < 260), rng.standard_normal(401), 0)
    few = lines_of(u, every)
    fine = np.linspace(0, 400 * T, 400 * 60 + 1)
    was = np.interp(fine, np.arange(401) * T, u)
    found = np.interp(fine, few.time, few.inputs[:, 0])
    for moment in (np.ones_like(fine), fine, np.interp(fine, few.time, np.eye(len(few))[40])):
        assert np.trapezoid((found - was) * moment, fine) == pytest.approx(0, abs=2e-6)
    held = lines_of(u, every, "zoh").inputs[:-1, 0]
    assert held.sum() * every * T == pytest.approx(np.trapezoid(u, dx=T), rel=1e-12)


SAME = [
    ("N m s/rad", "N m s"), ("N s/m", "kg/s"), ("kg m^2", "kg m²"), ("N m/A", "V s"),
    ("1/(N m)^2", "1/(N m N m)"), ("J/s", "W"), ("N·m", "Nm"), ("Wb", "N m/A"), ("V/A", "Ω"),
    ("m/s^2", "m s^-2"), ("m/s^2", "m s⁻²"), ("F", "A s/V"), ("H", "V s/A"), ("T", "N/(A m)"),
]  # fmt: skip
FACTORS = {
    "g": 1e-3, "g cm^2": 1e-7, "kg mm²": 1e-6, "mN m": 1e-3, "N/mm": 1e3, "deg": 0.01745329252,
    "1/(mN m)^2": 1e6, "kN s/m": 1e3, "ms": 1e-3, "µm": 1e-6, "N m/mA": 1e3,
    "lbf in": 0.112984829,
}  # fmt: skip


@pytest.mark.parametrize(("one", "other"), SAME)
def test_two_words_for_one_unit(one, other):
    assert dimension(one) == dimension(other)
    assert dimension(one).is_si
    refuse_other_unit(one, other, "x")


@pytest.mark.parametrize(("unit", "factor"), FACTORS.items())
def test_the_factor_to_si(unit, factor):
    assert dimension(unit).factor == pytest.approx(factor, rel=1e-8)


@pytest.mark.parametrize(
    "unit", ["N m/count", "N s^n/m^n", "(", "m^", "/", "kg)", "^2", "m^m", "§"]
)
def test_what_is_not_known_has_no_dimension_and_may_be_a_label(unit):
    assert dimension(unit) in (None, dimension(""))
    refuse_not_si(unit, "x")


@pytest.mark.parametrize("unit", [*FACTORS])
def test_a_parameter_is_in_si(refusal, unit):
    said = refusal(Parameter, name="m", value=1.0, unit=unit, where="body/cart.mass")
    assert f"parameter 'm' has the unit '{unit}'" in said
    assert f"multiply its numbers by {dimension(unit).factor:.9g}" in said
