"""The verdict of a discovery in sentences, and what supports it."""

from __future__ import annotations

from collections.abc import Iterable
from math import isfinite

from identification.discovery.effect_results import NamedEffect, RejectedEffect
from identification.discovery.fitted_model import is_proven
from identification.discovery.result import Discovery
from identification.quantities import held, quantity
from identification.report.discovery_errors import (
    closed_share,
    errors_of,
    floor,
    floor_rms,
    off,
    sensors,
    times_noise,
)
from identification.report.discovery_limits import SHOWN, hiding, smallest, split_detectable
from identification.report.effect_words import (
    describe_chance,
    describe_effect,
    describe_outside,
    describe_sizes,
    phrase,
)
from identification.report.error_words import change_words, error_words
from identification.report.finding_words import describe_finding, sentence
from identification.report.parameter_words import words_of

RETUNED = 0.05  # the explanation without an effect gets a sentence above this confidence


def discovery_verdict(found: Discovery) -> list[str]:
    """The verdict first, then what supports it."""
    return [*_verdict(found), *_unlike(found)]


def _unlike(found: Discovery) -> list[str]:
    """A sentence where outputs have several units."""
    if len(units := errors_of(found.before, found)) < 2:
        return []
    return [
        f"The outputs have several units ({', '.join(unit or 'none' for unit in units)}), and a"
        " free run counts an error of 1 in each of them alike, with one noise for all: give the"
        " nominal model a horizon, over which each output counts in its own scale."
    ]


def _verdict(found: Discovery) -> list[str]:
    if found.verdict == "nothing missing":
        return [nothing(found)]
    if found.verdict == "unknown effect":
        return [unknown(found)]
    said = [
        f"{_named(found, named)}{_retuned(found, named)}{_outside(named)}{_agreement(named)}"
        for named in found.named
    ]
    said.append(_proof(found))
    if found.unexplained:
        said.append(unexplained(found))
    elif found.hidden:
        said.append(f"Nothing else is missing that this log shows.{hiding(found)}")
    return said


def nothing(found: Discovery) -> str:
    """The paragraph that says that nothing is missing, as far as this log can tell."""
    seen, unseen = split_detectable(found.detectable)
    left = error_words([errors_of(found.before, found), floor(found)])[0]
    noise = error_words([errors_of(found.before, found), floor(found)], "")[1]
    said = (
        "Nothing is missing: what the fitted model leaves unexplained is noise,"
        f" {left} on unseen data where the sensors and unlogged disturbances make {noise}."
    )
    if floor_rms(found) > found.noise_rms:
        said += _unlogged(found)
    if seen:
        listed = "; ".join(f"{describe_effect(d.candidate)}, {smallest(d)}" for d in seen[:SHOWN])
        said += f" The log would have shown, in 9 cases of 10, effects as small as: {listed}."
    said += hiding(found)
    if unseen:
        names = _unique(phrase(d.candidate.effect) for d in unseen)
        said += f" No plausible size would show in it of these: {'; '.join(names)}."
    return said


def _unlogged(found: Discovery) -> str:
    """The errors of the inputs that are part of the noise, and on which the verdict rests."""
    level, log = found.final.level, found.log
    (alone,) = error_words([sensors(found)], "")
    size = quantity(level.input_std, unit=log.units.get(log.input_names[0], ""))
    return (
        f" The sensors alone make {alone}; the rest is what inputs do that err by {size} rms"
        f" beside what the log says, for {level.noise.time:.2g} s at a time. If they are surely"
        " known better, something is missing."
    )


def unknown(found: Discovery) -> str:
    """The paragraph that says that something is missing which no known effect explains."""
    tried = len({s.candidate.effect.name for s in found.scores})
    ratio = times_noise(found.before, found)
    return " ".join(
        [
            f"Something is missing that none of the {tried} known effects surely explains: the"
            f" fitted model is {off(found.before, found)} on unseen data"
            + (f", {held(ratio)} times the sensors' noise." if isfinite(ratio) else "."),
            "It is not named here rather than named wrongly.",
            *(sentence(describe_finding(f)) for f in (*found.findings, *found.located)),
        ]
    )


def unexplained(found: Discovery) -> str:
    """The paragraph on what is left after the named effects."""
    more = "what is named" if len(found.named) == 1 else "all that is named"
    ratio = times_noise(found.after, found)
    times = f", {held(ratio)} times the noise" if 1 < ratio < float("inf") else ""
    proven = [r for r in found.rejected if r.gain > 0 and is_proven(r.proof, found.options)]
    return " ".join(
        [
            f"Something is left beside {more} that no known effect surely explains: the model is"
            f" still {off(found.after, found)} on unseen data{times}.",
            *(sentence(describe_finding(f)) for f in found.findings),
            *map(_nearest, proven[:1]),
        ]
    )


def _nearest(rejected: RejectedEffect) -> str:
    """A sentence on what was refitted, is beyond chance, and is not named."""
    fall = 100 * rejected.proof.fall
    free_run = f"{'falls' if fall >= 0 else 'rises'} by {abs(fall):.2g} %"
    return (
        f"Nearest comes {describe_effect(rejected.candidate)}: it predicts each next unseen sample"
        f" better ({describe_chance(rejected.proof)}), and with it the mean square of the free run"
        f" {free_run}. It is too small to matter, or not the likeliest."
    )


def _named(found: Discovery, named: NamedEffect) -> str:
    """A sentence on a named effect, or on the set that it belongs to where it is `one_of`."""
    first = "Missing from the model" if named is found.named[0] else "Missing too"
    if named.one_of and named.rivals:
        rivals = [r for r in named.rivals if r.confidence >= 0.1 * named.confidence] or [
            named.rivals[0]
        ]
        total = named.confidence + sum(r.confidence for r in rivals)
        each = "; ".join(
            [f"{describe_effect(named.candidate)} ({100 * named.confidence:.0f} %)"]
            + [f"{describe_effect(r.candidate)} ({100 * r.confidence:.0f} %)" for r in rivals]
        )
        return (
            f"{first} is one of these, which this log does not surely tell apart: {each};"
            f" together {_percent(total)}. The first is put into the model:"
            f" {describe_sizes(named)}." + (f" {named.advice}" if named.advice else "")
        )
    return (
        f"{first}: {describe_effect(named.candidate)}, {describe_sizes(named)}"
        f"; confidence {100 * named.confidence:.0f} % among the known effects"
        + ("." if named.rivals else ", none of which was near enough to be refitted in its place.")
    )


def _retuned(found: Discovery, named: NamedEffect) -> str:
    """A sentence where a parameter farther from what was known of it would explain the same."""
    other = named.retuned
    if other.confidence < RETUNED:
        return ""
    what = words_of(found)[other.parameter]
    return (
        f" Or it is no effect ({100 * other.confidence:.0f} %): with {what}"
        f" {abs(other.distance):.2g} std {'above' if other.distance > 0 else 'below'} what was said"
        " to be known of it, the model explains the same. Measure it, or record another motion."
    )


def _outside(named: NamedEffect) -> str:
    """A sentence where a law that no catalogue lists may explain the same."""
    if named.outside is None or named.outside.confidence < RETUNED:
        return ""
    return f" Or it is {describe_outside(named.outside)}."


def _agreement(named: NamedEffect) -> str:
    """On which of several records the effect holds."""
    proof = named.proof
    said = f" It holds on {', '.join(proof.agrees)}." if len(proof.agrees) > 1 else ""
    if proof.disagrees:
        said += f" It raises the error on {', '.join(proof.disagrees)}, beyond chance."
    return said


def _proof(found: Discovery) -> str:
    errors = errors_of(found.before, found), errors_of(found.after, found)
    change, (noise, own) = change_words(*errors, [floor(found), sensors(found)])
    whom = "it" if len(found.named) == 1 else "them"
    rest = f", of which sensors make {own} and unlogged errors of the inputs the rest"
    made = rest if floor_rms(found) > found.noise_rms else ""
    said = (
        f"On data that the fit has not seen, the error falls {change}"
        f" with {whom} in the model; the noise is {noise}{made}."
    )
    if (share := closed_share(found)) is not None:
        nearly = share > 0.995 and times_noise(found.after, found) > 1
        percent = "more than 99" if nearly else f"{100 * share:.0f}"
        said += f" That is {percent} % of the power that was above the noise."
    return said


def diff_line(named: NamedEffect) -> str:
    """A named effect as a line of a diff of the model."""
    return f"+ {describe_effect(named.candidate)}: {describe_sizes(named)}"


def _percent(chance: float) -> str:
    """A probability in percent; rounding makes no certainty of it."""
    return "more than 99 %" if chance > 0.995 else f"{100 * chance:.0f} %"


def _unique(names: Iterable[str]) -> list[str]:
    return list(dict.fromkeys(names))
