"""The section of a report that draws the physics that was found."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from identification.discovery.recovered_force import RecoveredForce
from identification.discovery.result import Discovery
from identification.errors import DivergenceError
from identification.quantities import quantity
from identification.report.effect_words import describe_effect
from identification.report.law_figure import law_figure
from identification.report.page import Section

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LAWS = "The physics that was found"
HOW = (
    "The points are the force that the data ask for: in the place of the law the fit got a curve"
    " whose nodes are free, so that nothing holds the points near the law. All other parameters are"
    " those of the fit with the law. Bars and band are of 95 %: the bars hold the noise, the band"
    " what is not known of the law's own parameters. Where the law is right, the points lie on it;"
    " where they leave it, another law is at work there."
)
OVER_HORIZON = (
    " They are recovered over windows, each of which begins in the state that explains it best, so"
    " that what a state can explain is not counted; a rival's law has the sizes of its own fit."
)
NONE = (
    "{effect}: not drawn. It acts at several places at once, or by more than one quantity together,"
    " so that there is nothing to draw it against. The figures of the gap show what it does."
)


def law_sections(found: Discovery) -> list[Section]:
    """Returns the section on the recovered forces; none where nothing is named.

    Args:
        found: the discovery.
    """
    each = [
        (n.candidate, _if_simulated(partial(found.recover, n.candidate, n.rivals)))
        for n in found.named
    ]
    if not each:
        return []
    figures: list[tuple[str, Figure]] = []
    drawn = any(of is not None for _, of in each)
    said = [HOW + OVER_HORIZON * (found.horizon is not None)] if drawn else []
    for candidate, of in each:
        effect = describe_effect(candidate)
        if of is None:
            said.append(NONE.format(effect=effect[0].upper() + effect[1:]))
            continue
        what = "error" if "reading" in candidate.effect.hooks else "force"
        figures.append((f"Missing {what} and its law: {effect}", law_figure(of)))
        most = quantity(float(np.abs(of.law.force).max()), unit=of.units[1])
        said.append(
            f"{effect[0].upper()}{effect[1:]}: {candidate.effect.law}. Along this motion it is"
            f" {most} at most, which need not be the value of one of its parameters."
        )
    return [Section(LAWS, "\n\n".join(said), figures=tuple(figures))]


def _if_simulated(recover: Callable[[], RecoveredForce | None]) -> RecoveredForce | None:
    """Returns a recovered force; None where the changed law, or a rival's, diverges."""
    try:
        return recover()
    except DivergenceError:
        return None
