"""Prefixes, and as many digits as are known."""

import re
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from identification.estimation.scaling_symmetry import ScalingSymmetry
from identification.quantities import HELD, alike, held, matched, quantity
from identification.report.fit.untold_words import untold

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
        (0.0083, 0.0002, "kg m^2", "0.00830 ± 0.00020 kg m^2"),
        (8.3e-5, NAN, "kg m²", "0.830 kg cm²"),
        (2.41e-5, 1e-7, "kg m^2", "0.2410 ± 0.0010 kg cm^2"),
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


@given(st.floats(1e-9, 1e9), STDS, UNITS)
def test_a_negative_number_is_said_as_the_positive_one_behind_a_minus_sign(value, std, unit):
    said, of = quantity(-value, std, unit), quantity(value, std, unit)
    assert said in (f"-{of}", of)
    assert (said == of) == (float(said.split(" ")[0]) == 0)


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


NAMES = ("m", "b", "k")
ALONE = ScalingSymmetry({"b": Fraction(1)})
PAIR = ScalingSymmetry({"m": Fraction(1), "k": Fraction(-2)})
WORDS = {"b": "damping b, elbow"}


@pytest.mark.parametrize(
    ("symmetries", "said"),
    [
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
