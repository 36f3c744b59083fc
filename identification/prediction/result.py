"""The outcome of a discovery on several records, and what it rests on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from identification.discovery.attempts import Failed
from identification.discovery.effect_results import Gap, OfCandidate
from identification.discovery.findings.finding import Finding
from identification.discovery.findings.records_evidence import ShiftedRecord
from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Candidate, Effect
from identification.prediction.model import WindowModel
from identification.prediction.proof import Doubt
from identification.prediction.record_errors import RecordError
from identification.prediction.records import Record
from identification.prediction.scores import WindowScore
from identification.prediction.unseen import Prediction
from identification.shown import Shown

Verdict = Literal["named", "nothing missing", "unknown effect", "unlisted effect"]


@dataclass(frozen=True, kw_only=True)
class RefittedEffect(OfCandidate):
    """An effect as it was refitted, and what it does for unseen records.

    Attributes:
        candidate: effect, place, and shapes as estimated.
        parameters: its sizes and shapes by name: value, std, unit.
        prediction: of unseen records, over the model without it.
        criterion: by how much it raises the negative BIC on the fitted windows.
        confidence: its share of the odds among its rivals, 0 to 1 (`prediction.evidence`).
        doubt: why it is not proven; None where it is.
    """

    candidate: Candidate
    parameters: Mapping[str, tuple[float, float, str]]
    prediction: Prediction
    criterion: float
    confidence: float
    doubt: Doubt | None


@dataclass(frozen=True, kw_only=True)
class NamedByPrediction(OfCandidate):
    """An effect that is missing from the nominal model.

    Attributes:
        effect: as it was refitted, its values those of the final model.
        rivals: other effects that were refitted in its place and are not much worse.
        compared: how many others were refitted in its place and compared with it; where there are
            none, its confidence is the upper limit.
        one_of: whether the records cannot tell it from its first rival.
        same_as: the effect that is the same force by another name, so that no record tells which
            it is (`prediction.twins`); None where there is none.
        agrees: names of the records on which it lowers the error.
        disagrees: names of the records on which it raises the error, beyond chance.
    """

    effect: RefittedEffect
    rivals: tuple[RefittedEffect, ...]
    compared: int
    one_of: bool
    same_as: Effect | None
    agrees: tuple[str, ...]
    disagrees: tuple[str, ...]

    @property
    def candidate(self) -> Candidate:
        """Effect, place, and shapes as estimated."""
        return self.effect.candidate

    @property
    def parameters(self) -> Mapping[str, tuple[float, float, str]]:
        """Its sizes and shapes by name: value, std, unit."""
        return self.effect.parameters

    @property
    def confidence(self) -> float:
        """Its share of the odds among its rivals, 0 to 1."""
        return self.effect.confidence


@dataclass(frozen=True, kw_only=True, repr=False)
class RecordsDiscovery(Shown):
    """The outcome.

    Attributes:
        records: what was fitted and what confirmed.
        options: the judgement constants that were used.
        horizon: over which records were predicted [s].
        verdict: the outcome in a word.
        named: the missing effects, in the order in which they were found.
        rejected: effects that were refitted beside them and not proven, the best first.
        share: of the mean square above the sensors' noise on unseen records, how much the named
            effects take away, 0 to 1.
        unexplained: whether something is left that no named effect explains.
        noise_rms: of the sensors, over all outputs, in `unit`.
        noise_by_unit: the same by the outputs' units, each in it.
        input_error: rms error of the inputs, constant over each window, that would make what the
            final model leaves of the fitted windows; a share of the inputs' own rms.
        unit: of errors and noise over all outputs; empty where these have several units, or none,
            and each counts in its own scale.
        before: the gap of the fitted nominal model on the records that confirm.
        after: the gap of the final model.
        errors: by record.
        nominal: the fitted model without effects.
        final: the fitted model with the named effects.
        scores: of all candidates on the nominal model, the best first.
        remaining: of the other candidates on the final model, the best first.
        findings: what the final model leaves, and what is doubtful.
        shifts: of records whose inputs look shifted in time against their outputs, fitted or not.
        repeats: names of the records that confirm, but whose motion is that of a fitted record or
            of one that confirms before them.
        seconds: wall time by kind of work [s].
        failed: what was tried and could not be evaluated.
    """

    records: tuple[Record, ...]
    options: DiscoveryOptions
    horizon: float
    verdict: Verdict
    named: tuple[NamedByPrediction, ...]
    rejected: tuple[RefittedEffect, ...]
    share: float
    unexplained: bool
    noise_rms: float
    noise_by_unit: Mapping[str, float]
    input_error: float
    unit: str
    before: Gap
    after: Gap
    errors: tuple[RecordError, ...]
    nominal: WindowModel
    final: WindowModel
    scores: tuple[WindowScore, ...]
    remaining: tuple[WindowScore, ...]
    findings: tuple[Finding, ...]
    shifts: tuple[ShiftedRecord, ...]
    repeats: tuple[str, ...]
    seconds: Mapping[str, float]
    failed: tuple[Failed, ...] = ()

    @property
    def steps(self) -> tuple[float, float]:
        """Time steps of the simulations of the nominal model and of the user's model [s]."""
        return self.nominal.steps

    @property
    def output_rms(self) -> np.ndarray:
        """Rms error of each output under the nominal model on fitted windows, shape (ny,)."""
        return self.nominal.scale
