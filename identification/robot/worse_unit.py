"""Outputs of one unit that a fit predicts worse, while those of another one are not.

One number over all outputs hides it: a fit may give up the angles to win the slides.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from identification.report.error_words import kind, listed
from identification.robot.record_error import Confirmation

LEAST = 0.1  # rise of the mean square of one unit that is told


def worse_unit(confirmed: Sequence[Confirmation]) -> list[str]:
    """Returns one sentence that names outputs that are predicted worse while others are not."""
    rises = _rises(confirmed)
    worse = {unit: rise for unit, rise in rises.items() if rise > LEAST}
    others = {unit: rise for unit, rise in rises.items() if unit not in worse}
    if not worse or not others:
        return []
    return [
        f"The fitted values predict {_told(worse)} of what was not fitted worse than the values"
        f" with which the fit began, and not {_told(others)}. This may be chance, or the fit makes"
        " up in one for an error in the other: fit a longer log, or more logs, before you rely on"
        f" what it predicts of {listed([kind(unit) for unit in worse])}."
    ]


def _rises(confirmed: Sequence[Confirmation]) -> dict[str, float]:
    """Returns the rise of the mean square by unit, over records, each of which counts alike."""
    before, after = (
        _squares([getattr(c, name) for c in confirmed])
        for name in ("before_by_unit", "after_by_unit")
    )
    return {unit: after[unit] / b - 1 for unit, b in before.items() if b > 0}


def _squares(each: Sequence[Mapping[str, float]]) -> dict[str, float]:
    """Returns sums of squares over records, by unit."""
    units = dict.fromkeys(unit for errors in each for unit in errors)
    return {unit: sum(errors.get(unit, 0.0) ** 2 for errors in each) for unit in units}


def _told(rises: Mapping[str, float]) -> str:
    """Returns the outputs with the change of their mean square, in words."""
    return listed([f"the {kind(u)} (mean square {100 * r:+z.0f} %)" for u, r in rises.items()])
