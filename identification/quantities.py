"""Quantities as a person writes them: value ± std, an SI prefix, the digits that are known.

0.00412 ± 0.00021 N m  ->  4.12 ± 0.21 mN m

A number that rounds to zero has no minus sign: the `z` of a format, here and in all sentences. A
value that would read as zero beside its std is said with one digit more: 0.02 ± 0.50 nm.
`plain` is what JSON takes.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from math import ceil, floor, isfinite, log10
from typing import Any

from identification.shares import decimal

_PREFIXES = {-9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M"}
_TAKE = ("N", "m", "s", "A", "g", "V", "W", "Hz")  # units that take a prefix where they lead
_SMALL_INERTIA = 1e-3  # [kg m²]
_SMALL = ("rad",)  # those that take small ones only: nobody says kiloradian
_LEAST = 1e-3  # smaller numbers, in units without a prefix, are said as powers of ten
_SHARE = 1e-5  # a smaller number without unit is no percentage, but a power of ten
_LARGE = 1e6  # a larger value in a table is a power of ten
_FINEST = 1e-5  # a smaller std is said as a power of ten
_MOST = 15  # decimals, beyond which a number of a computer has none
_DIGITS = 3  # of a value whose std is not known
_DIGITS_IN_TABLE = 4  # of such a value in a table
_ALONE = re.compile(r"\(([^\W\d_]+)\)")  # brackets around one symbol
HELD = 2  # digits of the error of a model that are said (docs/identification.md)


def finite_or_none(value: float | None) -> float | None:
    """Returns a number for JSON, which knows no infinity: None (null) where it is not finite."""
    return None if value is None or not isfinite(value) else float(value)


def plain(value: Any) -> Any:
    """Returns plain values for JSON: dicts of records, lists of arrays, None if not finite."""
    if isinstance(value, Mapping):
        return {k: plain(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [plain(v) for v in value]
    if is_dataclass(value) and not isinstance(value, type):
        return {f.name: plain(getattr(value, f.name)) for f in fields(value)}
    if hasattr(value, "tolist"):
        return plain(value.tolist())
    return finite_or_none(value) if isinstance(value, float) else value


def plain_fields(value: object, *names: str, **renamed: str) -> dict[str, Any]:
    """Returns fields of a record as plain values for JSON, by their names or by new ones."""
    every = {**{name: name for name in names}, **renamed}
    return {new: plain(getattr(value, old)) for new, old in every.items()}


def quantity(value: float, std: float = float("nan"), unit: str = "", like: float = 0.0) -> str:
    """Returns a value with its std and unit.

    Args:
        value: in `unit`.
        std: in `unit`; not said when it is not finite or zero.
        unit: SI unit, "" when dimensionless: small numbers are then said in percent.
        like: the largest value, or std, beside which it stands, in `unit`: both then have one
            prefix.
    """
    if not isfinite(value):
        return "unknown"
    known = isfinite(std) and std > 0
    largest = max(abs(like), abs(value), std if known else 0.0)
    factor, unit = _scale(largest, unit, exact=std == 0)
    value, std = value / factor, std / factor
    if unit == "%":
        return f"{_percentage(value, std if known else 0.0)} %"
    if not known:
        return f"{_plain(value, _DIGITS)} {unit}".strip()
    places = min(_shared(value, std), _MOST)
    value, std, places = _whole(value, std, places)
    if std < _FINEST:
        return f"{value:z.{places}f} ± {std:.1e} {unit}".strip()
    return f"{value:z.{places}f} ± {std:.{places}f} {unit}".strip()


def _percentage(value: float, std: float) -> str:
    """Returns a percentage, and its std where it is no zero in decimals; no powers of ten."""
    if std < 10.0**-_MOST:
        return decimal(value, _DIGITS) if abs(value) < _LEAST else _plain(value, _DIGITS)
    places = min(max(0, _shared(value, std)), _MOST)
    return f"{value:z.{places}f} ± {std:.{places}f}"


def matched(value: float, std: float, sign: str = "") -> tuple[str, str]:
    """Returns a value and its std for two columns of a table: the value has the digits of the std.

    Args:
        value: in its unit.
        std: in the same unit; where it is zero, the value has six digits, and where it is not
            finite, four.
        sign: "+" where the sign is always written.
    """
    if not isfinite(std):
        return f"{value:{sign}z.{_DIGITS_IN_TABLE}g}", "unknown"
    if std <= 0:
        return f"{value:{sign}z.6g}", f"{std:.2g}"
    places = _shared(value, std)
    if std < _FINEST and _LEAST <= abs(value) < _LARGE and places <= _MOST:
        return f"{value:{sign}z.{places}f}", f"{std:.1e}"
    if std < _FINEST or abs(value) >= _LARGE:  # a power of ten, with the std's digits
        lead = floor(log10(max(abs(value), std)))
        return f"{value:{sign}z.{min(max(0, lead + places), _MOST)}e}", f"{std:.1e}"
    return f"{value:{sign}z.{max(0, places)}f}", f"{std:.{max(0, places)}f}"


def probability(p: float) -> str:
    """Returns a small probability as text."""
    return f"{p:.0e}" if p > 0 else "below 1e-300"


def held(value: float) -> str:
    """Returns the error of a model, or a ratio of two, with two digits."""
    return _plain(_rounded(value, HELD), HELD) if isfinite(value) else "unknown"


def error(value: float, unit: str) -> str:
    """Returns the error of a model with its unit, two digits.

    Args:
        value: in `unit`.
        unit: SI unit, "" where there is none or where outputs have several.
    """
    return alike([value], unit, HELD)[0]


def alike(values: Sequence[float], unit: str, digits: int = _DIGITS) -> list[str]:
    """Returns several values with one prefix, so that they compare at a glance.

    It is that of the largest, or where that has none and the smallest needs one, the milli's.

    Args:
        values: in `unit`.
        unit: SI unit, "" when dimensionless.
        digits: of each; `HELD` for errors of models.
    """
    known = [abs(v) for v in values if isfinite(v)]
    most, least = max(known, default=0.0), min(known, default=0.0)
    factor, name = _scale(most, unit, exact=True)
    if factor == 1.0 and 0 < least < _LEAST and most < 1:
        factor, name = _scale(0.01, unit, exact=True)
    sizes = [_rounded(v / factor, digits) for v in values]
    return [f"{_plain(v, digits)} {name}".strip() if isfinite(v) else "unknown" for v in sizes]


def plain_unit(unit: str) -> str:
    """Returns a unit without brackets around single symbols, as a user may have written: m/(N)."""
    return _ALONE.sub(r"\1", unit)


def per(over: str, under: str, power: int = 1) -> str:
    """Returns the unit of a quotient, with brackets where needed: m/N, rad/(N m), 1/(N m)^2."""
    below = under if under.isalnum() else f"({under})"
    return f"{over}/{below}" + (f"^{power}" if power != 1 else "")


def _scale(magnitude: float, unit: str, exact: bool) -> tuple[float, str]:
    """Returns the unit for a magnitude, as a factor to the old unit, and its name."""
    unit = plain_unit(unit)
    if not unit:
        is_share = magnitude == 0 or _SHARE <= magnitude < 1
        return (0.01, "%") if is_share and not exact else (1.0, "")
    lead, rest = _lead(unit)
    base = 1.0
    if lead == "kg" and rest:  # nobody says g m² of an inertia: that of a rotor is told in kg cm²
        is_small = rest in (" m^2", " m²") and 0 < magnitude < _SMALL_INERTIA
        return (1e-4, unit.replace(" m", " cm")) if is_small else (1.0, unit)
    if lead == "kg":
        base, lead = 1e-3, "g"
    if lead not in (*_TAKE, *_SMALL) or magnitude == 0:
        return 1.0, unit
    power = 3 * floor(log10(magnitude / base) / 3 + 1e-9)
    power = min(max(power, -9), 0 if lead in _SMALL else 6)
    if unit.startswith("kg") and power == 3:
        return 1.0, unit
    # 0.3 m or 0.8 rad/s need no prefix
    if power == -3 and 0.1 <= magnitude / base < 1 and lead in ("m", "s", "rad", "N", "A"):
        power = 0
    return base * 10.0**power, _PREFIXES[power] + lead + rest


def _lead(unit: str) -> tuple[str, str]:
    """Returns the first symbol of a unit, and the rest of it."""
    end = next((k for k, c in enumerate(unit) if not c.isalpha()), len(unit))
    # A power belongs to the symbol: mm² is not milli(m²)
    if end < len(unit) and unit[end] in "^²³0123456789":
        return "", unit
    return unit[:end], unit[end:]


def _decimals(std: float) -> int:
    """Returns the decimals that show two digits of a std that starts with 1 to 3, else one."""
    first = floor(log10(std))
    return -first + (1 if std / 10.0**first < 3.5 else 0)


def _shared(value: float, std: float) -> int:
    """Returns the decimals of a value and its std: one more where the value would read as zero."""
    places = _decimals(std)
    is_lost = value != 0 and abs(value) < 0.5 * 10.0**-places
    return places + 1 if is_lost and std / 10.0 ** floor(log10(std)) >= 3.5 else places


def _whole(value: float, std: float, places: int) -> tuple[float, float, int]:
    """Returns a value and its std of whole numbers, rounded to the digits of the std: 520 ± 580."""
    if places >= 0:
        return value, std, places
    return round(value, places), round(std, places), 0


def _rounded(value: float, digits: int) -> float:
    """Returns a value rounded if `digits` is `HELD`: 131.4 with two digits is 130."""
    return float(f"{value:.{digits}g}") if digits == HELD else value


def _plain(value: float, digits: int) -> str:
    if value == 0 or (value == round(value) and abs(value) < 1e6):
        return f"{value:z.0f}"
    if abs(value) < _LEAST:
        return f"{value:z.{digits - 1}e}"
    places = max(0, digits - ceil(log10(abs(value)) + 1e-12))
    return f"{value:z.{places}f}"
