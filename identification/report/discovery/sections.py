"""The sections of a discovery: each has its sentences, table, figures and lines for a terminal.

Those on effects stand in `effect_sections`, those on recovered forces in `law`.
"""

from __future__ import annotations

from functools import cache, partial
from math import isfinite, isnan

import numpy as np

from identification.discovery.result import Discovery
from identification.prediction.verdict.clocks import shown_shifts
from identification.quantities import held
from identification.report.discovery.effect_sections import listed_below
from identification.report.discovery.figures import gap_figures, where_figures
from identification.report.discovery.finding_words import describe_finding, describe_shift, sentence
from identification.report.discovery.horizon_section import error_figures
from identification.report.fit.fitted_values import (
    std_sentence,
    step_sentences,
    value_lines,
    value_table,
)
from identification.report.page.page import Section, Table
from identification.report.words.errors import error_words
from identification.report.words.parts import parts_sentence, unseen_of
from identification.report.words.proof import is_at_noise
from identification.report.words.values import departures_found, gathered, words_of
from identification.shares import decimal, fall_words, times_estimated, times_noise
from identification.windows.coarse import steps_of

DIGITS = 3  # of errors of records
FIT_DIGITS = 4  # of a fit [%]: 99.96
FITTED = "all of it was fitted"
LATER = (
    "Inputs that seem to act earlier may also be the answer of a controller to what the robot did."
)
SHIFTS = (
    "records whose inputs seem to act later or earlier than their time stamps say, by as much in"
    " both halves of the record"
)
GAPS = {  # by what errors are of: what the gap on unseen data is
    "free run": "Measured minus simulated, from the inputs alone, over samples that no fit has"
    " seen. The grey band is what the sensors, and disturbances that were not logged, do to a model"
    " that lacks nothing.",
    "windows": "Rms error of predictions on data that no fit has seen.",
}
RECORDS = {  # likewise: the errors of records, on a page and in a terminal
    "free run": (
        "Rms error of free runs over the unseen samples of each record on which errors are told.",
        "unseen samples of each record",
    ),
    "windows": (
        "Rms error over windows of {:g} s, each from the state that explains it best. Nothing was"
        " fitted to the records that confirm.",
        "error of prediction over {:g} s",
    ),
}
STD = {  # likewise: what a std rests on
    "free run": "A std holds if the model is right; that of a wrong model is too small.",
    "windows": "Std from blocks of windows, whose errors need not be white; unknown if too few"
    " windows depend on a value.",
}


def gap_section(found: Discovery) -> Section:
    """Returns the section on the gap on unseen samples, before and after."""
    run = found.run
    told = [("before", "nominal model, fitted", found.before),
            ("after", "with what was missing", found.after)]  # fmt: skip
    errors = [found.errors_of(gap) for *_, gap in told]
    sizes, rows, lines = error_words(errors, ""), [], []
    # What is named has shown that an error as small as the noise is not noise alone.
    is_named = bool(found.named) and is_at_noise(found, found.before)
    beside_noise = times_estimated if is_named else times_noise
    for (when, model, gap), size, rms in zip(told, sizes, error_words(errors), strict=True):
        ratio, fit = found.times_noise(gap), gap.fit_percent[np.isfinite(gap.fit_percent)]
        times = held(ratio) if isfinite(ratio) else None
        rows.append((model, size, times, decimal(fit.mean(), FIT_DIGITS) if len(fit) else None))
        lines.append(f"  {when:<7}{rms}" + (f", {beside_noise(ratio)}" if times else ""))
    title, said = f"error on unseen data{unseen_of(found)}:", parts_sentence(found)
    return Section(
        "The gap on unseen data",
        f"{GAPS[found.judged_by]} {said}",
        first=3,
        figures=cache(partial(gap_figures, found, run) if run else partial(error_figures, found)),
        table=Table(
            ("model", "rms", "times the noise", "mean fit [%]"),
            tuple(rows if found.named else rows[:1]),
        ),
        plain="\n".join([title, *lines] if found.named else [title + lines[0][8:]]) + f"\n{said}",
    )


def records_section(found: Discovery) -> list[Section]:
    """Returns the section on the errors of each record; none where no record is told apart."""
    if not found.is_told_by_record:
        return []
    seen = [e for e in found.errors if not isnan(e.before)]
    each = [errors for e in seen for errors in (e.before_by_unit, e.after_by_unit)]
    told = error_words(each, "", DIGITS) if seen else []
    words = dict(zip(map(id, seen), zip(told[::2], told[1::2], strict=True), strict=True))
    rows = [(e.name, *words.get(id(e), (FITTED, "")), e.role) for e in found.errors]
    said, over = (text.format(found.horizon) for text in RECORDS[found.judged_by])
    lines = [f"{over}, {'without and with what is named' if found.named else 'nothing is named'}:"]
    for error, (name, before, after, role) in zip(found.errors, rows, strict=True):
        is_told = bool(found.named) and before != FITTED
        worse = "; it is predicted worse" if is_told and error.after > error.before else ""
        lines.append(f"  {name} ({role}): {before}{f' -> {after}' if is_told else ''}{worse}")
    table = Table(("record", "nominal model", "final model", "role"), tuple(rows))
    if not found.named:
        alone = tuple((name, before, role) for name, before, _, role in rows)
        table = Table(("record", "error", "role"), alone)
    text = " ".join([said, *steps_taken(found)])
    return [Section("Error by record", text, table=table, plain="\n".join(lines))]


def steps_taken(found: Discovery) -> list[str]:
    """Returns sentences on the steps of simulations, on finer ones, and on passes left out."""
    steps, without = steps_of(found.nominal.plant), ", ".join(found.options.without)
    left_out = [f"The options left out these passes of the search: {without}."] if without else []
    said = step_sentences(found.final, words_of(found), steps)
    return [*said, *departures_found(found), *left_out]


def where_section(found: Discovery) -> list[Section]:
    """Returns the section on where the models fail; none without free runs, which tell it."""
    if (run := found.run) is None:
        return []
    located = [describe_finding(f) for f in found.located]
    where = "where the nominal model fails"
    if found.verdict == "nothing missing":
        where = "where the errors of the nominal model are"
    parts = [" ".join(map(sentence, located))]
    if found.findings:
        title = "With what is named" if found.named else "What is left"
        parts.append(f"{title}: {'; '.join(map(describe_finding, found.findings))}.")
    plain = listed_below(where, located)
    drawn = cache(partial(where_figures, found, run))
    return [Section("Where it disagrees", "\n\n".join(parts), drawn, plain=plain)]


def parameters_section(found: Discovery) -> Section:
    """Returns the section on parameters: nominal, fitted without effects, and of the final fit."""
    words, said = words_of(found), STD[found.judged_by]
    if found.has_deviations:
        said += " Values of single parts are their relative deviations from the common value, and"
        said += " those of single points their displacements."
    if found.held_fixed:
        kept = " or ".join(gathered(words[name] for name in found.held_fixed))
        said += f" It is also too small where the true value of {kept}, which was held fixed, is"
        said += " not the nominal one."
    steps, table = std_sentence(found.final, words), value_table(found)
    plain = value_lines(found, table)
    return Section(
        "The parameters",
        f"{said} {steps}".rstrip(),
        table=table.last_first,
        plain="\n".join([*plain, *filter(None, [steps])]) if plain else "",
    )


def shifts_section(found: Discovery) -> list[Section]:
    """Returns the section on records whose inputs are shifted in time; none where none is told."""
    shifts = shown_shifts(found.shifts, found.records, found.options)
    if not shifts:
        return []
    rows = tuple((s.record, describe_shift(s), fall_words(s.fall)) for s in shifts)
    lines = [f"  {name}: {shift}; with this shift its mean square {f}" for name, shift, f in rows]
    table = Table(("record", "its inputs act", "with this shift its mean square"), rows)
    plain = "\n".join([f"{SHIFTS}:", *lines])
    return [Section("Shifts in time", f"{sentence(SHIFTS)} {LATER}", table=table, plain=plain)]
