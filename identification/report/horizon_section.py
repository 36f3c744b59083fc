"""The section on where a model fails over a horizon, on a page and in a terminal."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import TYPE_CHECKING

from identification.discovery.result import Discovery
from identification.quantities import alike, held
from identification.report.effect_sections import listed_below
from identification.report.finding_words import sentence
from identification.report.horizon_figures import needed_forces, windows_over_time, worst_windows
from identification.report.horizon_gap import OutputError, find_gap
from identification.report.horizon_words import (
    doubtful_sentences,
    force_line,
    length_lines,
    output_line,
    worst_lines,
)
from identification.report.page import Section, Table

if TYPE_CHECKING:
    from identification.report.page import Figures

TITLE = "Where it disagrees"
NEEDED = "The force that is missing, by joint"
WORST = "The fitted windows in which the final model fails most"
NEAR_NOISE = 1.5  # times the noise, below which no window or force is told
GROWTH = (
    "A constant force that is missing makes about four times the error over twice the time; noise"
    " of the sensors makes the same error over any time."
)
FORCES = (
    "The force is what a curve at that joint would have to be, in place of every other cause: a"
    " first estimate, linear about the fitted values, with bars of 95 %."
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
    model = "the model with what is named" if found.named else "the fitted model"
    lines = [output_line(o) for o in gap.outputs]
    is_far = max((r.after.max() for r in gap.records), default=0.0) > NEAR_NOISE
    rest = [*(worst_lines(gap) if is_far else ()), *length_lines(gap.lengths)]
    forces = gap.forces if is_far else ()
    text = [f"{' '.join(map(sentence, rest))} {GROWTH}"]
    plain = [listed_below(f"where {model} fails", [*lines, *rest, *map(force_line, forces)])]
    if is_far and not forces:
        most = gap.doubtful
        said = NO_FORCE if most is None else doubtful_sentences(most, gap.curves)
        text.append(said)
        plain.append(said)
    is_drawn = is_far and bool(gap.windows)
    sections = [
        Section(
            TITLE,
            "\n\n".join(text),
            figures=cache(lambda: ((WORST, worst_windows(gap.windows)),)) if is_drawn else (),
            table=_table(gap.outputs, bool(found.named)),
            plain="\n".join(plain),
        )
    ]
    if forces:
        is_answer = found.verdict == "unknown effect"
        needed = [f"{' '.join(sentence(force_line(f)) for f in forces)} {FORCES}"]
        needed += [TRY] if is_answer else []
        drawn = cache(lambda: ((NEEDED, needed_forces(forces)),))
        sections.append(Section(NEEDED, "\n\n".join(needed), figures=drawn, first=int(is_answer)))
    return sections


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
