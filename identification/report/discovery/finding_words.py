"""Findings in words: one clause for each kind, which can be joined with others or be a sentence."""

from __future__ import annotations

from identification.discovery.findings import evidence as free
from identification.discovery.findings import records_evidence as of_records
from identification.discovery.findings.finding import Finding
from identification.discovery.impossible import IMPOSSIBLE
from identification.quantities import alike, error, probability, quantity
from identification.report.words.effects import (
    describe_chance,
    describe_effect,
    describe_sizes,
    doubt_words,
)
from identification.report.words.parts import records_words
from identification.report.words.values import without_colon
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


def sentence(clause: str) -> str:
    """Returns a clause as a sentence."""
    end = "" if clause.endswith((".", "!", "?")) else "."
    return clause[:1].upper() + clause[1:] + end


def describe_shift(e: of_records.ShiftedRecord) -> str:
    """Returns in words how much later or earlier the inputs of a record seem to act."""
    return f"{quantity(abs(e.shift), e.std, 's')} {'later' if e.shift > 0 else 'earlier'}"


def describe_finding(finding: Finding) -> str:
    """Returns a finding as a clause, without a capital and without a full stop."""
    match finding.evidence:
        case free.WorstOutput() as e:
            return (
                f"on the fitted samples the error is largest on {e.output}:"
                f" {quantity(e.rms, unit=e.unit)} rms, {percent(e.share)} of the power over all"
                f" outputs, {times(e.noise_ratio)} the sensors' noise"
            )
        case free.WorstInterval() as e:
            share = percent(e.share)
            return (
                f"the error is largest from {e.start:.1f} to {e.end:.1f} s ({share} of its power)"
            )
        case free.MedianFrequency() as e:
            return f"half of the power of the error lies below {e.frequency:.2g} Hz"
        case free.ForceEvidence() as e:
            said = (
                f"generalised forces of {' and '.join(map(error, e.rms, e.units))} rms on"
                f" {e.where} would explain {percent(e.share)} of the error"
            )
            if e.regressor is None:
                return said
            share = percent(e.regressor_share)
            return f"{said}, and {share} of their power follows {REGRESSORS[e.regressor]}"
        case free.InputHold() as e:
            then, now = alike([e.rms, e.rms_now], e.unit)
            return (
                f"if the inputs {HOLDS[e.hold]}, they would have to err by only {then} rms and not"
                f' by {now} (if they did, write hold = "{e.hold}" into the log\'s TOML)'
            )
        case free.SpectralLine() as e:
            return (
                f"the innovations of {e.output} have a line at {e.frequency:.2f} Hz that no"
                f" candidate explains (chance {probability(e.p_value)})"
            )
        case free.CorrelatedInnovations() as e:
            return (
                f"the innovations are not white: {percent(e.share)} of their power follows from the"
                f" samples before (chance {probability(e.p_value)})"
            )
        case free.ParametersAtLimit() as e:
            names, several = " and ".join(e.parameters), len(e.parameters) > 1
            which = f"parameters {names} end" if several else f"parameter {names} ends"
            return f"the {which} at the limit of what is plausible for the given nominal values"
        case free.LargeInputError() as e:
            return (
                "the inputs would need errors that are not in the log,"
                f" {quantity(e.rms, unit=e.unit)} rms ({ratio_of(e.share, 'their own motion')}),"
                f" lasting about {decimal(e.correlation_time, HELD)} s"
            )
        case free.RobotChange() as e:
            return (
                f"from about {decimal(e.time, 3)} s on the unseen samples are predicted worse than"
                f" the fitted ones (errors one sample ahead are {times(e.ratio)} as large): the"
                " robot changed, or it does something there that the fitted samples never show"
            )
        case free.UnexpectedError() as e:
            return (
                f"the error of the free run on unseen data is {decimal(e.ratio, HELD)} times what"
                " the sensors, unlogged disturbances and the std of the fitted values explain: the"
                " robot has changed there, or it does something there that the fitted samples never"
                " show"
            )
        case free.StructuredInputError() as e:
            return (
                f"an unlogged error of the inputs, {quantity(e.rms, unit=e.unit)} rms, is not"
                f" random: it follows {FOLLOWED[e.regressor]}, most of all on {e.input}, and with"
                f" it the mean square on unseen data {fall_words(e.fall)}"
            )
        case free.DoubtfulEffect(rejected=r):
            return (
                f"{describe_effect(r.candidate)}, {describe_sizes(r)}, explains the fitted samples"
                f" beyond chance and {percent(r.proof.told.fall)} of the error on unseen data, but"
                f" is not proven there ({describe_chance(r.proof)})"
            )
        case free.UntriedEffect() as e:
            return (
                f"{describe_effect(e.score.candidate)}, would explain more than chance could by its"
                " score, but the time limit ended the search before it was fitted"
            )
        case free.OversizedEffect() as e:
            units = {s.name: s.unit for s in e.score.candidate.effect.sizes}
            values = dict(zip(units, e.score.size, strict=True))
            sizes = ", ".join(
                f"{name} = {quantity(values[name], unit=units[name])} where"
                f" {quantity(limit, unit=units[name])} is the largest plausible value"
                for name, limit in e.limits.items()
            )
            return (
                f"{describe_effect(e.score.candidate)}, would explain more than what is named (gain"
                f" {e.score.explains:z.4g}), but only with {sizes}"
            )
        case of_records.DifferentRecord(others=[other]) as e:
            return (
                f"record {e.record} is predicted {times(e.ratio)} worse than record {other} (rms of"
                " windows, geometric means): something differs between the two, such as a load, a"
                " force or a zero of a sensor that changed, or a motion that only one of them makes"
            )
        case of_records.DifferentRecord() as e:
            return (
                f"record {e.record} is predicted {times(e.ratio)} worse than the others (rms of"
                " windows, geometric means): something is different in it; look at it, or leave it"
                " out"
            )
        case of_records.ShiftedRecord() as e:
            return (
                f"the inputs of record {e.record} seem to act {describe_shift(e)} than their time"
                f" stamps say: with this shift its mean square falls by {percent(e.fall)}; check"
                " how it was logged, and shift its inputs if this is right"
            )
        case of_records.WorseFit() as e:
            return (
                "without effects the fitted values predicted unseen data worse than those of the"
                f" model (mean square {change(e.rise)}), so that the search began with the model's"
                " values"
            )
        case of_records.RemainingError() as e:
            of = f" of {e.output}" if e.output else ""
            noise = "its sensor's noise" if e.output else "the sensors' noise"
            there = f" ({records_words(e.records)})" if e.records else ""
            return (
                f"an error{of} on unseen data{there} that is {times(e.noise_ratio)} {noise} is"
                " left, and no candidate explains it"
            )
        case of_records.UnprovenEffect() as e:
            word = "believed" if e.doubt in IMPOSSIBLE else "proven"
            return (
                f"{without_colon(e.phrase)}, {e.where}, predicts unseen data better on average"
                f" (mean square {change(-e.fall)}, t = {e.t:z.1f}), but is not {word}:"
                f" {doubt_words(e.doubt, e.luck)}"
            )
