"""The sections of a discovery on effects: those that were added to the model, and all rivals."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache, partial

from identification.discovery.attempts import Failed
from identification.discovery.effect_results import NamedEffect
from identification.discovery.result import Discovery, Scored
from identification.report.discovery_figures import GAIN, score_figures
from identification.report.effect_words import (
    describe_effect,
    describe_gains,
    describe_rejected,
    describe_there,
    phrase,
    say_choice,
    shown_parameters,
    value_with_std,
    words_of,
)
from identification.report.finding_words import sentence
from identification.report.named_words import SHOWN, diff_line, node_lines
from identification.report.page import Section, Table
from identification.shares import percent

BEST, LISTED = 10, 6  # candidates with the best scores, in a figure and in a list
MANY = 8  # lines on what failed; of more the count is told
FAILED = "tried, and not possible to simulate"
DROPPED = "begun, and left by the search"
MEASURES = {  # of a score: what its bars are, their axis, and the title of the figure
    "gain": (
        "What each effect, at its best place and shape (one that is named at the place of its"
        " name), would explain of the fitted nominal model's residual, the model's parameters tuned"
        " again. The bars are the gains that the nominal fit promises before an effect is fitted; a"
        " gain that is said in words is that of the refitted model, so that the two differ.",
        GAIN,
        "Gain of the best candidates on the nominal fit",
    ),
    "fall": (
        "Share of the fitted error that each effect would explain at its best place and shape; one"
        " that is named at the place of its name.",
        "share of the mean square of the fitted error",
        "Share of the fitted error",
    ),
}


def added_section(found: Discovery, files: str = "") -> Section:
    """Returns the section on the added effects; `files` says where the model with them is."""
    title = "What was added"
    if not found.named:
        return Section(title)
    rows, proofs, lines, words = [], [], [], words_of(found)
    for named in found.named:
        effect = describe_there(named.candidate, found.final.plant)
        law, gains = named.candidate.effect.law, describe_gains(named)
        once = (effect, percent(named.confidence), law)
        for k, (name, value) in enumerate(_numbers(named)):
            rows.append((name, value, *(once if k == 0 else ("",) * 3)))
        proofs.append(sentence(f"{effect}: {gains}"))
        lines += [diff_line(found, named), f"    law: {law}", f"    {gains}"]
        if named.candidate.effect.is_curve:
            lines += [f"    {line}" for line in node_lines(named, found.final.plant)]
        other = named.retuned
        if other is not None and other.confidence >= SHOWN:
            lines.append(
                f"    no effect, but {words[other.parameter]} {other.distance:+z.2g} std from what"
                f" was known: confidence {percent(other.confidence)}"
            )
    return Section(
        title,
        f"{' '.join(proofs)} {files}".strip(),
        table=Table(("parameter", "value", "effect", "confidence", "law"), tuple(rows)),
        plain="\n".join(lines),
    )


def _numbers(named: NamedEffect) -> list[tuple[str, str]]:
    """Returns the numbers of a named effect, a row each; those of a curve are a figure."""
    shown = shown_parameters(named)
    if named.candidate.effect.is_curve:
        return [(f"{len(shown)} nodes", "see the figure of the force")]
    return [
        (name, say_choice(named.candidate, name, value) or value_with_std(value, std, unit))
        for name, (value, std, unit) in shown.items()
    ]


def rivals_section(found: Discovery) -> Section:
    """Returns the section on all candidates: what each would explain, and rivals of the named."""
    (text, axis, caption), best = MEASURES[found.scored_by], best_scores(found)
    rows = tuple(
        (describe_effect(r.candidate), percent(r.confidence),
         describe_effect(n.candidate), r.alike)
        for n in found.named
        for r in n.rivals
    )  # fmt: skip
    parts = [text]
    if not rows and found.named:
        parts.append("No other explanation comes near those that are named.")
    title, tried = describe_rejected(found)
    words = {s.candidate.effect.name: phrase(s.candidate.effect) for s in found.scores}
    others = {
        FAILED: failed_lines([f for f in found.failed if not f.dropped], words),
        DROPPED: left_lines([f for f in found.failed if f.dropped], words),
    }
    if tried:
        parts += [f"{title.capitalize()}:", *map(sentence, tried)]
    for word, lines in others.items():
        parts += [f"{word.capitalize()}:", *lines] if lines else []
    explained = "what each effect would explain at its best place, before it is fitted"
    scores = [describe_score(found, score) for score in best[:LISTED]]
    plain = [
        listed_below(title, tried),
        *(listed_below(word, lines) for word, lines in others.items()),
        listed_below(explained, scores),
    ]
    return Section(
        "Who could explain it",
        "\n\n".join(parts),
        figures=cache(partial(score_figures, found, best[:BEST], axis, caption)) if best else (),
        table=Table(("rival", "confidence", "named", "alike"), rows) if rows else None,
        plain="\n\n".join(filter(None, plain)),
    )


def best_scores(found: Discovery) -> list[Scored]:
    """Returns the best score of each effect: its best place and shape."""
    each: dict[str, Scored] = {}
    for score in found.scores:
        each.setdefault(score.candidate.effect.name, score)
    return [*each.values()]


def describe_score(found: Discovery, score: Scored) -> str:
    """Returns in words what a candidate would explain, before it is fitted."""
    value = f"gain {score.explains:z.3g}"
    if found.scored_by == "fall":
        value = f"{percent(score.explains)} of the fitted error"
    effect = describe_there(score.candidate, found.final.plant)
    return f"{effect}: {value}, chance {score.p_value:.2g}"


def failed_lines(failed: Sequence[Failed], words: Mapping[str, str]) -> list[str]:
    """Returns a line for each candidate that failed, and one for further ones.

    Args:
        failed: what could not be evaluated.
        words: of effects by name.
    """
    lines = [f"{_called(one, words)}: {one.outcome}" for one in failed[:MANY]]
    more = len(failed) - len(lines)
    return [*lines, f"and {more} more"] if more > 0 else lines


def left_lines(failed: Sequence[Failed], words: Mapping[str, str]) -> list[str]:
    """Returns a line for each reason for which a search left candidates that it had begun.

    Args:
        failed: what was left.
        words: of effects by name.
    """
    each: dict[str, list[str]] = {}
    for one in failed:
        each.setdefault(one.reason, []).append(_called(one, words))
    return [
        f"{sentence(reason).removesuffix('.')}: {'; '.join(names[:MANY])}"
        + (f"; and {len(names) - MANY} more" if len(names) > MANY else "")
        for reason, names in each.items()
    ]


def _called(one: Failed, words: Mapping[str, str]) -> str:
    return ", ".join(filter(None, [words.get(one.name, one.name.replace("_", " ")), one.where]))


def listed_below(title: str, lines: Sequence[str]) -> str:
    """Returns a title with lines below it for a terminal; "" without lines."""
    return "\n".join([f"{title}:", *(f"  {line}" for line in lines)]) if lines else ""
