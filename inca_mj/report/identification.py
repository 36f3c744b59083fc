"""An identification as sentences, as plain values for JSON, and as sections of a report."""

from __future__ import annotations

from collections.abc import Sequence
from math import nan
from typing import Any

import numpy as np

from identification.estimation.fit import Fit
from identification.estimation.profiles import Profile
from identification.kalman.estimate import InnovationsFit
from identification.quantities import error, finite_or_none, matched
from identification.report.fit.json import fit_to_json
from identification.report.fit.untold_words import identifiable_sentences
from identification.report.fit.verdict import (
    HOLDS,
    coloured_outputs,
    fit_verdict,
    search_sentences,
    window_sentences,
)
from identification.report.page.page import Section, Table
from identification.windows.window_estimate import WindowEstimate
from inca_mj.twin.logs import POSE
from inca_mj.workflows.identification import Identification

# name, value, std, unit, start, on a bound
Row = tuple[str, float, float, str, float, bool]


def identification_json(
    result: Identification, profiles: Sequence[Profile] = (), seed: int = 0
) -> dict[str, Any]:
    """Returns the numbers and the verdict; unknown and infinite numbers are null."""
    record = fit_to_json(result.fit)
    record["steps"] = [fit_to_json(fit) for fit in result.fits]
    record["verdict"] = identification_verdict(result)
    record["seconds"] = result.seconds
    record["seed"] = seed
    if result.starts:
        record["starts"] = [[finite_or_none(e) for e in errors] for errors in result.starts]
    if (found := result.innovations) is not None:
        record["innovations"] = {
            "rms": found.rms, "validation_rms": found.validation_rms,
            "sensor_std": found.level.sigma, "input_error_std": found.level.input_std,
            "input_error_time": found.level.noise.time if found.level.noise.ratio else None,
        }  # fmt: skip
    if profiles:
        record["profiles"] = {
            p.name: {
                "value": p.estimate, "interval": [finite_or_none(end) for end in p.interval],
                "values": p.values.tolist(), "rise": [finite_or_none(r) for r in p.rise],
            }
            for p in profiles
        }  # fmt: skip
    if (w := result.windows) is not None:
        record["parameters"] = {
            name: {"value": value, "std": finite_or_none(std), "unit": unit, "initial": first,
                   "at_bound": bound}
            for name, value, std, unit, first, bound in rows(result, result.fit)
        }  # fmt: skip
        record["windows"] = {
            "seconds": w.length, "count": len(w.residual), "rms": w.rms, "converged": w.converged,
            "linearisations": w.tangents,
        }  # fmt: skip
    return record


def identification_verdict(result: Identification) -> list[str]:
    """Returns the verdict of the fit to believe, after sentences on its windows and its starts."""
    if result.innovations is not None:
        return innovations_verdict(result.innovations)
    if result.windows is not None:
        return windows_verdict(result.windows, result.fit)
    lines = fit_verdict(result.fit)
    held = [name for name in POSE if name not in result.fit.estimate.values]
    if len(held) == len(POSE):
        lines.append(
            "The start pose is held where the parameter set puts it; where that is not exact,"
            f" estimate it too: --free ... {' '.join(held)}."
        )
    if result.starts:
        unit, errors = result.fit.estimate.predictor.log.output_unit, result.starts[result.best]
        best, worst = float(errors.min()), float(errors.max())
        said = "The first start ended near the noise floor; no other was needed."
        if len(errors) > 1:
            said = (
                f"{len(errors)} starts were tried; {int((errors < 1.01 * best).sum())} ended within"
                f" 1 % of the best, {error(best, unit)} rms, the worst at {error(worst, unit)}."
            )
        lines.append(said)
    return lines


def rows(result: Identification, fit: Fit) -> list[Row]:
    """Returns the rows of the table of parameters: those of the windows, then those of the fit."""
    known = fit.estimate.predictor.plant.parameters
    w, e = result.windows, fit.estimate
    parts: list[tuple[Any, ...]] = []
    if w is not None:
        parts += [
            part for part in zip(w.values, w.values.values(), w.std, w.start, w.at_bound,
                                 strict=True)
            if part[0] not in e.values
        ]  # fmt: skip
    parts += zip(e.values, e.values.values(), fit.std, e.start, fit.at_bound, strict=True)
    return [
        (name, float(value), float(std), known[name].unit, float(first), bool(bound))
        for name, value, std, first, bound in parts
    ]


def windows_verdict(found: WindowEstimate, fit: Fit) -> list[str]:
    """Returns what the windows found, and how well their parameters predict a free run."""
    floor, unit = float(np.sqrt(np.mean(fit.floor**2))), fit.estimate.predictor.log.output_unit
    lines = window_sentences(found, floor, unit)
    unseen = ""
    if fit.validation_rms is not None:
        unseen = f" and {error(fit.validation_rms, unit)} on unseen data"
    lines.append(
        f"A free run with them, its start pose fitted, leaves {error(fit.rms, unit)} rms{unseen};"
        " there small errors of parameters, and all that disturbs the robot, add up."
    )
    return lines


def innovations_verdict(found: InnovationsFit) -> list[str]:
    """Returns the verdict of an estimate by innovations: first on the noise, then on the fit."""
    fit, noise = found.fit, found.level
    lines = [*search_sentences(fit)]
    if fit.estimate.status == "stopped":  # it says nothing of the model
        return lines
    lines += identifiable_sentences(fit)
    log = fit.estimate.predictor.log
    unit, sensors = log.output_unit, error(noise.sigma, log.output_unit)
    if noise.noise.ratio:
        inputs = error(noise.input_std, log.units.get(log.input_names[0], ""))
        lines.append(
            f"The inputs err by {inputs} rms beside what the log says, for"
            f" {noise.noise.time:g} s at a time; the sensors' noise is {sensors}."
        )
    else:
        lines.append(f"The inputs are as the log says; the sensors' noise is {sensors}.")
    if found.validation_rms is not None:
        ratio = found.validation_rms / found.rms
        held = "the model holds there too" if ratio < HOLDS else "the model does not hold there"
        lines.append(
            f"One step ahead it errs by {error(found.rms, unit)} rms,"
            f" by {error(found.validation_rms, unit)} on unseen data: {held}."
        )
        unseen = nan if fit.validation_rms is None else fit.validation_rms
        lines.append(
            f"A free run errs by {error(fit.rms, unit)}, by {error(unseen, unit)} on unseen data;"
            " there all that disturbs the robot adds up."
        )
    lines.append(
        "The innovations are white: the model suffices."
        if not coloured_outputs(fit)
        else f"The innovations of {coloured_outputs(fit)} outputs are coloured: the model lacks"
        " something; `inca discover` looks for it."
    )
    return lines


def profile_sentence(known: Profile) -> str:
    """Returns the 95 % interval of a profile in words."""
    low, high = known.interval
    text = f"{known.name}: {known.estimate:.6g}, 95 % interval [{low:.6g}, {high:.6g}]"
    return text + ("; open: the log does not bound it here" if known.open else "")


def fit_section(result: Identification, fit: Fit, title: str) -> Section:
    """Returns the section on parameters with uncertainty, and the fit's verdict."""
    lines = identification_verdict(result) if fit is result.fit else fit_verdict(fit)
    return Section(
        title,
        "\n\n".join(lines),
        table=Table(
            ("parameter", "value", "std", "unit", "start", "note"),
            tuple(
                (name, *matched(value, std), unit, first, "at bound" if bound else "")
                for name, value, std, unit, first, bound in rows(result, fit)
            ),
        ),
    )


def profile_section(fit: Fit, known: Profile) -> Section:
    """Returns the profile of one parameter: how well the others can compensate a change of it."""
    from identification.report.page.figures import profile_figure

    unit = fit.estimate.predictor.plant.parameters[known.name].unit
    return Section(
        f"Profile of {known.name}",
        f"{profile_sentence(known)}.\n\nThe others are fitted anew at each value. Between the"
        " crossings with the line lies the 95 % interval, however curved the profile is.",
        figures=((f"Profile of {known.name}", profile_figure(known, unit)),),
    )
