"""The verdict that nothing is missing, and how far it goes."""

from __future__ import annotations

from collections.abc import Iterable

from identification.discovery.result import Discovery
from identification.quantities import quantity
from identification.report.discovery_errors import errors_of, floor, floor_rms, sensors
from identification.report.discovery_limits import SHOWN, hiding, smallest, split_detectable
from identification.report.effect_words import describe_effect, phrase
from identification.report.error_words import error_words


def nothing(found: Discovery) -> str:
    """Returns the paragraph that says that nothing is missing, as far as this log can tell."""
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
    """Returns a sentence on input errors that count as noise, on which the verdict rests."""
    level, log = found.final.level, found.log
    (alone,) = error_words([sensors(found)], "")
    if not log.inputs.any():
        return (
            f" The sensors alone make {alone}; the rest is what unlogged forces on the joints do,"
            f" for {level.noise.time:.2g} s at a time. If surely none act, something is missing."
        )
    size = quantity(level.input_std, unit=log.units.get(log.input_names[0], ""))
    return (
        f" The sensors alone make {alone}; the rest is what inputs do that err by {size} rms"
        f" beside what the log says, for {level.noise.time:.2g} s at a time. If they are surely"
        " known better, something is missing."
    )


def _unique(names: Iterable[str]) -> list[str]:
    return list(dict.fromkeys(names))
