"""The sections of a discovery on effects: those that were added to the model, and all rivals."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache, partial

from identification.discovery.attempts import Failed
from identification.discovery.effect_results import NamedEffect, RejectedEffect
from identification.discovery.result import Discovery, Scored
from identification.report.discovery.figures import GAIN, score_figures
from identification.report.discovery.finding_words import sentence
from identification.report.discovery.named_words import SHOWN, node_lines
from identification.report.page.page import Section, Table
from identification.report.words.effects import (
    chance_words,
    describe_doubt,
    describe_effect,
    describe_gains,
    describe_next,
    describe_rejected,
    describe_sizes,
    describe_there,
    number,
    say_choice,
    shown_parameters,
)
from identification.report.words.values import phrase, words_of
from identification.shares import fall_words, percent

BEST, LISTED = 10, 6  # candidates with the best scores, in a figure and in a list
MANY = 8  # lines on what failed; of more the count is told
FAILED = "tried, and not possible to simulate"
DROPPED = "begun, and left by the search"
LUCK = 0.5  # chance from which on luck explains a score as well as the effect
BLANK = ("", "", "")  # size, mean square and chance of what was not fitted
TRIED = (
    "These effects were tried too. The change of the mean square and the chance that luck makes it"
    " are those of unseen data."
)
TRIED_HEAD = ("effect", "size", "mean square", "chance", "why it is not believed")
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
        sizes = describe_sizes(named, found.final.plant)
        lines += [f"+ {effect}: {sizes}", f"    law: {law}", f"    {gains}"]
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
    shown, effect = shown_parameters(named), named.candidate.effect
    if effect.is_curve:
        return [(f"{len(shown)} nodes", "see the figure of the force")]
    return [
        (name, say_choice(named.candidate, name, told[0]) or number(effect, name, *told))
        for name, told in shown.items()
    ]


def rivals_section(found: Discovery) -> Section:
    """Returns the section on all candidates: what each would explain, and rivals of the named."""
    text, axis, caption = MEASURES[found.scored_by]
    each: dict[str, Scored] = {}  # the best of each effect: its best place and shape
    for score in found.scores:
        each.setdefault(score.candidate.effect.name, score)
    best = [score for score in each.values() if score.p_value < LUCK]
    rows = tuple(
        (describe_effect(r.candidate), percent(r.confidence),
         describe_sizes(r, found.final.plant), describe_effect(n.candidate), r.alike)
        for n in found.named
        for r in n.rivals
    )  # fmt: skip
    parts = [text]
    if not rows and found.named:
        parts.append("No other explanation comes near those that are named.")
    explained = "what each effect would explain at its best place, before it is fitted"
    lines = []
    for s in best[:LISTED]:
        value = f"gain {s.explains:z.3g}"
        if found.scored_by == "fall":
            value = f"{percent(s.explains)} of the fitted error"
        effect = describe_there(s.candidate, found.final.plant)
        lines.append(f"{effect}: {value}, chance {s.p_value:.2g}")
    after = describe_next(found)
    return Section(
        "Who could explain it",
        "\n\n".join(filter(None, [*parts, after])),
        figures=cache(partial(score_figures, found, best[:BEST], axis, caption)) if best else (),
        table=Table(("rival", "confidence", "size", "named", "alike"), rows) if rows else None,
        plain="\n\n".join(filter(None, [after, listed_below(explained, lines)])),
    )


def tried_section(found: Discovery) -> list[Section]:
    """Returns the section on effects that were tried and not accepted; none where none was."""
    words = {s.candidate.effect.name: phrase(s.candidate.effect) for s in found.scores}
    failed, left = ([f for f in found.failed if f.dropped == d] for d in (False, True))
    each: dict[tuple[str, str], RejectedEffect] = {}  # at each place as it did best
    for rejected in found.rejected:
        each.setdefault(rejected.candidate.key, rejected)
    tried, plant = [*each.values()], found.final.plant
    beside = " beside what is named" if found.named else ""
    rows = [
        (describe_there(r.candidate, plant), describe_sizes(r, plant),
         fall_words(r.proof.told.fall, 3),
         chance_words(r.proof.told.chance), describe_doubt(r, found.options))
        for r in tried
    ]  # fmt: skip
    rows += [(name, *BLANK, why) for name, why in failed_rows(failed, words)]
    rows += [(names, *BLANK, f"left by the search: {why}") for names, why in left_rows(left, words)]
    if not rows:
        return []
    plain = [
        listed_below(
            f"tried{beside}, and not believed", [describe_rejected(r, found) for r in tried]
        ),
        listed_below(FAILED, [f"{n}: {why}" for n, why in failed_rows(failed, words)]),
        listed_below(DROPPED, [f"{sentence(why)[:-1]}: {n}" for n, why in left_rows(left, words)]),
    ]
    table, said = Table(TRIED_HEAD, tuple(rows)), "\n\n".join(filter(None, plain))
    return [Section("Tried, and not believed", TRIED, table=table, plain=said)]


def failed_rows(failed: Sequence[Failed], words: Mapping[str, str]) -> list[tuple[str, str]]:
    """Returns candidates that failed with their reasons, and in one row how many more there are."""
    rows = [(_called(one, words), one.outcome) for one in failed[:MANY]]
    more = len(failed) - len(rows)
    return [*rows, (f"{more} more", "see the JSON")] if more > 0 else rows


def left_rows(failed: Sequence[Failed], words: Mapping[str, str]) -> list[tuple[str, str]]:
    """Returns the candidates that a search had begun and left, a row for each reason."""
    each: dict[str, list[str]] = {}
    for one in failed:
        each.setdefault(one.reason, []).append(_called(one, words))
    return [
        ("; ".join(names[:MANY])
         + (f"; and {len(names) - MANY} more" if len(names) > MANY else ""), reason)
        for reason, names in each.items()
    ]  # fmt: skip


def _called(one: Failed, words: Mapping[str, str]) -> str:
    return ", ".join(filter(None, [words.get(one.name, one.name.replace("_", " ")), one.where]))


def listed_below(title: str, lines: Sequence[str]) -> str:
    """Returns a title with lines below it for a terminal; "" without lines."""
    return "\n".join([f"{title}:", *(f"  {line}" for line in lines)]) if lines else ""
