"""Findings of a discovery over a horizon in words, a clause for each kind."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from identification.discovery.findings import records_evidence
from identification.discovery.findings.finding import FindingKind
from identification.quantities import quantity
from identification.report.effect_words import without_colon

DOUBTS = {
    "numbers": "its gain does not pay for its numbers",
    "chance": "with as many effects tried, its gain may be luck",
    "lengths": "windows of some length are predicted worse with it",
    "record": "a record is predicted worse with it",
    "little": "it takes away too little to matter over windows of some length",
    "size": "its size is not known well enough to differ from zero",
    "bound": "its size ends on the bound beyond which it is not believed, so that it stands for"
    " something else",
    "exchange": "where the other records are fitted instead, it predicts a record worse, or all of"
    " them on average",
    "drawn": "a curve of the data at the same joint does the same, and more",
    "curve": "it was found beside a curve of the data, which leaves what its nodes cannot draw",
}


def _different_record(e: records_evidence.DifferentRecord) -> str:
    return (
        f"record {e.record} is predicted {e.ratio:.2g} times worse than the others (rms of windows,"
        " geometric means): something is different in it; look at it, or leave it out"
    )


def _shifted_record(e: records_evidence.ShiftedRecord) -> str:
    return (
        f"record {e.record} looks as if its inputs acted {describe_shift(e)} than their time stamps"
        f" say, which takes {100 * e.fall:z.0f} % off its mean square; check how it was logged, and"
        " shift its inputs if that is so"
    )


def describe_shift(e: records_evidence.ShiftedRecord) -> str:
    """Returns in words how much later or earlier the inputs of a record seem to act."""
    return f"{quantity(abs(e.shift), e.std, 's')} {'later' if e.shift > 0 else 'earlier'}"


def _worse_fit(e: records_evidence.WorseFit) -> str:
    return (
        "without effects the fitted values predicted unseen data worse than those of the model"
        f" (mean square {100 * e.rise:+z.0f} %), so that the search began with the latter"
    )


def _remaining_error(e: records_evidence.RemainingError) -> str:
    of = f" of {e.output}" if e.output else ""
    noise = "its sensor's noise" if e.output else "the sensors' noise"
    return (
        f"an error{of} on unseen data that is {e.noise_ratio:.3g} times {noise} is left, and no"
        " candidate explains it"
    )


def _unproven_effect(e: records_evidence.UnprovenEffect) -> str:
    return (
        f"{without_colon(e.phrase)}, {e.where}, predicts unseen data better on average (mean"
        f" square {-100 * e.fall:+z.0f} %, t = {e.t:z.1f}), but is not proven: {DOUBTS[e.doubt]}"
    )


RECORDS_WORDS: dict[FindingKind, Callable[[Any], str]] = {
    FindingKind.REMAINING_ERROR: _remaining_error,
    FindingKind.DIFFERENT_RECORD: _different_record,
    FindingKind.SHIFTED_RECORD: _shifted_record,
    FindingKind.WORSE_FIT: _worse_fit,
    FindingKind.UNPROVEN_EFFECT: _unproven_effect,
}
