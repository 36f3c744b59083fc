"""The section on where a model fails over a horizon, with figures over time and by force."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter

from identification.discovery.result import Discovery
from identification.quantities import alike, held
from identification.report.discovery.effect_sections import listed_below
from identification.report.discovery.finding_words import sentence
from identification.report.discovery.horizon_gap import (
    FailedWindow,
    OutputError,
    RecordWindows,
    find_gap,
    worst_lines,
)
from identification.report.discovery.missing_place import MissingPlace, find_place, force_line
from identification.report.discovery.needed_forces import SURE, NeededForce, NeededForces
from identification.report.page.page import Section, Table
from identification.report.page.style import GREY, INK, MEASURED, SERIES, SIMULATED, literal, styled
from identification.report.words.errors import listed
from identification.report.words.parts import unseen_of
from identification.shares import percent, times_noise

if TYPE_CHECKING:
    from identification.report.page.page import Figures

TITLE = "Where it disagrees"
NEEDED = "The force that is missing, by joint"
WORST = "The fitted windows in which the error of the final model is largest"
GROWTH = (
    "A constant force that is missing makes about four times the error over twice the time; noise"
    " of the sensors makes the same error over any time."
)
FORCES = (
    "The force is what would have to act on that joint in place of every other cause, without what"
    " the free parameters can imitate: a first estimate, linear about the fitted values, with a"
    " band of 95 % for the noise alone. A peak that is narrower than the place that is told is"
    " higher than the force that is told."
)
NO_FORCE = (
    "No force that follows the position, the speed, the drive or the time at one joint would"
    " explain more of it than luck."
)
TRY = (
    "What may help: a shorter horizon, if the force is large and short; a record with slow motion"
    " over the same range; or an effect of your own (docs/your_effect.md)."
)


def horizon_sections(found: Discovery) -> list[Section]:
    """Returns the sections on where the models of a discovery fail, and on the force they lack.

    There are none along a free run. Where nothing is named, the force is the answer, and its figure
    stands above the verdict.
    """
    gap = find_gap(found)
    if gap is None:
        return []
    where = f"where {'the model with what is named' if found.named else 'the fitted model'} fails"
    if found.verdict == "nothing missing":
        where = "where the errors of the fitted model are"
    lines, of = [], unseen_of(found)
    for o in gap.outputs:
        size, noise = alike([o.after, o.noise], o.unit, 3)
        said = f"the error of {o.name} on unseen data{of} is {size} rms"
        if o.noise > 0:
            of_sensor = f"its sensor's noise of {noise}"
            said += f", {times_noise(o.after / o.noise, of_sensor)}"
        lines.append(said)
    rest = worst_lines(gap) if gap.is_far else []
    if len(gap.lengths) > 1:
        over = listed([f"{n.length:g} s" for n in gap.lengths])
        ratios = listed([held(n.after) for n in gap.lengths])
        rest.append(f"over {over} the error on unseen data{of} is {ratios} times the noise")
    forces = gap.needed.forces
    text = [f"{' '.join(map(sentence, rest))} {GROWTH}"]
    plain = [listed_below(where, [*lines, *rest, *map(force_line, forces)])]
    if gap.is_far and not forces:
        doubt = doubtful_sentences(gap.needed, found)
        text += doubt
        plain += doubt
    is_drawn = gap.is_far and bool(gap.windows)
    figures = cache(lambda: ((WORST, worst_windows(gap.windows)),)) if is_drawn else ()
    table = _table(gap.outputs, bool(found.named))
    sections = [Section(TITLE, "\n\n".join(text), figures, table, plain="\n".join(plain))]
    if forces:
        is_answer = found.verdict == "unknown effect"
        needed = [f"{' '.join(sentence(force_line(f)) for f in forces)} {FORCES}"]
        needed += [TRY] if is_answer else []
        drawn = cache(lambda: ((NEEDED, forces_figure(forces, find_place(found))),))
        sections.append(Section(NEEDED, "\n\n".join(needed), figures=drawn, first=int(is_answer)))
    return sections


def doubtful_sentences(needed: NeededForces, found: Discovery) -> list[str]:
    """Returns which of the forces that were tried would explain most, where none is missing."""
    most, asked = needed.doubtful, found.options.significance
    if most is None:
        return [NO_FORCE] if needed.is_asked else []
    which = f"one on {most.nodes.joint} that depends on the {most.nodes.reads}"
    doubt = f"That is no more than the {percent(found.options.min_fall)} which is asked for."
    if not most.known.any():
        doubt = "The motion tells its size nowhere."
    elif not most.chance < asked:
        doubt = (
            f"This may be luck: one of the {needed.tried} candidates that were tried explains as"
            f" much by luck with a chance of {percent(most.chance, 2)}, and {percent(asked)} is the"
            " most that counts as proof."
        )
    return [
        f"The force that would explain most is {which}: {percent(most.fall)} of the fitted"
        f" error. {doubt}"
    ]


def error_figures(found: Discovery) -> Figures:
    """Returns the figure of the error of each window over time; none along a free run."""
    gap = find_gap(found)
    if gap is None:
        return ()
    over = f"Error of each window of {found.horizon:g} s"
    return ((over, windows_over_time(gap.records, bool(found.named))),)


def _table(outputs: Sequence[OutputError], is_named: bool) -> Table:
    """Returns the errors of the outputs; of the final model too, where it has effects."""
    rows = []
    for o in outputs:
        before, after, noise = alike([o.before, o.after, o.noise], o.unit, 3)
        times = float(held(o.after / o.noise)) if o.noise > 0 else None
        rows.append((o.name, before, *([after] if is_named else []), noise, times))
    final = ("with what was missing",) if is_named else ()
    head = ("output", "nominal model, fitted", *final, "noise", "times the noise")
    return Table(head, tuple(rows))


WIDTH, PANEL = 7.0, 1.7  # [in] of a figure, and the height of a panel
PANEL_OF_FORCE, PANEL_ALONE = 2.1, 3.0  # [in] likewise; of the force on one joint alone
FAR = 10.0  # errors that differ by more are drawn on a logarithmic axis


@styled
def windows_over_time(records: Sequence[RecordWindows], is_named: bool) -> Figure:
    """Returns a figure of the error of each window over time, one panel a record.

    Both models are drawn where the final one has named effects.
    """
    columns = 2 if len(records) > 2 else 1
    rows = -(-len(records) // columns)
    figure = Figure((WIDTH, 0.6 + PANEL * rows), layout="constrained")
    panels = [*figure.subplots(rows, columns, squeeze=False).T.ravel()]
    for ax in panels[len(records) :]:
        ax.set_axis_off()
    panels = panels[: len(records)]
    every = np.concatenate([e for r in records for e in (r.before, r.after)])
    known = every[np.isfinite(every) & (every > 0)]
    is_far = bool(len(known)) and known.max() > FAR * known.min()
    for ax, r in zip(panels, records, strict=True):
        label, colour = "nominal model, fitted", SIMULATED
        if is_named:
            ax.plot(r.time, r.before, ".", ms=4, color=colour, label=label)
            label, colour = "with what was missing", MEASURED
        ax.plot(r.time, r.after, ".", ms=4, color=colour, label=label)
        ax.axhline(1.0, color=INK, ls="--", lw=1, label="noise of the sensors")
        ax.set_title(literal(f"{r.name} ({r.role})"), loc="left", color=INK)
        if is_far:
            ax.set_yscale("log")
            ax.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
            ax.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
            ax.yaxis.set_minor_formatter(NullFormatter())
        else:
            ax.set_ylim(bottom=0.0)
    figure.supylabel("error of a window, times the noise", fontsize=9, color=INK)
    for ax in {panels[rows - 1], panels[-1]}:  # the lowest of each column
        ax.set_xlabel("begin of the window [s]")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
    return figure


@styled
def worst_windows(windows: Sequence[FailedWindow]) -> Figure:
    """Returns a figure of measured and predicted motion in some windows, a panel each."""
    figure, axes = _panels(len(windows))
    for ax, w in zip(axes, windows, strict=True):
        ax.plot(w.time, w.measured, ".", ms=3, color=MEASURED, label="measured")
        ax.plot(w.time, w.predicted, color=SIMULATED, lw=1.2, label="predicted by the final model")
        ax.set_title(
            literal(f"{w.record}: {w.output}, {held(w.ratio)} × noise"), loc="left", color=INK
        )
        ax.set_ylabel(literal(f"[{w.unit}]") if w.unit else "")
        ax.set_xlabel("time [s]")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=2)
    return figure


@styled
def forces_figure(forces: Sequence[NeededForce], place: MissingPlace | None) -> Figure:
    """Returns a figure of the force that each joint would need, over what it follows.

    The place that is told stands out.
    """
    figure, axes = _panels(len(forces), PANEL_ALONE if len(forces) == 1 else PANEL_OF_FORCE)
    for ax, needed in zip(axes, forces, strict=True):
        known, at = needed.known, needed.nodes.at
        for way, force in enumerate(needed.force):
            f, band = (np.where(known[way], x, np.nan) for x in (force, SURE * needed.std[way]))
            label = ("rising", "falling")[way] if len(needed.force) > 1 else None
            ax.fill_between(at, f - band, f + band, color=SERIES[way], alpha=0.25, lw=0)
            ax.plot(at, f, ".-", ms=4, lw=1.2, color=SERIES[way], label=label)
        if place is not None and needed is forces[0]:
            ax.axvspan(place.low, place.high, color=GREY, alpha=0.2, lw=0)
        ax.axhline(0, color=GREY, lw=0.6)
        ax.set_title(literal(f"joint {needed.nodes.joint}"), loc="left", color=INK)
        ax.set_xlabel(literal(f"{needed.nodes.reads} [{needed.nodes.unit}]"))
        ax.set_ylabel(literal(f"force [{needed.unit}]"))
    apart = [ax for ax, needed in zip(axes, forces, strict=True) if len(needed.force) > 1]
    if apart:
        handles = apart[0].get_legend_handles_labels()
        figure.legend(*handles, loc="outside upper center", ncols=2)
    return figure


def _panels(count: int, height: float = 2.1) -> tuple[Figure, list[Axes]]:
    """Returns a figure with so many panels of a height [in], in up to two columns."""
    rows = -(-count // 2)
    figure = Figure((WIDTH, 0.6 + height * rows), layout="constrained")
    axes = [*figure.subplots(rows, min(2, count), squeeze=False).ravel()]
    for ax in axes[count:]:
        ax.set_axis_off()
    return figure, axes[:count]
