"""Sentences of a discovery that names nothing: the noise explains the error, or it does not."""

from __future__ import annotations

from math import isfinite

from identification.discovery.result import Discovery
from identification.quantities import held, quantity
from identification.report.discovery.shown_words import SHOWN
from identification.report.words.effects import describe_effect
from identification.report.words.errors import error_words
from identification.report.words.parts import unseen_of
from identification.report.words.rest import are_all_resting
from identification.report.words.values import phrase
from identification.shares import HELD, decimal, ratio_of, times

NO_ERROR = 1e-3  # of the inputs' rms: less is not told from none
NOISIER = 1.5  # times the rms noise of the other outputs of its unit: more is told


def is_above_noise(found: Discovery) -> bool:
    """Tells whether the nominal model's error on unseen data is more than noise makes."""
    return _is_above_sensors(found) or found.before.rms > NOISIER * found.floor_rms > 0


def _is_above_sensors(found: Discovery) -> bool:
    """Tells whether it is more than sensors make, where nothing else is known to disturb."""
    ratio = found.before.rms / found.noise_rms if found.noise_rms else 1.0
    is_noise = found.unlogged is not None or found.input_error < NO_ERROR
    is_more = ratio**2 > 1 + found.options.min_gap_share
    return not is_noise and is_more and found.unexplained


def errors_left(found: Discovery) -> tuple[str, str, str]:
    """Returns what the nominal model leaves on unseen data, the noise, and that of the sensors."""
    errors = [found.errors_of(found.before), found.floor, found.sensors]
    sizes = error_words(errors, "")
    return error_words(errors)[0], sizes[1], sizes[2]


def nothing_sentence(found: Discovery) -> str:
    """Returns the paragraph: nothing is missing, or no effect is named as no candidate helps."""
    left, noise, alone = errors_left(found)
    where = unseen_of(found)
    if _is_above_sensors(found):
        ratio, no_input = found.before.rms / found.noise_rms, not isfinite(found.input_error)
        either = "No input that moves is a force, which might err. Something is"
        if not no_input:
            size = ratio_of(found.input_error, "their rms")
            either = f"Either the inputs err by {size}, or something is"
        return (
            f"No effect is named: no candidate lowers the error of prediction on unseen data{where}"
            f" beyond chance. This error is {left}{found.over}, {held(ratio)} times the sensors'"
            f" noise of {alone}. {either} missing that no candidate explains."
        )
    unseen = [d for d in found.detectable if not d.is_plausible]
    seen = [d for d in found.detectable if d.is_plausible]
    seen.sort(key=lambda d: d.smallest / d.largest)  # the easiest to find first
    who = f"the sensors{' and unlogged disturbances' if found.unlogged else ''}"
    if is_above_noise(found):
        said = (
            f"No effect is named: no candidate lowers the error on unseen data{where} beyond"
            f" chance. But this error is {left}{found.over},"
            f" {times(found.before.rms / found.floor_rms)} the"
            f" {noise} that {who} cause, so that noise does not explain all of it. Either something"
            " is missing that no candidate explains, or the robot does something in the unseen data"
            " that the fitted data never show."
        )
    else:
        said = (
            f"Nothing is missing{_as_far(found)}:"
            f" the error of the fitted model on unseen data{where} is noise. It is"
            f" {left}{found.over}, and {who} cause {noise}."
        )
        said += _rest(found, alone)
    if seen:
        listed = "; ".join(
            f"{describe_effect(d.candidate)}, {d.size} {quantity(d.smallest, unit=d.unit)}"
            for d in seen[:SHOWN]
        )
        said += f" In 9 cases of 10 this log would have shown effects as small as: {listed}."
    if unseen:
        names = dict.fromkeys(phrase(d.candidate.effect) for d in unseen)
        said += f" It would not show these effects at any plausible size: {'; '.join(names)}."
    return said


def _as_far(found: Discovery) -> str:
    """Returns how far data can tell that nothing is missing; "" where what they show follows."""
    if are_all_resting(found):
        return ", as far as data can tell in which the robot hardly moves"
    return "" if found.detectable else ", as far as these data can tell"


def _rest(found: Discovery, alone: str) -> str:
    """Returns sentences on what makes the error that sensors, which make `alone`, do not."""
    unlogged = found.unlogged
    if unlogged is None:
        if found.input_error < NO_ERROR:
            return " The noise of the sensors alone explains it."
        if not isfinite(found.input_error):
            return ""
        size = ratio_of(found.input_error, "their rms")
        return f" Inputs that err by {size} would explain the rest."
    if not found.floor_rms > found.noise_rms:
        return ""
    lasts = f"lasting about {decimal(unlogged.time, HELD)} s"
    if not unlogged.is_of_inputs:
        return (
            f" The sensors alone cause {alone}. Forces on the joints that are not in the log"
            f" ({lasts}) explain the rest. If you are sure that no such forces act, something is"
            " missing."
        )
    return (
        f" The sensors alone cause {alone}. Errors of the inputs that are not in the log"
        f" ({quantity(unlogged.rms, unit=unlogged.unit)} rms, {lasts}) explain the rest. If you"
        " are sure that the inputs are more accurate, something is missing."
    )
