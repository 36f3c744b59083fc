"""The headline of a fit: whether its values can be used, the values, and the error with them."""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite, isnan

import numpy as np

from identification.estimation.fit import Fit
from identification.prediction.fits.record_errors import errors_by_unit
from identification.prediction.records_fit import RecordsFit
from identification.report.fit.step_words import part_of_steps
from identification.report.fit.verdict import (
    REST,
    error_over_noise,
    judged_on,
    most_of_noise,
    rests,
)
from identification.report.page.headline import Answer, Headline, Tile, error_tile
from identification.report.words.effects import value_with_std
from identification.shares import times_noise

FEW = 2  # values that have a tile each


def fit_headline(
    fit: Fit | RecordsFit, units: Mapping[str, str], is_better: bool = True
) -> Headline:
    """Returns the answer of a fit in a few words and numbers.

    Args:
        fit: that has ended.
        units: of its values, by name.
        is_better: whether unseen data do not speak for the values with which it began.
    """
    name, place = _judged(fit, is_better)
    return Headline("", (Answer(name, place, (*_values(fit, units), _error(fit))),))


def _judged(fit: Fit | RecordsFit, is_better: bool) -> tuple[str, str]:
    """Returns whether the fitted values can be used, and why."""
    if fit.worse is not None:
        return (
            "Do not use these values",
            "They predict unseen records worse than the first"
            " ones; discover looks for what the model lacks.",
        )
    if fit.stopped:
        return "Stopped", "These are the best values that the search had seen."
    if not fit.converged:
        return "Not converged", "The search ran out of iterations."
    ratio = error_over_noise(fit)
    if isnan(ratio):
        return "Fitted", ""
    left = f"The error on {judged_on(fit)} is {times_noise(ratio)}"
    most = most_of_noise(fit)
    part = part_of_steps(fit, ratio, most)
    if part != "no":
        return (
            "Fitted, and its steps are too coarse",
            f"{left}, and {part} of what is above it comes from the steps of the simulation.",
        )
    if ratio > most:
        return "Fitted, and something is missing", f"{left}; discover looks for what it is."
    if rests(fit):
        return "Fitted, and not confirmed", f"{left}, {REST}."
    if not is_better:
        said = "but unseen data do not confirm that the values are better"
        return "Fitted, and not confirmed", f"{left}, {said}."
    return "Fitted, and the model explains the log", f"{left}."


def _values(fit: Fit | RecordsFit, units: Mapping[str, str]) -> list[Tile]:
    """Returns a tile for each of a few values, or one on the worst known of many."""
    rows = {
        name: (value, float(std), units.get(name.partition(" [")[0], ""))
        for (name, value), std in zip(fit.values.items(), fit.std, strict=True)
    }
    bound = dict(zip(rows, map(bool, fit.at_bound), strict=True))
    started = dict(zip(rows, map(float, fit.start), strict=True))
    if len(rows) <= FEW:
        return [
            Tile(name, value_with_std(value, 0.0 if bound[name] else std, unit),
                 "on its bound" if bound[name]
                 else f"began at {value_with_std(started[name], 0.0, unit)}")
            for name, (value, std, unit) in rows.items()
        ]  # fmt: skip
    share = {n: abs(std / v) for n, (v, std, _) in rows.items() if v and not bound[n]}
    known = {n: s for n, s in share.items() if isfinite(s)}
    if not known:
        return [Tile("values", str(len(rows)))]
    worst = max(known, key=lambda n: known[n])
    return [
        Tile("values", str(len(rows)), "see the table"),
        Tile(f"least known: {worst}", value_with_std(*rows[worst])),
    ]


def _error(fit: Fit | RecordsFit) -> Tile:
    """Returns the tile on the error, of data that the fit has not seen where there is some."""
    if isinstance(fit, Fit):
        unseen = fit.validation_rms_by_unit
        what = "error of the fitted data" if unseen is None else "error on unseen data"
        return error_tile(unseen or fit.rms_by_unit, None, fit.floor_by_unit, what)
    squares = np.concatenate(fit.begun.of_outputs)
    begun = errors_by_unit(squares, fit.model.scale, fit.records[0].log)
    what = f"error on unseen data over {fit.horizon:g} s"
    return error_tile(begun, fit.unseen_by_unit, fit.noise_by_unit, what)
