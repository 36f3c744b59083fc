"""The fitted values of a discovery: as the model had them, and fitted without and with effects.

A parameter whose name has an @ and no dot is the deviation of one drive or the displacement of one
point. There are 96 of them where all drives and points of INCA may differ. A terminal shows only
the worst known of many.

    s_i / s_i,prior        1: the log says nothing of parameter i; 0: it says all
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isfinite

from identification.discovery.findings.finding import FindingKind
from identification.discovery.fitted import Fitted
from identification.discovery.result import Discovery
from identification.model.parameter import Parameter
from identification.quantities import quantity
from identification.report.effect_words import value_with_std
from identification.report.page import Table
from identification.report.parameter_words import words_of

FEW = 3  # single parts that are shown where there are more than MANY
MANY = 8
NONE = "–"


def value_table(found: Discovery) -> Table:
    """Returns a table of values: nominal, fitted without effects, and with what is named."""
    models = [found.nominal, found.final][: 1 + bool(found.named)]
    is_begun = any(f.kind is FindingKind.WORSE_FIT for f in found.findings)
    parameters = {p.name: p for p in found.final.plant.parameters}
    like = _sizes(models, parameters)
    columns = [_words(m, parameters, like, is_begun and m is found.nominal) for m in models]
    words, rows = words_of(found), []
    for name in dict.fromkeys(name for column in columns for name in column):
        own = _of(name, parameters)
        first = NONE
        if own.where != "effect":
            first = quantity(own.value, unit=own.unit, like=like[name])
        rows.append((words.get(name, name), first, *(c.get(name, NONE) for c in columns)))
    without = "as begun, without effects" if is_begun else "fitted without effects"
    head = ("parameter", "nominal", without, "fitted with what is named")
    return Table(head[: 2 + len(models)], tuple(rows))


def text_table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """Returns the lines of a table for a terminal, its cells to the left."""
    widths = [max(map(len, column)) for column in zip(head, *rows, strict=True)]
    return [
        "  " + "  ".join(c.ljust(w) for c, w in zip(row, widths, strict=True)).rstrip()
        for row in (head, *rows)
    ]


def unknown_shares(fit: Fitted) -> dict[str, float]:
    """Returns the std of each single part's parameter over the std known before, by name."""
    return {n: s for n, s in fit.unlearned.items() if "@" in n and "." not in n}


def shown_values(
    rows: Sequence[Sequence[str]], shares: Mapping[str, float]
) -> tuple[list[Sequence[str]], str]:
    """Returns the rows that matter, and a sentence on those that are left out.

    Args:
        rows: of a table of parameters; each begins with what the parameter is called.
        shares: see `unknown_shares`, by what the table calls them.

    Returns:
        All rows but those of single parts that are better known than the worst few, and "" where
        no row is left out.
    """
    if len(shares) <= MANY:
        return list(rows), ""
    worst = sorted(shares, key=lambda name: shares[name], reverse=True)[:FEW]
    shown = [row for row in rows if row[0] not in shares or row[0] in worst]
    return shown, (
        f"Of {len(shares)} deviations of single drives and displacements of single points only the"
        f" {FEW} worst known are shown; all of them stand in the report that --out keeps."
    )


def _of(name: str, parameters: Mapping[str, Parameter]) -> Parameter:
    """Returns the parameter of a value, which a record may have for itself as `name [record]`."""
    return parameters.get(name) or parameters[name.partition(" [")[0]]


def _sizes(models: Sequence[Fitted], parameters: Mapping[str, Parameter]) -> dict[str, float]:
    """Returns the largest magnitude or std of each row, so that all its cells have one prefix."""
    like: dict[str, float] = {}
    for model in models:
        for name, value in model.told_values.items():
            own, std = _of(name, parameters), model.told_std.get(name, 0.0)
            first = 0.0 if own.where == "effect" else own.value
            told = abs(value), abs(first), std if isfinite(std) else 0.0
            like[name] = max(like.get(name, 0.0), *told)
    return like


def _words(
    model: Fitted, parameters: Mapping[str, Parameter], like: Mapping[str, float], is_begun: bool
) -> dict[str, str]:
    """Returns what was fitted or begun with, and what effects hold fixed, in words by name."""
    std, out = model.told_std, {}
    for name, value in model.told_values.items():
        unit, most = _of(name, parameters).unit, like[name]
        if name in model.at_bound and not is_begun:
            out[name] = f"{quantity(value, unit=unit, like=most)}, on its bound"
        elif name in std and not is_begun:
            out[name] = value_with_std(value, std[name], unit, most)
        else:
            out[name] = quantity(value, unit=unit, like=most)
    return out
