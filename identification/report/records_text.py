"""A discovery on several records as text for a terminal: the verdict, then what it rests on."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from identification.discovery.findings.records_evidence import ShiftedRecord
from identification.prediction.clocks import shown_shifts
from identification.prediction.result import RecordsDiscovery, RefittedEffect
from identification.prediction.scores import WindowScore
from identification.report.effect_words import describe_there
from identification.report.error_words import pair_words
from identification.report.failed_words import FAILED, failed_lines
from identification.report.records_finding_words import describe_shift
from identification.report.records_values import text_table, value_table, value_words
from identification.report.records_verdict import DIGITS, records_verdict
from identification.report.refitted_words import describe_refitted
from identification.report.step_words import std_sentence, step_sentences

SHOWN = 6  # candidates with the best scores that are listed


def records_text(found: RecordsDiscovery) -> str:
    """Returns the whole discovery, in paragraphs."""
    parts = ["\n".join(records_verdict(found)), "\n".join(_records(found))]
    fitted = ["fitted values:", *text_table(*value_table(found))]
    if said := std_sentence(found.final, value_words(found)):
        fitted.append(said)
    parts.append("\n".join(fitted))
    if shifts := shown_shifts(found.shifts, found.records, found.options):
        parts.append("\n".join(_shifts(shifts)))
    if found.rejected:
        lines = [f"  {said}" for said in rejected_lines(found)]
        parts.append("\n".join(["tried, and not proven on unseen data:", *lines]))
    if failed := failed_lines(found):
        parts.append("\n".join([f"{FAILED}:", *(f"  {line}" for line in failed)]))
    plant = found.nominal.plant
    scores = [
        f"  {describe_there(s.candidate, plant)}: {100 * s.fall:z.0f} % of the fitted error, chance"
        f" {s.p_value:.2g}"
        for s in best_scores(found)[:SHOWN]
    ]
    if scores:
        parts.append(
            "\n".join(
                ["what each effect would explain at its best place, before it is fitted:", *scores]
            )
        )
    parts += [*steps_taken(found), search_time(found.seconds)]
    return "\n\n".join(parts)


def best_scores(found: RecordsDiscovery) -> list[WindowScore]:
    """Returns the best score of each effect: its best place and shape."""
    each: dict[str, WindowScore] = {}
    for score in found.scores:
        each.setdefault(score.candidate.effect.name, score)
    return [*each.values()]


def rejected_lines(found: RecordsDiscovery) -> list[str]:
    """Returns lines on what was tried and not proven, each effect at each place once, the best."""
    each: dict[tuple[str, str], RefittedEffect] = {}
    for effect in found.rejected:
        each.setdefault(effect.candidate.key, effect)
    return [describe_refitted(effect, found.nominal.plant) for effect in each.values()]


def search_time(seconds: Mapping[str, float]) -> str:
    """Returns a sentence on how long the search took, without what is drawn after it."""
    return f"The search took {sum(seconds.values()):.1f} s."


def _shifts(shifts: Sequence[ShiftedRecord]) -> list[str]:
    lines = [
        "by how much the inputs of a record seem to act later or earlier than their time stamps"
        " say, where both halves of it tell the same:"
    ]
    for s in shifts:
        lines.append(f"  {s.record}: {describe_shift(s)}, {100 * s.fall:z.0f} % of its mean square")
    return lines


def steps_taken(found: RecordsDiscovery) -> list[str]:
    """Returns sentences on the steps that simulations took, and what finer ones would change."""
    return step_sentences(found.final, value_words(found), found.steps)


def _records(found: RecordsDiscovery) -> list[str]:
    """Returns lines on the error of each record, without and with what is named."""
    which = "without and with what is named" if found.named else "nothing is named"
    lines = [f"error of prediction over {found.horizon:g} s, {which}:"]
    pairs = pair_words([(e.before_by_unit, e.after_by_unit) for e in found.errors], "", DIGITS)
    for e, (before, after) in zip(found.errors, pairs, strict=True):
        lines.append(f"  {e.name} ({e.role}): {before}" + (f" -> {after}" if found.named else ""))
    return lines
