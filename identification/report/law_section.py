"""The section of a report that draws the physics that was found."""

from __future__ import annotations

from typing import TYPE_CHECKING

from identification.discovery.effect_results import NamedEffect
from identification.discovery.recovered_force import RecoveredForce, recover_force
from identification.discovery.result import Discovery
from identification.errors import DivergenceError
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
NONE = (
    "{effect}: not drawn. It acts at several places at once, or by more than one quantity together,"
    " so that there is nothing to draw it against. The figures of the gap show what it does."
)


def law_sections(found: Discovery) -> list[Section]:
    """The section on the recovered forces; none where nothing is named.

    Args:
        found: the discovery.
    """
    if not found.named:
        return []
    each = [(named, _recovered(found, named)) for named in found.named]
    figures: list[tuple[str, Figure]] = []
    said = [HOW] if any(of is not None for _, of in each) else []
    for named, of in each:
        effect = describe_effect(named.candidate)
        if of is None:
            said.append(NONE.format(effect=effect[0].upper() + effect[1:]))
            continue
        what = "error" if "reading" in named.candidate.effect.hooks else "force"
        figures.append((f"Missing {what} and its law: {effect}", law_figure(of)))
        said.append(f"{effect[0].upper()}{effect[1:]}: {named.candidate.effect.law}.")
    return [Section(LAWS, "\n\n".join(said), figures=tuple(figures))]


def _recovered(found: Discovery, named: NamedEffect) -> RecoveredForce | None:
    try:
        return recover_force(found.final, named.candidate, named.rivals)
    except DivergenceError:  # of the law with a changed parameter, or of a rival's
        return None
