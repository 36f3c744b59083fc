"""What reports say of a fit."""

from __future__ import annotations

import numpy as np

from identification.fit import Fit
from identification.verdict import verdict
from inca_mj.report import Section, Table


def fit_section(fit: Fit, title: str) -> Section:
    """Parameters with uncertainty, and the fit's verdict."""
    known = fit.estimate.predictor.plant.parameters
    rows = zip(fit.estimate.values.items(), fit.std, fit.estimate.start, fit.at_bound, strict=True)
    return Section(
        title,
        "\n\n".join(verdict(fit)),
        table=Table(
            ("parameter", "value", "std", "unit", "start", "note"),
            tuple(
                (
                    name,
                    value,
                    float(std) if np.isfinite(std) else "unknown",
                    known[name].unit,
                    float(first),
                    "at bound" if bound else "",
                )
                for (name, value), std, first, bound in rows
            ),
        ),
    )
