"""Sections of reports on an identification."""

from __future__ import annotations

from identification.estimation.fit import Fit
from identification.estimation.profiles import Profile
from identification.quantities import matched
from identification.report.fit_verdict import fit_verdict
from identification.report.page import Section, Table
from identification.report.profile_figure import profile_figure
from inca_mj.report.identification_json import (
    identification_verdict,
    profile_sentence,
    rows,
)
from inca_mj.workflows.identification import Identification


def fit_section(result: Identification, fit: Fit, title: str) -> Section:
    """Returns the section on parameters with uncertainty, and the fit's verdict."""
    said = identification_verdict(result) if fit is result.fit else fit_verdict(fit)
    return Section(
        title,
        "\n\n".join(said),
        table=Table(
            ("parameter", "value", "std", "unit", "start", "note"),
            tuple(
                (
                    name,
                    *matched(value, std),
                    unit,
                    first,
                    "at bound" if bound else "",
                )
                for name, value, std, unit, first, bound in rows(result, fit)
            ),
        ),
    )


def profile_section(fit: Fit, known: Profile) -> Section:
    """Returns the profile of one parameter: how well the others can compensate a change of it."""
    unit = fit.estimate.predictor.plant.parameters[known.name].unit
    return Section(
        f"Profile of {known.name}",
        f"{profile_sentence(known)}.\n\nThe others are fitted anew at each value. Between the"
        " crossings with the line lies the 95 % interval, however curved the profile is.",
        figures=((f"Profile of {known.name}", profile_figure(known, unit)),),
    )
