"""A discovery as text for a terminal: the verdict first, then what supports it."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite

from identification.discovery.effect_results import Gap
from identification.discovery.result import Discovery
from identification.quantities import held
from identification.report.discovery_sections import (
    FAILED,
    best_scores,
    describe_score,
    failed_lines,
)
from identification.report.discovery_tables import FITTED, record_rows, shift_lines, steps_taken
from identification.report.discovery_verdict import discovery_verdict
from identification.report.effect_words import describe_gains, describe_rejected
from identification.report.error_words import error_words
from identification.report.finding_words import describe_finding
from identification.report.fitted_values import (
    shown_values,
    text_table,
    unknown_shares,
    value_table,
)
from identification.report.named_words import SHOWN, diff_line
from identification.report.parameter_words import words_of
from identification.report.shown_words import shown_lines
from identification.report.step_words import std_sentence

BEST = 6  # candidates with the best scores that are listed


def discovery_text(found: Discovery) -> str:
    """Returns the whole outcome, in paragraphs."""
    rejected, tried = describe_rejected(found)
    scores = [describe_score(found, score) for score in best_scores(found)[:BEST]]
    parts = [
        "\n".join(discovery_verdict(found)),
        "\n".join(_diff(found)),
        "\n".join(_gap(found)),
        "\n".join(_records(found)),
        "\n".join(_values(found)),
        "\n".join(shift_lines(found)),
        _list("where the nominal model fails", [*map(describe_finding, found.located)]),
        _list(rejected, tried),
        _list(FAILED, failed_lines(found.failed)),
        _list("what each effect would explain at its best place, before it is fitted", scores),
        "\n".join(shown_lines(found.detectable)),
        *steps_taken(found),
        f"The search took {sum(found.seconds.values()):.1f} s.",
    ]
    return "\n\n".join(part for part in parts if part)


def _list(title: str, lines: Sequence[str]) -> str:
    return "\n".join([f"{title}:", *(f"  {line}" for line in lines)]) if lines else ""


def _diff(found: Discovery) -> list[str]:
    """Returns lines on what is added to the model: its law, what proves it, and what else it is."""
    lines, words = [], words_of(found)
    for named in found.named:
        lines += [diff_line(found, named), f"    law: {named.candidate.effect.law}"]
        lines.append(f"    {describe_gains(named)}")
        other = named.retuned
        if other is not None and other.confidence >= SHOWN:
            lines.append(
                f"    no effect, but {words[other.parameter]} {other.distance:+z.2g} std from what"
                f" was known: confidence {100 * other.confidence:.0f} %"
            )
    return lines


def _gap(found: Discovery) -> list[str]:
    """Returns lines on the error on unseen data, without and with what is named."""
    errors = [found.errors_of(gap) for gap in (found.before, found.after)]
    before, after = error_words(errors)

    def line(what: str, size: str, gap: Gap) -> str:
        ratio = found.times_noise(gap)
        times = f", {held(ratio)} times the noise" if isfinite(ratio) else ""
        return f"  {what:<7}{size}{times}"

    if not found.named:
        return [f"error on unseen data:{line('', before, found.before)[8:]}"]
    told = [line("before", before, found.before), line("after", after, found.after)]
    return ["error on unseen data:", *told]


def _records(found: Discovery) -> list[str]:
    """Returns lines on the error of each record; none for a single record of a free run."""
    if found.horizon is None and len(found.errors) < 2:
        return []
    over = "unseen samples of each record"
    if found.horizon is not None:
        over = f"error of prediction over {found.horizon:g} s"
    lines = [f"{over}, {'without and with what is named' if found.named else 'nothing is named'}:"]
    for error, (name, before, after, role) in zip(found.errors, record_rows(found), strict=True):
        is_told = bool(found.named) and before != FITTED
        worse = "; it is predicted worse" if is_told and error.after > error.before else ""
        lines.append(f"  {name} ({role}): {before}{f' -> {after}' if is_told else ''}{worse}")
    return lines


def _values(found: Discovery) -> list[str]:
    """Returns lines on each parameter as the model had it and as fitted; few of single parts."""
    table = value_table(found)
    if not table.rows:
        return []
    rows = [[str(cell) for cell in row] for row in table.rows]
    words = words_of(found)
    shares = {words.get(n, n): share for n, share in unknown_shares(found.final).items()}
    shown, rest = shown_values(rows, shares)
    lines = ["fitted values:", *text_table(table.columns, shown)]
    lines += [f"  {rest}"] if rest else []
    steps = std_sentence(found.final, words)
    return [*lines, *([steps] if steps else [])]
