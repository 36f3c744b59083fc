"""What the report of a discovery says, section by section."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from identification.discovery.result import Discovery
from identification.discovery.score import Score
from identification.log import halves
from identification.quantities import quantity
from identification.verdict_discovery import (
    floor_rms,
    output_unit,
    phrase,
    sentence,
    split_detectable,
)
from inca_mj.discovery_model import final_values, std_of
from inca_mj.figures_discovery import gains_figure, gap_figure, rms_figure
from inca_mj.report import Section, Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from identification.discovery.result import Detectable

BEST = 10  # candidates shown


def unseen_rows(found: Discovery) -> np.ndarray:
    """Which samples the fit has not seen; all, where it has seen all."""
    splits = found.log.splits or halves(found.log)
    start, end = splits["estimation"]
    unseen = (found.log.time < start) | (found.log.time >= end)
    return unseen if unseen.any() else ~unseen


def gap_section(found: Discovery) -> Section:
    """How the gap shrinks on data that the fit has not seen."""
    unit, rows = output_unit(found), unseen_rows(found)
    log, before, after = found.log, *_errors(found)
    figure = gap_figure(
        log.time[rows], before[rows], None if after is None else after[rows],
        2 * floor_rms(found), log.output_names, unit,
    )  # fmt: skip
    gaps = [("nominal model, fitted", found.before)]
    if after is not None:
        gaps.append(("with what was missing", found.after))
    fits = [g.fit_percent[np.isfinite(g.fit_percent)] for _, g in gaps]
    return Section(
        "The gap on unseen data",
        "Measured minus simulated, from the currents alone, over samples that no fit has seen. The"
        " grey band is what the sensors, and disturbances that were not logged, do to a model that"
        " lacks nothing.",
        figures=(("Error on unseen data, before and after", figure),),
        table=Table(
            ("model", f"rms [{unit}]" if unit else "rms", "times the noise", "mean fit [%]"),
            tuple(
                (name, gap.rms, _ratio(gap.rms, floor_rms(found)),
                 float(fit.mean()) if len(fit) else None)
                for (name, gap), fit in zip(gaps, fits, strict=True)
            ),
        ),
    )  # fmt: skip


def where_section(found: Discovery) -> Section:
    """Where the nominal model fails, and where the final one still does."""
    rows, unit = unseen_rows(found), output_unit(found)
    before, after = _errors(found)
    left = [f"With what is named: {'; '.join(found.left)}."] if found.left else []
    figure = rms_figure(
        _rms(before[rows]), None if after is None else _rms(after[rows]), floor_rms(found),
        found.log.output_names, unit,
    )  # fmt: skip
    return Section(
        "Where it disagrees",
        "\n\n".join([" ".join(map(sentence, found.located)), *left]),
        figures=(("Error by output on unseen data", figure),),
    )


def rivals_section(found: Discovery) -> Section:
    """Who could explain the gap, and how well."""
    each: dict[str, Score] = {}  # the best place and shape of every effect
    for score in found.scores:
        each.setdefault(score.candidate.effect.name, score)
    best = [*each.values()][:BEST]
    named = {n.candidate.effect.name for n in found.named}
    figures: tuple[tuple[str, Figure], ...] = ()
    if best:
        figure = gains_figure(
            [label(s) for s in best],
            np.array([s.gain for s in best]),
            [s.candidate.effect.name in named for s in best],
        )
        figures = (("Gain of the best candidates on the nominal fit", figure),)
    rows = tuple(
        (phrase(n.candidate), phrase(r.candidate), f"{100 * r.confidence:.0f} %", r.alike)
        for n in found.named
        for r in n.rivals
    )
    text = (
        "What each effect, at its best place and shape, would explain of the fitted nominal model's"
        " residual, the model's parameters tuned again."
    )
    if not rows and found.named:
        text += "\n\nNo other explanation comes near those that are named."
    return Section(
        "Who could explain it",
        text,
        figures=figures,
        table=Table(("named", "rival", "confidence", "alike"), rows) if rows else None,
    )


def diff_section(found: Discovery) -> Section:
    """What was added to the model, as laws and numbers."""
    if not found.named:
        return Section("What was added", "Nothing: the model is the nominal one, fitted.")
    rows = []
    for named in found.named:
        c = named.candidate
        for k, (name, (value, std, unit)) in enumerate(named.parameters.items()):
            rows.append(
                (f"+ {phrase(c)}" if k == 0 else "", c.effect.law if k == 0 else "", name,
                 quantity(value, std, unit), f"{100 * named.confidence:.0f} %" if k == 0 else "")
            )  # fmt: skip
    return Section(
        "What was added",
        "The model with it is in model.xml and effects.json; inca_mj.load_twin reads them.",
        table=Table(("effect", "law", "parameter", "value", "confidence"), tuple(rows)),
    )


def parameters_section(found: Discovery) -> Section:
    """Nominal values beside those of the first fit and of the last."""
    plant = found.final.at.predictor.plant
    first, last = std_of(found.nominal), std_of(found.final)
    nominal, values = found.nominal.at.values, final_values(found)
    rows = []
    for p in plant.parameters:
        if p.name not in last and p.name not in first:
            continue
        rows.append(
            (
                p.name,
                "–" if p.where == "effect" else quantity(p.value, unit=p.unit),
                _value(nominal.get(p.name), first.get(p.name), p.unit),
                _value(values[p.name], last.get(p.name), p.unit),
            )
        )
    return Section(
        "The parameters",
        "A std holds for the model as it is: that of a wrong model is too small.",
        table=Table(
            ("parameter", "nominal", "fitted without effects", "fitted with what is named"),
            tuple(rows),
        ),
    )


def unseen_section(found: Discovery) -> Section:
    """What this log could have shown, and what not."""
    seen, blind = split_detectable(found.detectable)
    rows = [(phrase(d.candidate), d.size, quantity(d.smallest, unit=d.unit), _plausible(d))
            for d in seen]  # fmt: skip
    rows += [(phrase(d.candidate), d.size, "not by this log", _plausible(d)) for d in blind]
    return Section(
        "What it could have seen",
        "The smallest size of each effect that is found in 9 of 10 logs like this one, beside the"
        " largest that is plausible. What is missing and smaller stays hidden."
        if rows
        else "Not computed for this log.",
        table=Table(("effect", "size", "smallest seen", "largest plausible"), tuple(rows))
        if rows
        else None,
    )


def label(score: Score) -> str:
    """A candidate's name, place and shapes, short."""
    c = score.candidate
    where = "" if c.where.startswith("all ") or c.where == "platform" else f" ({c.where})"
    shape = ", ".join(f"{n} = {v:.3g}" for n, v in c.shape.items())
    return c.effect.name.replace("_", " ") + where + (f", {shape}" if shape else "")


def _value(value: float | None, std: float | None, unit: str) -> str:
    return "–" if value is None or std is None else quantity(value, std, unit)


def _plausible(d: Detectable) -> str:
    size = next((s for s in d.candidate.effect.sizes if s.name == d.size), None)
    return "–" if size is None else quantity(size.largest, unit=size.unit)


def _errors(found: Discovery) -> tuple[np.ndarray, np.ndarray | None]:
    y = found.log.outputs
    return y - found.predicted_before, y - found.predicted_after if found.named else None


def _rms(e: np.ndarray) -> np.ndarray:
    return np.asarray(np.sqrt(np.mean(e**2, axis=0)))


def _ratio(rms: float, floor: float) -> float | None:
    return rms / floor if floor > 0 else None
