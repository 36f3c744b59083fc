"""Prefixes, and as many digits as are known."""

import pytest

from identification.quantities import HELD, alike, held, probability, quantity

NAN, INF = float("nan"), float("inf")


@pytest.mark.parametrize(
    ("value", "std", "unit", "said"),
    [
        (0.0041234, 0.00021, "N m", "4.12 ± 0.21 mN m"),
        (1.93, 0.6, "rad/s", "1.9 ± 0.6 rad/s"),
        (0.00035, NAN, "s", "350 µs"),
        (0.002, 0.0001, "kg/m", "2.00 ± 0.10 g/m"),
        (0.1725, 0.004, "kg", "172 ± 4 g"),
        (25000.0, 300.0, "N", "25.00 ± 0.30 kN"),
        (0.03, 0.004, "", "3.0 ± 0.4 %"),
        (400.0, 25.0, "", "400 ± 25"),
        (6.0, 0.0, "", "6"),
        (0.5, INF, "A", "0.500 A"),
        (-0.0012, 0.0003, "m", "-1.20 ± 0.30 mm"),
        (0.01, 0.001, "N s²/m²", "10.0 ± 1.0 mN s²/m²"),
        (0.0, NAN, "N m", "0 N m"),
        (INF, NAN, "m", "unknown"),
        (2e-4, 1e-5, "m²", "0.000200 ± 0.000010 m²"),
        (2.38e-6, NAN, "1/s", "2.38e-06 1/s"),
        (120.0, 5.0, "rad/s", "120 ± 5 rad/s"),
    ],
)
def test_quantities(value: float, std: float, unit: str, said: str) -> None:
    assert quantity(value, std, unit) == said


def test_one_prefix_for_all() -> None:
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


def test_a_chance_that_underflows_is_not_called_zero() -> None:
    assert probability(3.4e-21) == "3e-21"
    assert probability(0.0) == "below 1e-300"
