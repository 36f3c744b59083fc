"""The fitted values of a discovery on several records: name, value ± std and unit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from identification.discovery.findings.finding import FindingKind
from identification.prediction.model import WindowModel
from identification.prediction.result import RecordsDiscovery
from identification.quantities import quantity
from identification.report.parameter_words import parameter_words

NOT_TOLD = "(std not known, because too few windows tell of it)"


def value_with_std(value: float, std: float, unit: str, like: float = 0.0) -> str:
    """Returns a value with its std in words, also where the std cannot be known.

    Args:
        value: in `unit`.
        std: in `unit`; NaN where too few windows tell of it, inf where none feels it.
        unit: SI unit.
        like: see `quantity`.
    """
    if np.isinf(std):
        return f"{quantity(value, unit=unit, like=like)}, not felt"
    said = quantity(value, std, unit, like)
    return f"{said} {NOT_TOLD}" if np.isnan(std) else said


def value_table(found: RecordsDiscovery) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    """Returns head and rows of a table of fitted values, without and with what is named."""
    models = [found.nominal, found.final] if found.named else [found.nominal]
    is_begun = any(f.kind is FindingKind.WORSE_FIT for f in found.findings)
    like: dict[str, float] = {}
    for model in models:
        for name, value in {**model.fit.values, **model.values}.items():
            std = model.told_std.get(name, 0.0)
            told = abs(value), std if np.isfinite(std) else 0.0
            like[name] = max(like.get(name, 0.0), *told)
    columns = [_values(m, like, is_begun and m is found.nominal) for m in models]
    names = [*dict.fromkeys(name for column in columns for name in column)]
    without = "as begun, without effects" if is_begun else "fitted without effects"
    head = ("parameter", without, "fitted with what is named")
    words = value_words(found)
    rows = [
        (words.get(name, name), *(column.get(name, "–") for column in columns)) for name in names
    ]
    return head[: 1 + len(models)], rows


def value_words(found: RecordsDiscovery) -> dict[str, str]:
    """Returns the words of the fitted values by name."""
    effects = [named.effect.candidate.effect for named in found.named]
    return parameter_words(found.final.plant.parameters, effects)


def text_table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """Returns the lines of a table for a terminal, its cells to the left."""
    widths = [max(map(len, column)) for column in zip(head, *rows, strict=True)]
    return [
        "  " + "  ".join(c.ljust(w) for c, w in zip(row, widths, strict=True)).rstrip()
        for row in (head, *rows)
    ]


def _values(model: WindowModel, like: Mapping[str, float], is_begun: bool) -> dict[str, str]:
    """Returns what was fitted or begun with, and what effects hold fixed, in words by name."""
    std, parameters = model.told_std, model.plant.parameters
    out = {}
    for name, value in {**model.fit.values, **model.values}.items():
        unit = parameters[name.partition(" [")[0]].unit
        most = like[name]
        if name in model.at_bound and not is_begun:
            out[name] = f"{quantity(value, unit=unit, like=most)}, on its bound"
        elif name in std and not is_begun:
            out[name] = value_with_std(value, std[name], unit, most)
        else:
            out[name] = quantity(value, unit=unit, like=most)
    return out
