"""Units: those that a log file may use, and the dimension of any; inside the program all is in SI.

    N m s/rad  =  1 · kg^1 m^2 s^-1 A^0        g mm^2  =  1e-9 · kg^1 m^2 s^0 A^0

A dimension is a unit's factor to SI and its powers of kg, m, s and A. An angle has none, so that
N m s/rad and N m s are one unit. All that stands behind a slash is below it.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache
from math import isclose, pi

from identification.errors import InputError
from identification.logs.names import quoted

# symbol: (factor to SI, powers of kg, m, s, A)
_SYMBOLS: dict[str, tuple[float, tuple[int, ...]]] = {
    "1": (1.0, (0, 0, 0, 0)), "%": (0.01, (0, 0, 0, 0)),
    "kg": (1.0, (1, 0, 0, 0)), "g": (1e-3, (1, 0, 0, 0)), "t": (1e3, (1, 0, 0, 0)),
    "lb": (0.45359237, (1, 0, 0, 0)), "lbs": (0.45359237, (1, 0, 0, 0)),
    "m": (1.0, (0, 1, 0, 0)), "in": (0.0254, (0, 1, 0, 0)), "inch": (0.0254, (0, 1, 0, 0)),
    "ft": (0.3048, (0, 1, 0, 0)),
    "s": (1.0, (0, 0, 1, 0)), "min": (60.0, (0, 0, 1, 0)), "h": (3600.0, (0, 0, 1, 0)),
    "A": (1.0, (0, 0, 0, 1)), "Hz": (1.0, (0, 0, -1, 0)), "C": (1.0, (0, 0, 1, 1)),
    "rad": (1.0, (0, 0, 0, 0)), "deg": (pi / 180, (0, 0, 0, 0)), "°": (pi / 180, (0, 0, 0, 0)),
    "rev": (2 * pi, (0, 0, 0, 0)), "rpm": (pi / 30, (0, 0, -1, 0)),
    "N": (1.0, (1, 1, -2, 0)), "kgf": (9.80665, (1, 1, -2, 0)),
    "lbf": (4.4482216152605, (1, 1, -2, 0)),
    "J": (1.0, (1, 2, -2, 0)), "W": (1.0, (1, 2, -3, 0)), "Pa": (1.0, (1, -1, -2, 0)),
    "V": (1.0, (1, 2, -3, -1)), "Ω": (1.0, (1, 2, -3, -2)), "ohm": (1.0, (1, 2, -3, -2)),
    "Wb": (1.0, (1, 2, -2, -1)), "H": (1.0, (1, 2, -2, -2)), "F": (1.0, (-1, -2, 4, 2)),
    "T": (1.0, (1, 0, -2, -1)), "Nm": (1.0, (1, 2, -2, 0)),
}  # fmt: skip
# SI unit: the other words for this quantity that a log file may use
_WORDS = {
    "s": ("ms", "us", "ns"), "A": ("mA",), "V": ("mV",), "rad": ("deg", "mrad", "rev"),
    "rad/s": ("deg/s", "rev/s", "rpm"), "m": ("mm", "cm"), "m/s": ("mm/s",), "m/s^2": (),
    "N": ("mN", "kN"), "N m": ("mN m",), "1": ("%",),
}  # fmt: skip
_PREFIXES = {"n": 1e-9, "u": 1e-6, "µ": 1e-6, "m": 1e-3, "c": 1e-2, "d": 1e-1, "k": 1e3, "M": 1e6}
_RAISED = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
_POWER = re.compile(r"\^-?\d{1,2}|-\d{1,2}|[2-9]")
_TOKEN = re.compile(r"\s*(?:([A-Za-zµΩ°%]+|1)|(\^?\s*-?\d+)|([()/·*]))")
SI_UNITS = tuple(_WORDS)


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
    """Returns the smaller units of a quantity in which a raw number is within a limit [si]."""
    return [
        word
        for word, (unit, factor) in UNITS.items()
        if unit == si and factor < 1 and abs(raw) * factor <= limit
    ]


@dataclass(frozen=True)
class Dimension:
    """A unit."""

    factor: float = 1.0  # what one of it is in SI
    powers: tuple[int, ...] = (0, 0, 0, 0)  # of kg, m, s and A

    @property
    def is_si(self) -> bool:
        """Returns whether a number in this unit is the same number in SI."""
        return isclose(self.factor, 1.0, rel_tol=1e-12)

    def __mul__(self, other: Dimension) -> Dimension:
        powers = (a + b for a, b in zip(self.powers, other.powers, strict=True))
        return Dimension(self.factor * other.factor, tuple(powers))

    def __pow__(self, power: int) -> Dimension:
        return Dimension(self.factor**power, tuple(power * a for a in self.powers))


@lru_cache(maxsize=1024)  # each of thousands of parameters has one of a few units
def dimension(unit: str) -> Dimension | None:
    """Returns the dimension of a unit such as "N m s/rad", "kg m²" or "1/(N m)^2"; "" has none.

    None is returned where it has a symbol that is not known.
    """
    tokens: list[str] = []
    text = re.sub(r"[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+", lambda m: "^" + m[0].translate(_RAISED), unit).strip()
    at = 0
    while at < len(text):
        found = _TOKEN.match(text, at)
        if found is None:
            return None
        tokens.append("".join(found[0].split()))
        at = found.end()
    try:
        out = _product(tokens)
    except (KeyError, OverflowError, IndexError):
        return None
    return out if not tokens else None


def refuse_not_si(unit: str, what: str) -> None:
    """Refuse a unit in which a number is not that of SI, such as g or mm."""
    known = dimension(unit)
    if known is not None and not known.is_si:
        raise InputError(
            f"{what} has the unit {unit!r}, and numbers of a model are in SI units: multiply"
            f" its numbers by {known.factor:.9g} and give the SI unit"
        )


def refuse_other_unit(unit: str, expected: str, what: str) -> None:
    """Refuse a unit that is not the one in which a number is read."""
    if unit == expected:
        return
    given, right = dimension(unit), dimension(expected)
    if given is None or right is None or given.powers != right.powers:
        known = repr(expected) if expected else "no unit"
        raise InputError(
            f"{what} has the unit {unit!r}, and its numbers are in {known}: give them so"
        )
    if not given.is_si:
        raise InputError(
            f"{what} has the unit {unit!r}, and its numbers are in {expected!r}:"
            f" multiply them by {given.factor:.9g} and write unit = {expected!r}"
        )


def _product(tokens: list[str]) -> Dimension:
    """Returns the product of all tokens up to a closing parenthesis, and removes these tokens."""
    out, below = Dimension(), False
    while tokens and tokens[0] != ")":
        token = tokens.pop(0)
        if token == "/":
            below = True
            continue
        if token in "·*":
            continue
        if token == "(":
            each = _product(tokens)
            tokens.pop(0)  # the closing parenthesis
        else:
            each = _symbol(token)
        if tokens and _POWER.fullmatch(tokens[0]):
            each **= int(tokens.pop(0).lstrip("^"))
        out *= each**-1 if below else each
    return out


def _symbol(word: str) -> Dimension:
    """Returns the dimension of a symbol, split from its prefix where it is not known as a whole."""
    prefix = 1.0
    if word not in _SYMBOLS:
        prefix, word = _PREFIXES[word[0]], word[1:]
    factor, powers = _SYMBOLS[word]
    return Dimension(prefix * factor, powers)


# word: (SI unit, its value in this SI unit)
UNITS: dict[str, tuple[str, float]] = {
    word: (si, found.factor)
    for si, words in _WORDS.items()
    for word in (si, *words)
    if (found := dimension(word))
}
