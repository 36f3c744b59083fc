"""Prefixes, and as many digits as are known."""

import re
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import identification
import inca_mj
from identification.estimation.scaling_symmetry import ScalingSymmetry
from identification.quantities import HELD, alike, held, matched, per, quantity
from identification.report.error_words import pair_words
from identification.report.untold_words import untold

NAN, INF = float("nan"), float("inf")
VALUES = st.floats(-1e9, 1e9) | st.floats(-1e-3, 1e-3) | st.just(-0.0)
STDS = st.floats(1e-20, 1e9) | st.floats(1e-20, 1e-2) | st.sampled_from((0.0, NAN, INF))
UNITS = st.sampled_from(("", "m", "rad", "kg", "N m", "m²", "1/s"))
MINUS_ZERO = re.compile(r"-0(?:\.0*)?(?:e[-+]?\d+)?(?![\d.])")


@pytest.mark.parametrize(
    ("value", "std", "unit", "said"),
    [
        (0.0041234, 0.00021, "N m", "4.12 ± 0.21 mN m"),
        (0.00035, NAN, "s", "350 µs"),
        (0.1725, 0.004, "kg", "172 ± 4 g"),
        (0.03, 0.004, "", "3.0 ± 0.4 %"),
        (6.0, 0.0, "", "6"),
        (0.5, INF, "A", "0.500 A"),
        (-0.0012, 0.0003, "m", "-1.20 ± 0.30 mm"),
        (INF, NAN, "m", "unknown"),
        (2e-4, 1e-5, "m²", "0.000200 ± 0.000010 m²"),
        (2.38e-6, NAN, "1/s", "2.38e-06 1/s"),
    ],
)
def test_quantities(value, std, unit, said):
    assert quantity(value, std, unit) == said


def test_one_prefix_for_all():
    assert alike([0.0805, 0.000499], "rad") == ["80.5 mrad", "0.499 mrad"]
    assert alike([0.131, 0.000676], "rad") == ["131 mrad", "0.676 mrad"]
    assert alike([0.131, 0.0676], "rad") == ["0.131 rad", "0.0676 rad"]
    assert alike([0.131, 0.000676], "m²") == ["0.131 m²", "6.76e-04 m²"]
    assert alike([0.02, float("nan")], "") == ["0.0200", "unknown"]
    assert alike([], "rad") == []


def test_an_error_of_a_model_has_two_digits():
    assert alike([0.03214, 0.03138], "rad", HELD) == ["32 mrad", "31 mrad"]
    assert alike([0.1314, 0.00067], "rad", HELD) == ["130 mrad", "0.67 mrad"]
    assert [held(x) for x in (21.46, 0.987, 1.34, 131.0, float("inf"))] == [
        "21", "0.99", "1.3", "130", "unknown",
    ]  # fmt: skip


@given(VALUES, STDS, UNITS)
def test_what_rounds_to_zero_has_no_minus_sign(value, std, unit):
    said = [
        quantity(value, std, unit),
        *(matched(value, std, sign)[0] for sign in ("", "+")),
        *alike([value, std], unit),
        *alike([value], unit, HELD),
        held(value),
    ]
    assert not [text for text in said if MINUS_ZERO.search(text)]


def test_a_column_of_a_table_has_plain_decimals_and_four_digits_without_a_std():
    assert matched(2.98818, float("inf")) == ("2.988", "unknown")
    assert matched(0.02300003, 3e-8) == ("0.023000030", "3.0e-08")
    assert matched(2.3e-7, 3e-8)[0] == "2.30e-07"


@given(st.floats(1e-9, 1e9), STDS, UNITS)
def test_a_negative_number_is_said_as_the_positive_one_behind_a_minus_sign(value, std, unit):
    said, of = quantity(-value, std, unit), quantity(value, std, unit)
    assert said in (f"-{of}", of)
    assert (said == of) == (float(said.split(" ")[0]) == 0)


def test_every_number_that_is_written_with_its_sign_says_zero_without_minus():
    """`+` writes the sign of what may be negative; the `z` behind it takes it from minus zero."""
    for package in (identification, inca_mj):
        for file in Path(package.__file__).parent.rglob("*.py"):
            assert not re.findall(r"\{[^{}]*:\+(?!z)[^{}]*\}", file.read_text()), file


def test_values_that_stand_side_by_side_have_one_prefix():
    assert quantity(1.02e-3, 4e-5, "N m", like=1.02e-3) == "1.02 ± 0.04 mN m"
    assert quantity(9.5e-4, 4e-5, "N m", like=1.02e-3) == "0.95 ± 0.04 mN m"
    assert quantity(9.5e-4, 4e-5, "N m") == "950 ± 40 µN m"
    assert quantity(0.98, 0.02, like=1.02) == "0.980 ± 0.020"
    assert quantity(0.0, 0.0, "rad", like=0.0) == "0 rad"


@pytest.mark.parametrize(
    ("value", "std", "unit", "said"),
    [
        (2e-11, 5e-10, "m/(N)", "0.02 ± 0.50 nm/N"),
        (2e-11, 5e-7, "rad/(N m)", "0 ± 500 nrad/(N m)"),
        (0.04, 0.15, "N", "0.04 ± 0.15 N"),
    ],
)
def test_a_value_about_zero_has_the_prefix_and_the_digits_of_its_std(value, std, unit, said):
    assert quantity(value, std, unit) == said
    assert quantity(value, std, unit, like=abs(value)) == said


@given(st.floats(1e-12, 1e6), st.floats(1e-12, 1e6), UNITS)
def test_the_prefix_is_that_of_the_larger_of_value_and_std(value, std, unit):
    said = quantity(value, std, unit).split(" ")
    assert said[3:] == quantity(max(value, std), std, unit).split(" ")[3:]


def test_brackets_stand_only_around_products():
    assert per("m", "N") == "m/N"
    assert per("rad", "N m") == "rad/(N m)"
    assert (per("1", "N", 2), per("1", "N m", 2)) == ("1/N^2", "1/(N m)^2")
    assert alike([2e-9, 1e-9], "m/(N)") == ["2 nm/N", "1 nm/N"]
    assert quantity(0.5, 0.1, "(N m)/(rad)") == "0.50 ± 0.10 (N m)/rad"


@pytest.mark.parametrize(
    ("pairs", "told"),
    [
        ([({"rad": 3.5e-3}, {"rad": 1.1e-3}), ({"rad": 4e-4}, {"rad": 2e-5})],
         [("3.5 mrad", "1.1 mrad"), ("0.40 mrad", "0.020 mrad")]),
        ([({"": 1.2}, {"": 0.4})], [("1.2", "0.40")]),
        ([], []),
    ],
)  # fmt: skip
def test_one_unit_serves_all_rows(pairs, told):
    assert pair_words(pairs, "") == told


def test_each_unit_of_outputs_has_its_own():
    one, other = {"rad": 2e-3, "m": 5e-2}, {"rad": 1e-4, "m": 1e-3}
    ((a, b), (c, d)) = pair_words([(one, other), (other, one)])
    assert (a, b) == (d, c)
    assert a == "2 mrad rms (angles) and 50 mm rms (slides)"
    assert b == "0.10 mrad rms (angles) and 1 mm rms (slides)"


NAMES = ("m", "b", "k")
ALONE = ScalingSymmetry({"b": Fraction(1)})
PAIR = ScalingSymmetry({"m": Fraction(1), "k": Fraction(-2)})
WORDS = {"b": "damping b, elbow"}


@pytest.mark.parametrize(
    ("symmetries", "said"),
    [
        ([ALONE], "the data do not tell damping b, elbow"),
        ([PAIR], "m and k trade off along (k -0.89, m +0.45), and no output changes"),
        (
            [PAIR, ALONE],
            "the data do not tell damping b, elbow; m and k trade off along (k -0.89, m +0.45)"
            ", and no output changes",
        ),
        (
            [ALONE, ScalingSymmetry({"k": Fraction(1)})],
            "the data do not tell damping b, elbow and k",
        ),
    ],
)
def test_what_no_output_feels(symmetries, said):
    assert untold(symmetries, NAMES, WORDS) == said
    moved = {name for s in symmetries for name in s.powers}
    assert np.all([WORDS.get(name, name) in said for name in moved])
