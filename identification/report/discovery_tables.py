"""Sections of a report that are tables: records, added effects, parameters, what stays hidden."""

from __future__ import annotations

from math import isnan

from identification.discovery.result import Discovery
from identification.prediction.clocks import shown_shifts
from identification.quantities import quantity
from identification.report.effect_words import describe_gains, describe_there
from identification.report.error_words import pair_words
from identification.report.finding_words import describe_shift, sentence
from identification.report.fitted_values import value_table
from identification.report.page import Section, Table
from identification.report.parameter_words import words_of
from identification.report.shown_words import shown_rows, shown_sentences
from identification.report.step_words import std_sentence, step_sentences
from identification.windows.coarse import steps_of

DIGITS = 3  # of errors of records
FITTED = "all of it was fitted"
SHIFTS = (
    "by how much the inputs of a record seem to act later or earlier than their time stamps say,"
    " where both halves of it tell the same"
)


def record_rows(found: Discovery) -> list[tuple[str, ...]]:
    """Returns rows of records: name, errors without and with what is named, and role."""
    seen = [e for e in found.errors if not isnan(e.before)]
    pairs = [(e.before_by_unit, e.after_by_unit) for e in seen]
    words = dict(zip((id(e) for e in seen), pair_words(pairs, "", DIGITS), strict=True))
    return [(e.name, *words.get(id(e), (FITTED, "")), e.role) for e in found.errors]


def records_section(found: Discovery) -> list[Section]:
    """Returns the section on the errors of each record; none for a single record of a free run."""
    if found.horizon is None and len(found.errors) < 2:
        return []
    said = "Rms error of free runs over the unseen samples of each record."
    if found.horizon is not None:
        said = (
            f"Rms error over windows of {found.horizon:g} s, each from the state that explains it"
            " best. Nothing was fitted to the records that confirm."
        )
    head = ("record", "nominal model", "final model", "role")
    table = Table(head, tuple(record_rows(found)))
    return [Section("Error by record", " ".join([said, *steps_taken(found)]), table=table)]


def steps_taken(found: Discovery) -> list[str]:
    """Returns sentences on the steps of simulations, on finer ones, and on passes left out."""
    steps = steps_of(found.nominal.plant)
    without = ", ".join(found.options.without)
    left_out = [f"The options left out these passes of the search: {without}."] if without else []
    return [*step_sentences(found.final, words_of(found), steps), *left_out]


def diff_section(found: Discovery, files: str = "") -> Section:
    """Returns the section on the effects that were added to the model, as laws and numbers.

    Args:
        found: the discovery.
        files: a sentence that says where the model with them is.
    """
    if not found.named:
        return Section("What was added", "Nothing: the model is the nominal one, fitted.")
    rows, proofs = [], []
    for named in found.named:
        effect = describe_there(named.candidate, found.final.plant)
        for k, (name, (value, std, unit)) in enumerate(named.parameters.items()):
            law = named.candidate.effect.law
            once = (f"+ {effect}", f"{100 * named.confidence:.0f} %", law)
            rows.append((name, quantity(value, std, unit), *(once if k == 0 else ("",) * 3)))
        proofs.append(sentence(f"{effect}: {describe_gains(named)}"))
    return Section(
        "What was added",
        f"{' '.join(proofs)} {files}".strip(),
        table=Table(("parameter", "value", "effect", "confidence", "law"), tuple(rows)),
    )


def parameters_section(found: Discovery) -> Section:
    """Returns the section on parameters: nominal, fitted without effects, and of the final fit."""
    free, words = {*found.nominal.told_std, *found.final.told_std}, words_of(found)
    if found.horizon is None:
        said = "A std holds if the model is right; that of a wrong model is too small."
    else:
        said = (
            "Std by blocks of windows, whose errors need not be white; unknown where too few"
            " windows tell of a value."
        )
    own = [p for p in found.final.plant.parameters if p.where != "effect"]
    if any("@" in p.name and p.name in free for p in own):
        said += " Values of single parts are their relative deviations from the common value, and"
        said += " those of single points their displacements."
    held = [words[p.name] for p in own if p.name not in free and p.where != "start"]
    if held and found.horizon is None:
        said += f" It is also too small where the true value of {' or '.join(held)}, which was held"
        said += " fixed, is not the nominal one."
    steps = std_sentence(found.final, words)
    return Section("The parameters", f"{said} {steps}".rstrip(), table=value_table(found))


def unseen_section(found: Discovery) -> list[Section]:
    """Returns the section on what this log would have shown, and what not; none where unknown."""
    if not found.detectable:
        return []
    said = (
        "The smallest size of each effect that is found in 9 of 10 logs like this one, beside the"
        " largest that is plausible, the hardest to see first. What is missing and smaller stays"
        f" hidden.\n\n{shown_sentences(found.detectable)}"
    )
    head = ("effect", "smallest seen", "largest plausible")
    table = Table(head, tuple(shown_rows(found.detectable)))
    return [Section("What it could have seen", said, table=table)]


def shifts_section(found: Discovery) -> list[Section]:
    """Returns the section on records whose inputs are shifted in time; none where none is told."""
    shifts = shown_shifts(found.shifts, found.records, found.options)
    if not shifts:
        return []
    rows = tuple((s.record, describe_shift(s), 100 * s.fall) for s in shifts)
    return [Section(
        "Shifts in time",
        f"{sentence(SHIFTS)} Inputs that seem to act earlier may also be the answer of a controller"
        " to what the robot did.",
        table=Table(("record", "its inputs act", "of its mean square [%]"), rows),
    )]  # fmt: skip


def shift_lines(found: Discovery) -> list[str]:
    """Returns lines on records whose inputs are shifted in time; none where none is told."""
    shifts = shown_shifts(found.shifts, found.records, found.options)
    lines = [f"  {s.record}: {describe_shift(s)}, {100 * s.fall:z.0f} % of its mean square"
             for s in shifts]  # fmt: skip
    return [f"{SHIFTS}:", *lines] if lines else []
