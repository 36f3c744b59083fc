"""The verdict of a discovery in sentences, and what supports it."""

from __future__ import annotations

from math import isfinite

from identification.discovery.effect_results import RejectedEffect
from identification.discovery.final_values import list_at_bound
from identification.discovery.fitted_model import is_proven
from identification.discovery.result import Discovery
from identification.quantities import held
from identification.report.bound_words import bound_sentences
from identification.report.discovery_errors import (
    closed_share,
    errors_of,
    floor,
    floor_rms,
    off,
    sensors,
    times_noise,
)
from identification.report.discovery_limits import hiding
from identification.report.effect_words import (
    describe_chance,
    describe_effect,
)
from identification.report.error_words import change_words
from identification.report.finding_words import describe_finding, sentence
from identification.report.named_words import named_sentences
from identification.report.nothing_words import nothing
from identification.shown import verdict_of


@verdict_of.register
def discovery_verdict(found: Discovery) -> list[str]:
    """Returns sentences: the verdict first, then what supports it."""
    own = list_at_bound(found.final, found.nominal.point.space.names)
    bounds = bound_sentences(found.final.point.predictor.plant.parameters, own)
    return [*_verdict(found), *bounds, *_unlike(found)]


def _unlike(found: Discovery) -> list[str]:
    """Returns a sentence where outputs have several units."""
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
    said = [named_sentences(found, named) for named in found.named]
    said.append(_proof(found))
    if found.unexplained:
        said.append(unexplained(found))
    elif found.hidden:
        said.append(f"Nothing else is missing that this log shows.{hiding(found)}")
    return said


def unknown(found: Discovery) -> str:
    """Returns the paragraph that says that something is missing which no known effect explains."""
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
    """Returns the paragraph on what is left after the named effects."""
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
    """Returns a sentence on what was refitted, is beyond chance, and is not named."""
    fall = 100 * rejected.proof.fall
    free_run = f"{'falls' if fall >= 0 else 'rises'} by {abs(fall):.2g} %"
    return (
        f"Nearest comes {describe_effect(rejected.candidate)}: it predicts each next unseen sample"
        f" better ({describe_chance(rejected.proof)}), and with it the mean square of the free run"
        f" {free_run}. It is too small to matter, or not the likeliest."
    )


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
