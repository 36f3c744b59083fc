"""Judgement constants of the noise model and of the fit, with their units and reasons.

A judgement constant decides what is believed. Numerical details (steps of finite differences,
damping, grids on which a search begins) are no judgement and stay beside the code that uses them.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from math import inf, isfinite
from numbers import Integral, Real
from sys import float_info
from typing import Any

from identification.errors import InputError


def option(
    default: float, unit: str, reason: str, source: str, least: float = 0.0, most: float = inf
) -> Any:
    """Returns a field of a record of options.

    Args:
        default: its value; an option whose default is an int takes whole numbers only.
        unit: of the value.
        reason: what the option decides, and why the default is what it is.
        source: where the default comes from: a book, a paper, or "judgement".
        least: smallest value that makes sense.
        most: largest value that makes sense.
    """
    metadata = {"unit": unit, "reason": reason, "source": source, "least": least, "most": most}
    return field(default=default, metadata=metadata)


@dataclass(frozen=True, kw_only=True)
class KalmanOptions:
    """Options of which errors of the inputs and which structure of the innovations are believed.

    Every field has its unit, reason and source in its metadata (`dataclasses.fields`).

    Raises:
        InputError: a value is no number, or lies outside the range that makes sense.
    """

    allowed_input_error: float = option(
        0.1, "of the inputs' own motion",
        "An unlogged error of the inputs up to this rms passes for noise; a larger one may hide a"
        " missing effect, so it is not believed while a model approaches the data, and it is"
        " reported.",
        "judgement",
    )  # fmt: skip
    structure_level: float = option(
        1e-4, "probability",
        "A test of what a model leaves unexplained counts below this p-value; it is small because"
        " several tests are made of every model.",
        "judgement", most=1.0,
    )  # fmt: skip
    min_structure_share: float = option(
        0.03, "of a mean square",
        "Structure that explains less than this share does not count as a missing effect; a"
        " linearised predictor of a nonlinear robot leaves as much.",
        "judgement", most=1.0,
    )  # fmt: skip

    def __post_init__(self) -> None:
        for f in (f for f in fields(self) if f.metadata):
            value, least, most = getattr(self, f.name), f.metadata["least"], f.metadata["most"]
            whole = isinstance(f.default, int)
            number = isinstance(value, Integral if whole else Real) and not isinstance(value, bool)
            if not number or not least <= value <= min(most, float_info.max):
                kind = "whole number" if whole else "number"
                limits = (
                    f"from {least:g} to {most:g}" if isfinite(most) else f"of {least:g} or more"
                )
                raise InputError(f"option {f.name} is {value!r}; give a {kind} {limits}")
