"""A force recovered from the data, over what it follows, with the named law and its rivals."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from identification.discovery.forces.recovered_force import LawLine, RecoveredForce
from identification.discovery.result import Discovery
from identification.effects.effect import Candidate
from identification.errors import DivergenceError
from identification.quantities import quantity
from identification.report.page.page import Section
from identification.report.page.style import GREY, INK, MEASURED, SERIES, literal, styled
from identification.report.words.effects import describe_effect

LAWS = "The physics that was found"
HOW = (
    "The points are the force that the data ask for: in the place of the law the fit got a curve"
    " whose nodes are free, so that nothing holds the points near the law. All other parameters are"
    " those of the fit with the law. Bars and band are of 95 %: the bars hold the noise, the band"
    " what is not known of the law's own parameters. Where the law is right, the points lie on it;"
    " where they leave it, another law is at work there."
)
RECOVERED = {  # by what errors are of
    "free run": "",
    "windows": " They are recovered over windows, each of which begins in the state that explains"
    " it best, so that what a state can explain is not counted; a rival's law has the sizes of its"
    " own fit.",
}
NONE = (
    "{effect}: not drawn. It acts at several places at once, or by more than one quantity together,"
    " so that there is nothing to draw it against. The figures of errors show what it does."
)


def law_sections(found: Discovery) -> list[Section]:
    """Returns the section on the recovered forces; none where nothing is named."""
    if not found.named:
        return []
    each: list[tuple[Candidate, RecoveredForce | None]] = []
    for n in found.named:
        try:
            each.append((n.candidate, found.recover(n.candidate, n.rivals)))
        except DivergenceError:  # of the changed law, or of a rival's
            each.append((n.candidate, None))
    figures: list[tuple[str, Figure]] = []
    drawn = any(of is not None for _, of in each)
    said = [HOW + RECOVERED[found.judged_by]] if drawn else []
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
    return [Section(LAWS, "\n\n".join(said), figures=tuple(figures), first=1)]


SURE = 1.96  # std on each side of 95 %
RIVALS = 2  # that are drawn, the likeliest
SMALL = 0.5  # a force that stays below it is told in thousandths
NARROW = 0.4  # share of the range, below which a law's bends have a panel
DASHES = ((0, (5, 2)), (0, (1.5, 1.5)))
FOLLOWS = {
    "rate": "rate", "position": "position", "phase": "angle within one period", "time": "time",
    "drive": "force of the drive", "reading": "reading of the sensor",
}  # fmt: skip


@styled
def law_figure(of: RecoveredForce) -> Figure:
    """Returns a figure of recovered points with bars, the law with its band, and up to two rivals.

    A law that changes in a small part of the range has a second panel of that part.
    """
    x_unit, unit = of.units
    if "reading" in of.candidate.effect.hooks:
        what = "error of the sensor"
    else:
        what = f"missing {'torque' if unit == 'N m' else 'force'}"
        what += ", against the motion" if of.resists else ""
    top = max(np.abs(of.law.force).max(), np.abs(of.points.force).max(initial=0.0))
    factor, said = (1e3, f"m{unit}") if top < SMALL and unit else (1.0, unit)
    near, follows = _bends(of), FOLLOWS.get(of.along)
    follows = follows or f"what the law multiplies by {of.candidate.effect.sizes[0].name}"
    figure = Figure((7.0, 6.4 if near else 3.8), layout="constrained")
    panels = figure.subplots(2 if near else 1, 1, squeeze=False)[:, 0]
    for ax in panels:
        _draw(ax, of, factor)
        ax.set_xlabel(literal(follows + (f" [{x_unit}]" if x_unit else "")))
        ax.set_ylabel(literal(what + (f" [{said}]" if said else "")))
    if near:
        panels[0].set_title("all of it", loc="left", color=INK)
        panels[1].set_title("where it bends", loc="left", color=INK)
        panels[1].set_xlim(*near)
    figure.legend(
        *panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=2, fontsize=8
    )
    return figure


def _draw(ax: Axes, of: RecoveredForce, factor: float) -> None:
    for (candidate, line), dash in zip(of.rivals[:RIVALS], DASHES, strict=False):
        x, f, _ = _drawn(line, of)
        label = literal(f"rival: {describe_effect(candidate)}")
        ax.plot(x, factor * f, color=SERIES[1], lw=1.2, ls=dash, label=label)
    x, f, std = _drawn(of.law, of)
    low, high = factor * (f - SURE * std), factor * (f + SURE * std)
    label = "95 % band of the named law"
    ax.fill_between(x, low, high, color=MEASURED, alpha=0.3, lw=0, label=label)
    ax.plot(x, factor * f, color=MEASURED, lw=1.5, label="the law that is named")
    p = of.points
    ax.errorbar(
        p.x, factor * p.force, factor * SURE * p.std, color=INK, fmt="o", ms=3.5, lw=1, capsize=2,
        label="recovered from the data",
    )  # fmt: skip
    ax.axhline(0, color=GREY, lw=0.6)


def _bends(of: RecoveredForce) -> tuple[float, float] | None:
    """Returns the part of the range where a law changes, with room; None where that is most."""
    x, f, _ = _drawn(of.law, of)
    change = np.nan_to_num(np.abs(np.diff(f)))
    total = np.concatenate([[0.0], np.cumsum(change)])
    first, last = np.interp(np.array([0.01, 0.99]) * total[-1], total, np.nan_to_num(x))
    room = 0.4 * (last - first)
    part = (float(first - room), float(last + room))
    return part if part[1] - part[0] < NARROW * (x[-1] - x[0]) else None


def _drawn(line: LawLine, of: RecoveredForce) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Returns a line, cut where the motion turns and a friction jumps."""
    cut = int(np.searchsorted(line.x, 0.0))
    parts = (line.x, line.force, line.std)
    if of.along != "rate" or not 0 < cut < len(line.x):
        return parts
    return tuple(np.insert(part, cut, np.nan) for part in parts)  # type: ignore[return-value]
