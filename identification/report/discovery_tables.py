"""Sections of a report that are tables: added effects, parameters, and what stays hidden."""

from __future__ import annotations

from math import isfinite, isnan

from identification.discovery.final_values import collect_final_values, collect_std
from identification.discovery.result import Discovery
from identification.quantities import quantity
from identification.report.effect_words import describe_effect, describe_gains
from identification.report.page import Section, Table
from identification.report.parameter_words import words_of
from identification.report.shown_words import shown_rows, shown_sentences


def diff_section(found: Discovery, files: str = "") -> Section:
    """Returns the section on the effects that were added to the model, as laws and numbers.

    Args:
        found: the discovery.
        files: a sentence that says where the model with them is.
    """
    if not found.named:
        return Section("What was added", "Nothing: the model is the nominal one, fitted.")
    rows = []
    for named in found.named:
        c = named.candidate
        for k, (name, (value, std, unit)) in enumerate(named.parameters.items()):
            once = (f"+ {describe_effect(c)}", f"{100 * named.confidence:.0f} %", c.effect.law)
            rows.append((name, quantity(value, std, unit), *(once if k == 0 else ("",) * 3)))
    proofs = [f"{describe_effect(n.candidate)}: {describe_gains(n)}." for n in found.named]
    said = " ".join(f"{proof[:1].upper()}{proof[1:]}" for proof in proofs)
    return Section(
        "What was added",
        f"{said} {files}".strip(),
        table=Table(("parameter", "value", "effect", "confidence", "law"), tuple(rows)),
    )


def parameters_section(found: Discovery) -> Section:
    """Returns the section on parameters: nominal, fitted without effects, and of the final fit."""
    plant = found.final.point.predictor.plant
    first, last = collect_std(found.nominal), collect_std(found.final)
    nominal, values = found.nominal.point.values, collect_final_values(found)
    words = words_of(found)
    rows, held = [], []
    for p in plant.parameters:
        if p.name not in last and p.name not in first:
            held += [words[p.name]] if p.where not in ("effect", "start") else []
            continue
        told = (nominal.get(p.name, 0.0), values[p.name], 0.0 if p.where == "effect" else p.value)
        stds = (s for s in (first.get(p.name), last.get(p.name)) if s is not None and isfinite(s))
        like = max(*map(abs, told), *stds)
        row = (
            words[p.name],
            "–" if p.where == "effect" else quantity(p.value, unit=p.unit, like=like),
            _value(nominal.get(p.name), first.get(p.name), p.unit, like),
            _value(values[p.name], last.get(p.name), p.unit, like),
        )
        rows.append(row if found.named else row[:3])
    titles = ("parameter", "nominal", "fitted without effects", "fitted with what is named")
    said = "A std holds if the model is right; that of a wrong model is too small."
    if any("@" in p.name and p.name in last and p.where != "effect" for p in plant.parameters):
        said += " Values of single parts are their relative deviations from the common value, and"
        said += " those of single points their displacements."
    if held:
        said += f" It is also too small where the true value of {' or '.join(held)}, which was held"
        said += " fixed, is not the nominal one."
    return Section(
        "The parameters",
        said,
        table=Table(titles if found.named else titles[:3], tuple(rows)),
    )


def unseen_section(found: Discovery) -> Section:
    """Returns the section on what this log would have shown, and what not."""
    if not found.detectable:
        return Section("What it could have seen", "Not computed for this log.")
    return Section(
        "What it could have seen",
        "The smallest size of each effect that is found in 9 of 10 logs like this one, beside the"
        " largest that is plausible, the hardest to see first. What is missing and smaller stays"
        f" hidden.\n\n{shown_sentences(found.detectable)}",
        table=Table(
            ("effect", "smallest seen", "largest plausible"), tuple(shown_rows(found.detectable))
        ),
    )


def _value(value: float | None, std: float | None, unit: str, like: float) -> str:
    if value is None or std is None:
        return "–"
    return quantity(value, std, unit, like) + (", on its bound" if isnan(std) else "")
