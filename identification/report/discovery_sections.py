"""Sections of a report with figures: the gap, where the models fail, and all candidates."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from identification.discovery.result import Discovery
from identification.discovery.scoring.scores import Score
from identification.logs.by_unit import of_outputs
from identification.logs.log import halves
from identification.quantities import held
from identification.report.discovery_errors import errors_of, floor, times_noise
from identification.report.discovery_figures import (
    force_figure,
    gains_figure,
    gap_figure,
    rms_figure,
)
from identification.report.effect_words import describe_effect, describe_rejected
from identification.report.error_words import error_words
from identification.report.finding_words import describe_finding, sentence
from identification.report.page import Section, Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

BEST = 10  # candidates shown


def unseen_rows(found: Discovery) -> np.ndarray:
    """Returns a mask of samples that the fit has not seen, (N,); of all where it has seen all."""
    splits = found.log.splits or halves(found.log)
    start, end = splits["estimation"]
    unseen = (found.log.time < start) | (found.log.time >= end)
    return unseen if unseen.any() else ~unseen


def gap_section(found: Discovery) -> Section:
    """Returns the section on the gap on unseen samples, before and after."""
    rows, log = unseen_rows(found), found.log
    before, after = _errors(found)
    figure = gap_figure(
        log.time[rows], before[rows], None if after is None else after[rows],
        2 * of_outputs(floor(found), log), log.output_names, _units(found),
    )  # fmt: skip
    gaps = [("nominal model, fitted", found.before)]
    if after is not None:
        gaps.append(("with what was missing", found.after))
    each = [errors_of(gap, found) for _, gap in gaps]
    rms = error_words(each, "")
    fits = [g.fit_percent[np.isfinite(g.fit_percent)] for _, g in gaps]
    return Section(
        "The gap on unseen data",
        "Measured minus simulated, from the inputs alone, over samples that no fit has seen. The"
        " grey band is what the sensors, and disturbances that were not logged, do to a model that"
        " lacks nothing.",
        first=True,
        figures=(("Error on unseen data, before and after", figure),),
        table=Table(
            ("model", "rms", "times the noise", "mean fit [%]"),
            tuple(
                (name, size, _ratio(times_noise(gap, found)),
                 float(fit.mean()) if len(fit) else None)
                for (name, gap), size, fit in zip(gaps, rms, fits, strict=True)
            ),
        ),
    )  # fmt: skip


def where_section(found: Discovery) -> Section:
    """Returns the section on where the nominal model fails, and where the final one still does."""
    rows = unseen_rows(found)
    before, after = _errors(found)
    title = "With what is named" if found.named else "What is left"
    left = [f"{title}: {'; '.join(map(describe_finding, found.findings))}."]
    noise, unit = of_outputs(floor(found), found.log), found.log.output_unit
    scale, level = np.ones(len(noise)), float(noise.max())
    if len(set(_units(found))) > 1 and noise.min() > 0:  # bars of unlike outputs have no one axis
        scale, level, unit = noise, 1.0, "times the noise"
    figure = rms_figure(
        _rms(before[rows]) / scale, None if after is None else _rms(after[rows]) / scale, level,
        found.log.output_names, unit,
    )  # fmt: skip
    forces = tuple(
        (f"Force on {m.where} that the nominal model lacks",
         force_figure(found.log.time[: len(m.force)], m.force, m.names, m.units))
        for m in found.missing_forces
    )  # fmt: skip
    located = " ".join(sentence(describe_finding(f)) for f in found.located)
    return Section(
        "Where it disagrees",
        "\n\n".join([located, *(left if found.findings else [])]),
        figures=(("Error by output on unseen data", figure), *forces),
    )


def rivals_section(found: Discovery) -> Section:
    """Returns the section on all candidates: what each would explain, and rivals of the named."""
    each: dict[str, Score] = {}  # the best place and shape of every effect
    for score in found.scores:
        each.setdefault(score.candidate.effect.name, score)
    best = [*each.values()][:BEST]
    named = {n.candidate.effect.name for n in found.named}
    # What the log cannot tell from a named effect is named with it.
    named |= {r.candidate.effect.name for n in found.named if n.one_of for r in n.rivals[:1]}
    figures: tuple[tuple[str, Figure], ...] = ()
    if best:
        figure = gains_figure(
            [describe_effect(s.candidate) for s in best],
            np.array([s.gain for s in best]),
            [s.candidate.effect.name in named for s in best],
        )
        figures = (("Gain of the best candidates on the nominal fit", figure),)
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
    text = (
        "What each effect, at its best place and shape, would explain of the fitted nominal model's"
        " residual, the model's parameters tuned again. The bars are the gains that the nominal fit"
        " promises before an effect is fitted; a gain that is said in words is that of the refitted"
        " model, so that the two differ."
    )
    if not rows and found.named:
        text += "\n\nNo other explanation comes near those that are named."
    title, lines = describe_rejected(found)
    if lines:
        text += f"\n\n{title.capitalize()}: {' '.join(map(sentence, lines))}"
    return Section(
        "Who could explain it",
        text,
        figures=figures,
        table=Table(("rival", "confidence", "named", "alike"), rows) if rows else None,
    )


def _errors(found: Discovery) -> tuple[np.ndarray, np.ndarray | None]:
    y = found.log.outputs
    return y - found.predicted_before, y - found.predicted_after if found.named else None


def _rms(e: np.ndarray) -> np.ndarray:
    return np.asarray(np.sqrt(np.mean(e**2, axis=0)))


def _units(found: Discovery) -> list[str]:
    """Returns the unit of each output; "" where it has none."""
    return [found.log.units.get(name, "") for name in found.log.output_names]


def _ratio(ratio: float) -> str | None:
    return held(ratio) if np.isfinite(ratio) else None
