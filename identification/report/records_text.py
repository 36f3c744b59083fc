"""A discovery on several records in sentences: the verdict first, then what it rests on."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from identification.prediction.result import NamedByPrediction, RecordsDiscovery, RefittedEffect
from identification.prediction.scores import WindowScore
from identification.report.effect_words import describe_effect, phrase
from identification.report.error_words import change_words, error_words
from identification.report.finding_words import (
    DOUBTS,
    describe_finding,
    describe_shift,
    sentence,
)
from identification.report.records_values import (
    text_table,
    value_table,
    value_with_std,
    value_words,
)
from identification.report.scale_words import describe_scale
from identification.report.step_words import step_sentences

NO_ERROR = 1e-3  # of the inputs' rms: less is not told from none
SHOWN = 6  # candidates with the best scores that are listed
DIGITS = 3  # of errors over a horizon


def records_verdict(found: RecordsDiscovery) -> list[str]:
    """The verdict first, then what supports it."""
    return [*_verdict(found), *describe_scale(found.nominal)]


def _verdict(found: RecordsDiscovery) -> list[str]:
    if found.verdict == "nothing missing":
        before, noise = _left(found)
        return [
            "Nothing is missing, as far as these records can tell: no candidate lowers the error of"
            f" prediction on unseen data beyond chance. It is {before} over"
            f" {found.horizon:g} s, where the sensors make {noise}." + _rest(found),
            *(sentence(describe_finding(finding)) for finding in found.findings),
        ]
    if found.verdict == "unknown effect":
        return [_unknown(found)]
    said = [_named(found, named) for named in found.named]
    said.append(_proof(found))
    said += [sentence(describe_finding(finding)) for finding in found.findings]
    return said


def records_text(found: RecordsDiscovery) -> str:
    """All of it, in paragraphs."""
    parts = ["\n".join(records_verdict(found)), "\n".join(_records(found))]
    parts.append("\n".join(["fitted values:", *text_table(*value_table(found))]))
    if found.shifts:
        parts.append("\n".join(_shifts(found)))
    if found.rejected:
        lines = [f"  {said}" for said in rejected_lines(found)]
        parts.append("\n".join(["tried, and not proven on unseen data:", *lines]))
    scores = [
        f"  {describe_effect(s.candidate)}: {100 * s.fall:z.0f} % of the fitted error, chance"
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
    """The best score of each effect: its best place and shape."""
    each: dict[str, WindowScore] = {}
    for score in found.scores:
        each.setdefault(score.candidate.effect.name, score)
    return [*each.values()]


def rejected_lines(found: RecordsDiscovery) -> list[str]:
    """What was tried and not proven: each effect at each place once, as it did best."""
    each: dict[tuple[str, str], RefittedEffect] = {}
    for effect in found.rejected:
        each.setdefault(effect.candidate.key, effect)
    return [describe_refitted(effect) for effect in each.values()]


def search_time(seconds: Mapping[str, float]) -> str:
    """How long the search took, without what is drawn after it."""
    return f"The search took {sum(seconds.values()):.1f} s."


def describe_refitted(effect: RefittedEffect) -> str:
    """An effect with its sizes, and what it does for unseen records."""
    fall = 100 * effect.prediction.fall
    return (
        f"{describe_effect(effect.candidate)}, {_sizes(effect)}; unseen mean square"
        f" {-fall:+z.0f} %, t = {effect.prediction.t:z.1f}"
        + (f"; {DOUBTS[effect.doubt]}" if effect.doubt else "")
    )


def _sizes(effect: RefittedEffect) -> str:
    """Sizes and shapes, each with its std; no shape that no data tell."""
    untold = {s.name for s in effect.candidate.effect.shapes}
    return ", ".join(
        f"{name} not felt" if np.isinf(std) else f"{name} = {value_with_std(v, std, unit)}"
        for name, (v, std, unit) in effect.parameters.items()
        if name not in untold or np.isfinite(std)
    )


def _rest(found: RecordsDiscovery) -> str:
    """How far the inputs would have to err to make what the sensors do not."""
    if found.input_error < NO_ERROR:
        return " The sensors alone would make it."
    return f" Inputs that err by {100 * found.input_error:.2g} % of their rms would make the rest."


def _named(found: RecordsDiscovery, named: NamedByPrediction) -> str:
    first = "Missing from the model" if named is found.named[0] else "Missing too"
    if found.verdict == "unlisted effect":
        first += ", in no catalogue and drawn from the data"
    mine, sizes = f"{describe_effect(named.effect.candidate)}{_twin(named)}", _sizes(named.effect)
    confidence = f"{100 * named.effect.confidence:.0f} %"
    others = [f"{describe_effect(r.candidate)} ({100 * r.confidence:.0f} %)" for r in named.rivals]
    if named.one_of:
        said = (
            f"{first} is one of these, which these records do not surely tell apart:"
            f" {'; '.join([f'{mine} ({confidence})', *others])}. The first is put into the model:"
            f" {sizes}."
        )
    else:
        said = f"{first}: {mine}, {sizes}; confidence {confidence}{_compared(named)}."
        said += f" Less likely: {', '.join(others)}." if others else ""
    said += _agreement(found, named)
    if named.disagrees:
        said += (
            f" The named effect raises the error on {', '.join(named.disagrees)}, beyond chance."
        )
    return said


def _twin(named: NamedByPrediction) -> str:
    """The other name of the same force."""
    if named.same_as is None:
        return ""
    return (
        f' (or "{phrase(named.same_as)}": below the Coulomb friction it is the same force, and no'
        " record tells which of the two it is)"
    )


def _compared(named: NamedByPrediction) -> str:
    """What a confidence rests on."""
    if not named.compared:
        return ", the highest that is ever said, because no rival was near enough to be refitted"
    rivals = "1 rival that was" if named.compared == 1 else f"{named.compared} rivals that were"
    return f" beside {rivals} refitted in its place"


def _agreement(found: RecordsDiscovery, named: NamedByPrediction) -> str:
    """On how many unseen records it helps, those left out that only repeat others."""
    confirm = [r.log.name for r in found.records if r.role == "confirm"]
    distinct = [name for name in confirm if name not in found.repeats]
    helped = sum(name in named.agrees for name in distinct)
    if not distinct:
        return " All unseen records repeat what was fitted, so that they hardly confirm it."
    said = f" The named effect lowers the error on {helped} of {len(distinct)} unseen records."
    if found.repeats:
        one = len(found.repeats) == 1
        said += f" {', '.join(found.repeats)} {'repeats' if one else 'repeat'} the motion of others"
        said += " and does not count." if one else " and do not count."
    return said


def _shifts(found: RecordsDiscovery) -> list[str]:
    lines = [
        "by how much the inputs of a record seem to act later or earlier than their time stamps"
        " say, where both halves of it tell the same:"
    ]
    for s in found.shifts:
        lines.append(f"  {s.record}: {describe_shift(s)}, {100 * s.fall:z.0f} % of its mean square")
    return lines


def steps_taken(found: RecordsDiscovery) -> list[str]:
    """What steps simulations took, and what finer ones would change."""
    return step_sentences(found.final, value_words(found), found.options, found.steps)


def _proof(found: RecordsDiscovery) -> str:
    errors = found.before.rms_by_unit, found.after.rms_by_unit
    change, (noise,) = change_words(*errors, [found.noise_by_unit], DIGITS)
    fall = 1 - (found.after.rms / found.before.rms) ** 2
    return (
        f"On records that no fit has seen, the error of prediction over {found.horizon:g} s falls"
        f" {change} (mean square {-100 * fall:+z.0f} %); the sensors make {noise}."
        f" That is {100 * found.share:z.0f} % of the power above the sensors' noise."
    )


def _unknown(found: RecordsDiscovery) -> str:
    before, noise = _left(found)
    percent = f"{100 * found.input_error:.2g}"
    needed = f"; inputs would have to err by {percent} % of their rms to make that"
    needed = needed if found.input_error > 0 else ""  # the fitted windows leave no more than noise
    return (
        "Something is missing that none of the known effects surely explains: the fitted model is"
        f" {before} off over {found.horizon:g} s on unseen data, where the sensors make"
        f" {noise}{needed}. It is not named here rather than named wrongly."
        + "".join(f" {sentence(describe_finding(finding))}" for finding in found.findings)
    )


def _left(found: RecordsDiscovery) -> tuple[str, str]:
    """What the nominal model leaves on unseen data, and what the sensors make of it."""
    errors = found.before.rms_by_unit, found.noise_by_unit
    return error_words(errors, digits=DIGITS)[0], error_words(errors, "", DIGITS)[1]


def _records(found: RecordsDiscovery) -> list[str]:
    lines = [f"error of prediction over {found.horizon:g} s, without and with what is named:"]
    for e in found.errors:
        before, after = error_words([e.before_by_unit, e.after_by_unit], "", DIGITS)
        lines.append(f"  {e.name} ({e.role}): {before}" + (f" -> {after}" if found.named else ""))
    return lines
