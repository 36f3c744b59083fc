"""Units of parameters: their dimension, and that numbers in another unit than SI are refused."""

import pytest

from identification import Parameter
from identification.logs.units import UNITS, dimension, refuse_not_si, refuse_other_unit

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


@pytest.mark.parametrize("word", UNITS)
def test_the_units_of_logs_are_those_of_parameters(word):
    si, factor = UNITS[word]
    assert dimension(word).factor == pytest.approx(factor, rel=1e-12)
    assert dimension(word).powers == dimension(si).powers


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


def test_another_dimension_is_told_with_the_right_unit(refusal):
    assert "its numbers are in 'kg'" in refusal(refuse_other_unit, "N", "kg", "mass")
    assert "its numbers are in 'kg'" in refusal(refuse_other_unit, "apples", "kg", "mass")
    assert "in no unit" in refusal(refuse_other_unit, "m", "", "share")
