"""The fitted values of a model, and what finer steps of the simulation would change of them.

A parameter whose name has an @ and no dot is the deviation of one drive or the displacement of one
point. There are 96 of them where all drives and points of INCA may differ. A terminal shows only
the worst known of many.

    s_i / s_i,prior        1: the log says nothing of parameter i; 0: it says all
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isfinite
from typing import TYPE_CHECKING

from identification.discovery.fitted import Fitted
from identification.model.parameter import Parameter
from identification.model.protocol import FINER
from identification.quantities import alike, held, quantity
from identification.report.page.page import Table
from identification.report.words.effects import value_with_std
from identification.report.words.values import is_part, words_of

if TYPE_CHECKING:  # a search is slow to import
    from identification.discovery.result import Discovery

LEAST_MOVE = 0.01  # of a value: that finer steps would move it by less is not told
LEAST_OF_STEP = 0.1  # of the model's step, likewise of a time
TOLD_DIGITS = 4  # of values that finer steps would give
SHOWN, MOST_SHOWN = 3, 8  # of more values than the latter only the first are told
FEW = 3  # single parts that are shown where there are more than MANY
MANY = 8
NONE = "–"


def value_table(found: Discovery) -> Table:
    """Returns a table of values: nominal, fitted without effects, and with what is named."""
    models = [found.nominal, found.final][: 1 + bool(found.named)]
    is_begun = found.is_begun
    parameters = {p.name: p for p in found.final.plant.parameters}
    like = _sizes(models, parameters)
    columns = [_words(m, parameters, like, is_begun and m is found.nominal) for m in models]
    words, rows = words_of(found), []
    every = dict.fromkeys(name for column in columns for name in column)
    # which kind it is, such as where an encoder sits, is said with the effect and is no estimate,
    # what was before the log is of no use, and the numbers of a curve are a figure
    effects = [n.candidate.effect for n in found.named]
    kinds = {f"{e.name}.{s.name}" for e in effects for s in e.shapes if not s.free or s.of_log}
    kinds |= {name for e in effects if e.is_curve for name in e.every_size}
    for name in (n for n in every if n not in kinds):
        own = _of(name, parameters)
        first = NONE
        if own.where != "effect":
            first = quantity(own.value, unit=own.unit, like=like[name])
        rows.append((words.get(name, name), first, *(c.get(name, NONE) for c in columns)))
    without = "as begun, without effects" if is_begun else "fitted without effects"
    head = ("parameter", "nominal", without, "fitted with what is named")
    return Table(head[: 2 + len(models)], tuple(rows))


def value_lines(found: Discovery, table: Table) -> list[str]:
    """Returns the lines of `value_table` for a terminal; of many single parts the worst known."""
    if not table.rows:
        return []
    words = words_of(found)
    shares = {words.get(n, n): share for n, share in unknown_shares(found.final).items()}
    rows, rest = shown_values([[str(cell) for cell in row] for row in table.rows], shares)
    lines = [[*table.columns], *rows]
    width = [max(map(len, column)) for column in zip(*lines, strict=True)]
    return [
        "fitted values:",
        *("  " + "  ".join(map(str.ljust, line, width)).rstrip() for line in lines),
        *([f"  {rest}"] if rest else []),
    ]


def unknown_shares(fit: Fitted) -> dict[str, float]:
    """Returns the std of each single part's parameter over the std known before, by name."""
    return {n: s for n, s in fit.unlearned.items() if is_part(n)}


def shown_values(
    rows: Sequence[Sequence[str]], shares: Mapping[str, float]
) -> tuple[list[Sequence[str]], str]:
    """Returns the rows but those of well known single parts, and a sentence on those left out.

    The rows are of a table of parameters, and begin with what each is called; so are `shares`
    called, which are those of `unknown_shares`.
    """
    if len(shares) <= MANY:
        return list(rows), ""
    worst = sorted(shares, key=lambda name: shares[name], reverse=True)[:FEW]
    shown = [row for row in rows if row[0] not in shares or row[0] in worst]
    return shown, (
        f"Of {len(shares)} deviations of single drives and displacements of single points only the"
        f" {FEW} worst known are shown; all of them stand in the report that --out keeps."
    )


def step_sentences(
    model: Fitted, words: Mapping[str, str] | None = None, steps: tuple[float, float] | None = None
) -> list[str]:
    """Returns a paragraph on the steps; none where they are the model's and finer change little.

    `words` call the values by name, else by their names; `steps` are those of the simulations and
    of the user's model [s], else those of the fitted model.
    """
    from identification.windows.coarse import OUTPUT_ERROR, steps_of  # slow to import

    taken, own = steps or steps_of(model.plant)
    changed = _changed(model, words or {}, own)
    if taken == own and not changed:
        return []
    model_step, finer = quantity(own, unit="s"), own / FINER
    said = f"Simulations took steps of {model_step}, as the model says."
    if taken > own:
        is_last_own = steps_of(model.plant)[0] <= own
        said = (
            f"{'The search' if is_last_own else 'Simulations'} took steps of"
            f" {quantity(taken, unit='s')} where the model has {model_step}: this changes what is"
            f" predicted by less than {100 * OUTPUT_ERROR:.0f} % of its error."
        )
        if is_last_own:
            said += " The last fit took the steps of the model."
    if taken < own:
        return [
            f"Simulations took steps of {quantity(taken, unit='s')} where the model has"
            f" {model_step}: the error of the model's steps looked like an effect, or moved its"
            f' size. Write timestep="{taken:.6g}" into the <option> of the model.'
        ]
    if model.finer is None or not model.finer.is_known:
        return [said]
    said += (
        f" The last fit was checked with a quarter of the model's step, {quantity(finer, unit='s')}"
    )
    if not changed:
        return [f"{said}: it would change little, and the std include it."]
    return [
        f"{said}: it would {', and would '.join(changed)}. For a better answer write"
        f' timestep="{finer:.6g}" into the <option> of the model, and run the command again.'
    ]


def std_sentence(model: Fitted, words: Mapping[str, str] | None = None) -> str:
    """Returns a warning that std are mostly the error of the steps, where they are; or "".

    It stands beside the std; `step_sentences` says by how much, and what to do.
    """
    if not (far := _far(model)):
        return ""
    return (
        "The std include the error of the simulation's steps, which is most of the std of"
        f" {first_few([(words or {}).get(n, n) for n in far])}."
    )


def first_few(told: Sequence[str], join: str = ", ") -> str:
    """Returns some words; of more than `MOST_SHOWN` the first, and how many more there are."""
    if len(told) <= MOST_SHOWN:
        return join.join(told)
    return f"{join.join(told[:SHOWN])} and {len(told) - SHOWN} more"


def _changed(model: Fitted, words: Mapping[str, str], own: float) -> list[str]:
    """Returns clauses on what steps finer than `own` [s] would do that is worth to be told."""
    finer, said = model.finer, []
    if finer is None:
        return []
    parameters = {p.name: p for p in model.plant.parameters}
    moved = dict(zip(model.told_std, finer.values.tolist(), strict=True))
    units = {n: _of(n, parameters).unit for n in moved}
    if far := [n for n in _far(model) if matters(moved[n], model.told_values[n], units[n], own)]:
        told = []
        for n in far:  # the values of a fit with finer steps, to first order
            value = alike([model.told_values[n] + moved[n]], units[n], TOLD_DIGITS)[0]
            told.append(f"{words.get(n, n)} to {value}")
        said.append(f"move {first_few(told)}, which the std include")
    if finer.is_lower():
        said.append(
            f"lower the error of the fitted windows to {held(finer.error)} of what it is: that part"
            " comes from the steps, and not from something that is missing"
        )
    return said


def matters(moved: float, value: float, unit: str, step: float) -> bool:
    """Returns whether a change of a value by finer steps is so large that these are worth it.

    Args:
        moved: the change, in `unit`.
        value: the value, in `unit`.
        unit: in which both are.
        step: of the model [s]; of a time less than a share of it matters to nobody.
    """
    return abs(moved) > max(LEAST_MOVE * abs(value), LEAST_OF_STEP * step * (unit == "s"))


def _far(model: Fitted) -> list[str]:
    """Returns the values whose std is mostly the error of the steps, the worst first."""
    return [] if model.finer is None else model.finer.far(model.told_std)


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
