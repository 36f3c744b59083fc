"""The units a log file may use; inside the program every quantity is in SI."""

from __future__ import annotations

from math import pi

from identification.errors import InputError
from identification.logs.names import quoted

# word: (SI unit, its value in this SI unit)
UNITS: dict[str, tuple[str, float]] = {
    "s": ("s", 1.0),
    "ms": ("s", 1e-3),
    "us": ("s", 1e-6),
    "ns": ("s", 1e-9),
    "A": ("A", 1.0),
    "mA": ("A", 1e-3),
    "V": ("V", 1.0),
    "mV": ("V", 1e-3),
    "rad": ("rad", 1.0),
    "deg": ("rad", pi / 180),
    "mrad": ("rad", 1e-3),
    "rev": ("rad", 2 * pi),
    "rad/s": ("rad/s", 1.0),
    "deg/s": ("rad/s", pi / 180),
    "rev/s": ("rad/s", 2 * pi),
    "rpm": ("rad/s", pi / 30),
    "m": ("m", 1.0),
    "mm": ("m", 1e-3),
    "cm": ("m", 1e-2),
    "m/s": ("m/s", 1.0),
    "mm/s": ("m/s", 1e-3),
    "m/s^2": ("m/s^2", 1.0),
    "N": ("N", 1.0),
    "mN": ("N", 1e-3),
    "kN": ("N", 1e3),
    "N m": ("N m", 1.0),
    "mN m": ("N m", 1e-3),
    "1": ("1", 1.0),
    "%": ("1", 1e-2),
}

SI_UNITS = tuple(word for word, (si, _) in UNITS.items() if word == si)


def to_si(word: str) -> tuple[str, float]:
    """Returns the SI unit of a unit word, and the factor that converts to it."""
    if word not in UNITS:
        raise InputError(f"unknown unit {quoted(word)}; known: {', '.join(UNITS)}")
    return UNITS[word]


def check_si(word: str) -> None:
    """Refuse a unit that is not SI."""
    if word not in SI_UNITS:
        raise InputError(
            f"a log holds SI units, not {quoted(word)}; convert to one of {', '.join(SI_UNITS)}"
        )


def units_that_fit(si: str, raw: float, limit: float) -> list[str]:
    """Returns the smaller units of a quantity in which a raw number would stay within a limit.

    Args:
        si: the SI unit of the quantity.
        raw: the number as the file has it.
        limit: largest plausible size [si].
    """
    return [
        word
        for word, (unit, factor) in UNITS.items()
        if unit == si and factor < 1 and abs(raw) * factor <= limit
    ]
