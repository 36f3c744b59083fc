"""Parameters as the optimiser sees them: numbers of order one without units.

    q = ln(value)       where the value is positive and may not change sign (a mass, a stiffness)
    q = value/scale     otherwise (a position, an angle, the size of an effect)

A step in q is then a relative change, or metres and radians, of similar weight.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np

from identification.errors import InputError, repeated
from identification.model.parameter import ParameterSet

FARTHEST = 700.0  # of a logarithm: beyond, exp overflows
# A bound lies this many units in the last place inside the range of the values, so that a search
# that ends on it gives a value of the range: exp(ln(x)) may be larger than x by the last digit.
INSIDE = 4 * np.finfo(float).eps


@dataclass(frozen=True)
class Coordinates:
    """A change of variables for p parameters: values in their units, q without units."""

    names: tuple[str, ...]  # the parameters, p of them
    logarithmic: np.ndarray  # true where q = ln(value), shape (p,)
    lower: np.ndarray  # smallest q, without unit, shape (p,)
    upper: np.ndarray  # largest q, without unit, shape (p,)
    # value of q = 1 of those that are not logarithmic, in their units, shape (p,)
    scale: np.ndarray

    def encode(self, values: np.ndarray) -> np.ndarray:
        """Returns q of some values, shape (..., p)."""
        logarithm = np.log(np.where(self.logarithmic, values, 1.0))
        return np.where(self.logarithmic, logarithm, np.asarray(values) / self.scale)

    def decode(self, q: np.ndarray) -> np.ndarray:
        """Returns the values of q, shape (..., p)."""
        return np.where(
            self.logarithmic,
            np.exp(np.clip(np.where(self.logarithmic, q, 0.0), -FARTHEST, FARTHEST)),
            q * self.scale,
        )

    def inside(self, q: np.ndarray) -> np.ndarray:
        """Returns the point inside the bounds nearest to q, shape (..., p)."""
        return np.clip(q, self.lower, self.upper)

    def slope(self, q: np.ndarray) -> np.ndarray:
        """Returns d value/d q, shape (..., p): a std in q times this is a std of the value."""
        return np.where(self.logarithmic, self.decode(q), self.scale)

    def on_bound(self, q: np.ndarray) -> np.ndarray:
        """Returns which of q (p,) lie on a bound, shape (p,)."""
        near = 1e-6 * np.maximum(1.0, np.abs(q))
        return (q - self.lower < near) | (self.upper - q < near)


_NONE = np.zeros(0)
NOTHING = Coordinates((), _NONE.astype(bool), _NONE, _NONE, _NONE)  # where nothing is free


def coordinates(
    parameters: ParameterSet,
    names: Sequence[str],
    start: np.ndarray,
    linear: Collection[str] = (),
) -> Coordinates:
    """Returns coordinates of some parameters of a set, fit for a search from `start`.

    It has the shape (p,), in the parameters' units. Those that are `linear` are not logarithmic
    though they are positive.

    Raises:
        InputError: nothing is free, a name occurs twice, or a start lies outside its bounds.
    """
    if not names:
        raise InputError("no parameter is free; name at least one to estimate")
    twice = repeated(list(names))
    if twice:
        raise InputError(f"parameter {twice[0]!r} is named twice; name each once")
    records = [parameters[name] for name in names]
    for record, value in zip(records, start, strict=True):
        if not record.lower < value < record.upper:
            raise InputError(
                f"the start of {record.name} = {value:g} {record.unit}".rstrip()
                + f" must lie inside ({record.lower:g}, {record.upper:g}); a search that starts"
                " on a bound stays there. Give it a value inside, in a robot's file as"
                f' [parameters."{record.name}"] with value = ...'
            )
    logarithmic = np.array(
        [r.lower >= 0 and v > 0 and r.name not in linear
         for r, v in zip(records, start, strict=True)]
    )  # fmt: skip
    lower, upper, scale = (
        np.array([getattr(r, field) for r in records]) for field in ("lower", "upper", "scale")
    )
    with np.errstate(divide="ignore"):
        low = np.where(logarithmic, np.log(np.where(logarithmic, lower, 1.0)), lower / scale)
        high = np.where(logarithmic, np.log(np.where(logarithmic, upper, 1.0)), upper / scale)
    low, high = low + _digits(low, logarithmic), high - _digits(high, logarithmic)
    return Coordinates(tuple(names), logarithmic, low, high, scale)


def _digits(bound: np.ndarray, logarithmic: np.ndarray) -> np.ndarray:
    """Returns how far inside the range a bound is put, shape (p,); zero where there is none."""
    size = np.where(np.isfinite(bound), np.abs(bound), 0.0)
    return INSIDE * np.where(logarithmic & np.isfinite(bound), np.maximum(1.0, size), size)
