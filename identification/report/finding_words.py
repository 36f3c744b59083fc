"""Findings in words: one clause for each kind, which can be joined with others or be a sentence."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from identification.discovery.findings import evidence, records_evidence
from identification.discovery.findings.finding import Finding, FindingKind
from identification.discovery.impossible import IMPOSSIBLE
from identification.quantities import alike, error, probability, quantity
from identification.report.effect_words import (
    describe_chance,
    describe_effect,
    describe_sizes,
    doubt_words,
)
from identification.report.value_words import without_colon
from identification.shares import HELD, change, decimal, fall_words, percent, ratio_of, times

HOLDS = {"foh": "ran in straight lines between their samples", "zoh": "kept each sample's value"}
FOLLOWED = {  # by an error of the inputs: keys of `input_error.list_families`
    "other inputs": "the other inputs",
    "own input": "its own input",
    "output": "its output",
    "output rate": "the rate of its output",
    "output and direction": "its output, with another sign in each direction",
}
REGRESSORS = {  # of a missing force: keys of `location.list_regressors`
    "time": "time",
    "input": "its input",
    "rate sign": "the sign of its rate",
    "rate": "its rate",
    "rate size": "the size of its rate",
    "rate near zero": "its rate near zero",
    "rate squared": "the square of its rate",
    "position": "its position",
}


def describe_finding(finding: Finding) -> str:
    """Returns a finding as a clause, without a capital and without a full stop."""
    return WORDS[finding.kind](finding.evidence)


def sentence(clause: str) -> str:
    """Returns a clause as a sentence."""
    end = "" if clause.endswith((".", "!", "?")) else "."
    return clause[:1].upper() + clause[1:] + end


def _worst_output(e: evidence.WorstOutput) -> str:
    return (
        f"on the fitted samples the error is largest on {e.output}: {quantity(e.rms, unit=e.unit)}"
        f" rms, {percent(e.share)} of the power over all outputs, {times(e.noise_ratio)} the"
        " sensors' noise"
    )


def _worst_interval(e: evidence.WorstInterval) -> str:
    share = percent(e.share)
    return f"the error is largest from {e.start:.1f} to {e.end:.1f} s ({share} of its power)"


def _median_frequency(e: evidence.MedianFrequency) -> str:
    return f"half of the power of the error lies below {e.frequency:.2g} Hz"


def _missing_force(e: evidence.ForceEvidence) -> str:
    sizes = " and ".join(map(error, e.rms, e.units))
    said = (
        f"generalised forces of {sizes} rms on {e.where} would explain {percent(e.share)} of the"
        " error"
    )
    if e.regressor is None:
        return said
    follows = f"{percent(e.regressor_share)} of their power follows {REGRESSORS[e.regressor]}"
    return f"{said}, and {follows}"


def _input_hold(e: evidence.InputHold) -> str:
    then, now = alike([e.rms, e.rms_now], e.unit)
    return (
        f"if the inputs {HOLDS[e.hold]}, they would have to err by only {then} rms and not by {now}"
        f' (if they did, write hold = "{e.hold}" into the log\'s TOML)'
    )


def _spectral_line(e: evidence.SpectralLine) -> str:
    return (
        f"the innovations of {e.output} have a line at {e.frequency:.2f} Hz that no candidate"
        f" explains (chance {probability(e.p_value)})"
    )


def _correlated_innovations(e: evidence.CorrelatedInnovations) -> str:
    return (
        f"the innovations are not white: {percent(e.share)} of their power follows from the"
        f" samples before (chance {probability(e.p_value)})"
    )


def _parameters_at_limit(e: evidence.ParametersAtLimit) -> str:
    names = " and ".join(e.parameters)
    end = f"parameters {names} end" if len(e.parameters) > 1 else f"parameter {names} ends"
    return f"the {end} at the limit of what is plausible for the given nominal values"


def _large_input_error(e: evidence.LargeInputError) -> str:
    return (
        f"the inputs would need errors that are not in the log, {quantity(e.rms, unit=e.unit)} rms"
        f" ({ratio_of(e.share, 'their own motion')}), lasting about"
        f" {decimal(e.correlation_time, HELD)} s"
    )


def _robot_change(e: evidence.RobotChange) -> str:
    return (
        f"from about {decimal(e.time, 3)} s on the unseen samples are predicted worse than the"
        f" fitted ones (errors one sample ahead are {times(e.ratio)} as large): the robot changed,"
        " or it does something there that the fitted samples never show"
    )


def _unexpected_error(e: evidence.UnexpectedError) -> str:
    return (
        f"the error of the free run on unseen data is {decimal(e.ratio, HELD)} times what the"
        " sensors, unlogged disturbances and the std of the fitted values explain: the robot has"
        " changed there, or it does something there that the fitted samples never show"
    )


def _structured_input_error(e: evidence.StructuredInputError) -> str:
    return (
        f"an unlogged error of the inputs, {quantity(e.rms, unit=e.unit)} rms, is not random:"
        f" it follows {FOLLOWED[e.regressor]}, most of all on {e.input}, and with it the mean"
        f" square on unseen data {fall_words(e.fall)}"
    )


def _doubtful_effect(e: evidence.DoubtfulEffect) -> str:
    r, told = e.rejected, e.rejected.proof.told
    return (
        f"{describe_effect(r.candidate)}, {describe_sizes(r)}, explains the fitted samples"
        f" beyond chance and {percent(told.fall)} of the error on unseen data, but is not"
        f" proven there ({describe_chance(r.proof)})"
    )


def _oversized_effect(e: evidence.OversizedEffect) -> str:
    units = {s.name: s.unit for s in e.score.candidate.effect.sizes}
    values = dict(zip(units, e.score.size, strict=True))
    said = ", ".join(
        f"{name} = {quantity(values[name], unit=units[name])} where"
        f" {quantity(limit, unit=units[name])} is the largest plausible value"
        for name, limit in e.limits.items()
    )
    return (
        f"{describe_effect(e.score.candidate)}, would explain more than what is named (gain"
        f" {e.score.explains:z.4g}), but only with {said}"
    )


def _different_record(e: records_evidence.DifferentRecord) -> str:
    if len(e.others) == 1:
        return (
            f"record {e.record} is predicted {times(e.ratio)} worse than record {e.others[0]} (rms"
            " of windows, geometric means): something differs between the two, such as a load, a"
            " force or a zero of a sensor that changed, or a motion that only one of them makes"
        )
    return (
        f"record {e.record} is predicted {times(e.ratio)} worse than the others (rms of windows,"
        " geometric means): something is different in it; look at it, or leave it out"
    )


def _shifted_record(e: records_evidence.ShiftedRecord) -> str:
    return (
        f"the inputs of record {e.record} seem to act {describe_shift(e)} than their time stamps"
        f" say: with this shift its mean square falls by {percent(e.fall)}; check how it was"
        " logged, and shift its inputs if this is right"
    )


def describe_shift(e: records_evidence.ShiftedRecord) -> str:
    """Returns in words how much later or earlier the inputs of a record seem to act."""
    return f"{quantity(abs(e.shift), e.std, 's')} {'later' if e.shift > 0 else 'earlier'}"


def _worse_fit(e: records_evidence.WorseFit) -> str:
    return (
        "without effects the fitted values predicted unseen data worse than those of the model"
        f" (mean square {change(e.rise)}), so that the search began with the model's values"
    )


def _remaining_error(e: records_evidence.RemainingError) -> str:
    of = f" of {e.output}" if e.output else ""
    noise = "its sensor's noise" if e.output else "the sensors' noise"
    return (
        f"an error{of} on unseen data that is {times(e.noise_ratio)} {noise} is left, and no"
        " candidate explains it"
    )


def _unproven_effect(e: records_evidence.UnprovenEffect) -> str:
    return (
        f"{without_colon(e.phrase)}, {e.where}, predicts unseen data better on average (mean"
        f" square {change(-e.fall)}, t = {e.t:z.1f}), but is not"
        f" {'believed' if e.doubt in IMPOSSIBLE else 'proven'}: {doubt_words(e.doubt, e.luck)}"
    )


WORDS: dict[FindingKind, Callable[[Any], str]] = {
    FindingKind.WORST_OUTPUT: _worst_output,
    FindingKind.WORST_INTERVAL: _worst_interval,
    FindingKind.MEDIAN_FREQUENCY: _median_frequency,
    FindingKind.MISSING_FORCE: _missing_force,
    FindingKind.INPUT_HOLD: _input_hold,
    FindingKind.SPECTRAL_LINE: _spectral_line,
    FindingKind.CORRELATED_INNOVATIONS: _correlated_innovations,
    FindingKind.PARAMETERS_AT_LIMIT: _parameters_at_limit,
    FindingKind.LARGE_INPUT_ERROR: _large_input_error,
    FindingKind.ROBOT_CHANGE: _robot_change,
    FindingKind.UNEXPECTED_ERROR: _unexpected_error,
    FindingKind.STRUCTURED_INPUT_ERROR: _structured_input_error,
    FindingKind.DOUBTFUL_EFFECT: _doubtful_effect,
    FindingKind.OVERSIZED_EFFECT: _oversized_effect,
    FindingKind.REMAINING_ERROR: _remaining_error,
    FindingKind.DIFFERENT_RECORD: _different_record,
    FindingKind.SHIFTED_RECORD: _shifted_record,
    FindingKind.WORSE_FIT: _worse_fit,
    FindingKind.UNPROVEN_EFFECT: _unproven_effect,
}
