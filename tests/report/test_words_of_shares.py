"""Shares and ratios in words: no power of ten, and neither all nor nothing by rounding."""

import re
from types import SimpleNamespace

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from identification.quantities import quantity
from identification.report.discovery.shown_words import sized
from identification.report.words.effects import number
from identification.shares import change, decimal, fall_words, percent, ratio_of, times, times_noise

EXPONENT = re.compile(r"\de[-+]?\d")
SHARES = st.floats(-1e6, 1e6) | st.floats(-1.0, 1.0) | st.floats(1e-12, 1e-2)
PARTS = st.floats(0.0, 1.0) | st.floats(0.98, 1.0) | st.floats(0.0, 0.02)
DIGITS = st.sampled_from((0, 2, 3))


@given(SHARES, DIGITS)
def test_no_power_of_ten_is_in_a_share_or_a_ratio(share, digits):
    said = [
        percent(share, digits), ratio_of(abs(share), "their rms"), times(abs(share)),
        change(max(share, -1.0)), fall_words(min(share, 1.0), digits), sized(share, ""),
    ]  # fmt: skip
    assert not [words for words in said if EXPONENT.search(words)]


@given(
    st.floats(-1e3, 1e3) | st.floats(-1.0, 1.0) | st.floats(-1e-4, 1e-4),
    st.floats(1e-25, 1e3) | st.floats(1e-12, 1e-2) | st.sampled_from((0.0, float("nan"))),
    st.sampled_from((0.0, 0.3, 2.0)),
)
def test_no_power_of_ten_is_in_a_percentage(value, std, like):
    said = quantity(value, std, "", like)
    assert not ("%" in said and EXPONENT.search(said)), said


@given(PARTS, DIGITS)
def test_all_and_nothing_are_said_only_where_they_are(part, digits):
    said = percent(part, digits)
    assert (said == "100 %") == (part == 1.0)
    assert (said == "0 %") == (part == 0.0)


@given(PARTS, DIGITS)
def test_what_is_said_of_a_part_is_true(part, digits):
    said = re.fullmatch(r"(less than |more than |)([\d.]+) %", percent(part, digits))
    bound, number = said.groups()
    value, tolerance = float(number), {0: 0.5, 2: 0.05 * 100 * part, 3: 0.005 * 100 * part}[digits]
    assert 100 * part < value if bound == "less than " else True
    assert 100 * part > value if bound == "more than " else True
    assert bound or abs(100 * part - value) <= tolerance * (1 + 1e-9)


@given(PARTS)
def test_a_change_that_leaves_something_is_not_one_of_everything(part):
    assume(part < 1.0)
    assert "100 %" not in change(-part)
    assert "100 %" not in fall_words(part)


@given(st.floats(1e-9, 1e9), st.integers(1, 6))
def test_a_decimal_is_the_number_with_its_digits(value, digits):
    assert float(decimal(value, digits)) == pytest.approx(value, rel=0.51 * 10.0 ** (1 - digits))


@given(st.floats(0.5, 2.0))
def test_noise_is_not_once_itself(ratio):
    said = times_noise(ratio)
    assert not re.match(r"1(\.0)? times", said)
    assert (said == "as small as the noise") == (0.95 <= ratio < 1.05)


def test_a_power_is_not_told_in_percent():
    effect = SimpleNamespace(shapes=[SimpleNamespace(name="n")])
    assert number(effect, "n", 0.67, 0.05, "") == "0.67 ± 0.05"
    assert number(effect, "share", 0.67, 0.05, "").endswith("%")
