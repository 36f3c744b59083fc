"""Sections of a report with figures: the gap, where the models fail, and all candidates."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from identification.discovery.attempts import Failed
from identification.discovery.result import Discovery, Scored
from identification.estimation.metrics import of_outputs
from identification.quantities import held
from identification.report.discovery_figures import (
    GAIN,
    force_figure,
    gains_figure,
    gap_figure,
    rms_figure,
)
from identification.report.effect_words import describe_effect, describe_rejected, describe_there
from identification.report.error_words import error_words
from identification.report.finding_words import describe_finding, sentence
from identification.report.page import Section, Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

BEST = 10  # candidates shown
FAILED = "tried, and not possible to simulate"
MANY = 8  # lines on what failed; of more the count is told
MEASURES = {  # of a score: what its bars are, their axis, and the title of the figure
    "gain": (
        "What each effect, at its best place and shape, would explain of the fitted nominal model's"
        " residual, the model's parameters tuned again. The bars are the gains that the nominal fit"
        " promises before an effect is fitted; a gain that is said in words is that of the refitted"
        " model, so that the two differ.",
        GAIN,
        "Gain of the best candidates on the nominal fit",
    ),
    "fall": (
        "Share of the fitted error that each effect would explain at its best place and shape.",
        "share of the mean square of the fitted error",
        "Share of the fitted error",
    ),
}


def gap_section(found: Discovery) -> Section:
    """Returns the section on the gap on unseen samples, before and after."""
    run, names, units = found.run, [*found.outputs], [*found.outputs.values()]
    said = "Rms error of predictions on data that no fit has seen."
    figures: tuple[tuple[str, Figure], ...] = ()
    if run is not None:
        said = (
            "Measured minus simulated, from the inputs alone, over samples that no fit has seen."
            " The grey band is what the sensors, and disturbances that were not logged, do to a"
            " model that lacks nothing."
        )
        rows, after = run.unseen, run.after[run.unseen] if found.named else None
        figure = gap_figure(
            run.log.time[rows], run.before[rows], after, 2 * of_outputs(found.floor, run.log),
            names, units,
        )  # fmt: skip
        figures = (("Error on unseen data, before and after", figure),)
    gaps = [("nominal model, fitted", found.before)]
    if found.named:
        gaps.append(("with what was missing", found.after))
    rms = error_words([found.errors_of(gap) for _, gap in gaps], "")
    fits = [g.fit_percent[np.isfinite(g.fit_percent)] for _, g in gaps]
    table = Table(
        ("model", "rms", "times the noise", "mean fit [%]"),
        tuple(
            (name, size, _ratio(found.times_noise(gap)), float(fit.mean()) if len(fit) else None)
            for (name, gap), size, fit in zip(gaps, rms, fits, strict=True)
        ),
    )
    return Section("The gap on unseen data", said, first=True, figures=figures, table=table)


def where_section(found: Discovery) -> list[Section]:
    """Returns the section on where the models fail; none over a horizon."""
    run = found.run
    if run is None:
        return []
    before, after = (_rms(e[run.unseen]) for e in (run.before, run.after))
    noise, unit = of_outputs(found.floor, run.log), found.unit
    scale, level = np.ones(len(noise)), float(noise.max())
    if len({*found.outputs.values()}) > 1 and noise.min() > 0:  # unlike outputs have no one axis
        scale, level, unit = noise, 1.0, "times the noise"
    figure = rms_figure(
        before / scale, after / scale if found.named else None, level, [*found.outputs], unit
    )
    forces = tuple(
        (f"Force on {m.where} that the nominal model lacks",
         force_figure(run.log.time[: len(m.force)], m.force, m.names, m.units))
        for m in found.missing_forces
    )  # fmt: skip
    parts = [" ".join(sentence(describe_finding(f)) for f in found.located)]
    if found.findings:
        title = "With what is named" if found.named else "What is left"
        parts.append(f"{title}: {'; '.join(map(describe_finding, found.findings))}.")
    figures = (("Error by output on unseen data", figure), *forces)
    return [Section("Where it disagrees", "\n\n".join(parts), figures=figures)]


def best_scores(found: Discovery) -> list[Scored]:
    """Returns the best score of each effect: its best place and shape."""
    each: dict[str, Scored] = {}
    for score in found.scores:
        each.setdefault(score.candidate.effect.name, score)
    return [*each.values()]


def describe_score(found: Discovery, score: Scored) -> str:
    """Returns in words what a candidate would explain, before it is fitted."""
    value = f"gain {score.explains:z.3g}"
    if found.scored_by == "fall":
        value = f"{100 * score.explains:z.0f} % of the fitted error"
    effect = describe_there(score.candidate, found.final.plant)
    return f"{effect}: {value}, chance {score.p_value:.2g}"


def rivals_section(found: Discovery) -> Section:
    """Returns the section on all candidates: what each would explain, and rivals of the named."""
    best, (text, axis, caption) = best_scores(found)[:BEST], MEASURES[found.scored_by]
    named = {n.candidate.effect.name for n in found.named}
    # What the data cannot tell from a named effect is named with it.
    named |= {r.candidate.effect.name for n in found.named if n.one_of for r in n.rivals[:1]}
    figures: tuple[tuple[str, Figure], ...] = ()
    if best:
        figure = gains_figure(
            [describe_effect(s.candidate) for s in best], np.array([s.explains for s in best]),
            [s.candidate.effect.name in named for s in best], axis,
        )  # fmt: skip
        figures = ((caption, figure),)
    rows = tuple(
        (
            describe_effect(r.candidate),
            f"{100 * r.confidence:.0f} %",
            describe_effect(n.candidate),
            r.alike,
        )
        for n in found.named
        for r in n.rivals
    )
    if not rows and found.named:
        text += "\n\nNo other explanation comes near those that are named."
    title, lines = describe_rejected(found)
    if lines:
        text = "\n\n".join([text, f"{title.capitalize()}:", *map(sentence, lines)])
    if failed := failed_lines(found.failed):
        text = "\n\n".join([text, f"{FAILED.capitalize()}:", *failed])
    table = Table(("rival", "confidence", "named", "alike"), rows) if rows else None
    return Section("Who could explain it", text, figures=figures, table=table)


def failed_lines(failed: Sequence[Failed]) -> list[str]:
    """Returns a line for each candidate that failed, and one for those that are left out."""
    lines = []
    for one in failed[:MANY]:
        place = f", {one.where}" if one.where else ""
        lines.append(f"{one.name.replace('_', ' ')}{place}: {one.outcome}")
    more = len(failed) - len(lines)
    return [*lines, f"and {more} more"] if more > 0 else lines


def _rms(e: np.ndarray) -> np.ndarray:
    return np.asarray(np.sqrt(np.mean(e**2, axis=0)))


def _ratio(ratio: float) -> str | None:
    return held(ratio) if np.isfinite(ratio) else None
