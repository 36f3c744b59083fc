"""Findings: where a model fails and what it leaves unexplained, each a kind and its evidence.

The verdict of a discovery depends on kinds and numbers only;
`identification.report.discovery.finding_words` puts findings into sentences.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from identification.discovery.findings import evidence, records_evidence


class FindingKind(StrEnum):
    """The kinds of findings; the first four say where the nominal model fails."""

    WORST_OUTPUT = "worst output"
    WORST_INTERVAL = "worst interval"
    MEDIAN_FREQUENCY = "median frequency"
    MISSING_FORCE = "missing force"
    INPUT_HOLD = "input hold"
    SPECTRAL_LINE = "spectral line"
    CORRELATED_INNOVATIONS = "correlated innovations"
    PARAMETERS_AT_LIMIT = "parameters at limit"
    LARGE_INPUT_ERROR = "large input error"
    ROBOT_CHANGE = "robot change"
    UNEXPECTED_ERROR = "unexpected error"
    STRUCTURED_INPUT_ERROR = "structured input error"
    DOUBTFUL_EFFECT = "doubtful effect"
    UNTRIED_EFFECT = "untried effect"
    OVERSIZED_EFFECT = "oversized effect"
    REMAINING_ERROR = "remaining error"
    UNPROVEN_EFFECT = "unproven effect"
    DIFFERENT_RECORD = "different record"
    SHIFTED_RECORD = "shifted record"
    WORSE_FIT = "worse fit"


FindingEvidence = (
    evidence.WorstOutput
    | evidence.WorstInterval
    | evidence.MedianFrequency
    | evidence.ForceEvidence
    | evidence.InputHold
    | evidence.SpectralLine
    | evidence.CorrelatedInnovations
    | evidence.ParametersAtLimit
    | evidence.LargeInputError
    | evidence.RobotChange
    | evidence.UnexpectedError
    | evidence.StructuredInputError
    | evidence.DoubtfulEffect
    | evidence.UntriedEffect
    | evidence.OversizedEffect
    | records_evidence.RemainingError
    | records_evidence.UnprovenEffect
    | records_evidence.DifferentRecord
    | records_evidence.ShiftedRecord
    | records_evidence.WorseFit
)
EVIDENCE: dict[FindingKind, type[FindingEvidence]] = {
    FindingKind.WORST_OUTPUT: evidence.WorstOutput,
    FindingKind.WORST_INTERVAL: evidence.WorstInterval,
    FindingKind.MEDIAN_FREQUENCY: evidence.MedianFrequency,
    FindingKind.MISSING_FORCE: evidence.ForceEvidence,
    FindingKind.INPUT_HOLD: evidence.InputHold,
    FindingKind.SPECTRAL_LINE: evidence.SpectralLine,
    FindingKind.CORRELATED_INNOVATIONS: evidence.CorrelatedInnovations,
    FindingKind.PARAMETERS_AT_LIMIT: evidence.ParametersAtLimit,
    FindingKind.LARGE_INPUT_ERROR: evidence.LargeInputError,
    FindingKind.ROBOT_CHANGE: evidence.RobotChange,
    FindingKind.UNEXPECTED_ERROR: evidence.UnexpectedError,
    FindingKind.STRUCTURED_INPUT_ERROR: evidence.StructuredInputError,
    FindingKind.DOUBTFUL_EFFECT: evidence.DoubtfulEffect,
    FindingKind.UNTRIED_EFFECT: evidence.UntriedEffect,
    FindingKind.OVERSIZED_EFFECT: evidence.OversizedEffect,
    FindingKind.REMAINING_ERROR: records_evidence.RemainingError,
    FindingKind.UNPROVEN_EFFECT: records_evidence.UnprovenEffect,
    FindingKind.DIFFERENT_RECORD: records_evidence.DifferentRecord,
    FindingKind.SHIFTED_RECORD: records_evidence.ShiftedRecord,
    FindingKind.WORSE_FIT: records_evidence.WorseFit,
}


@dataclass(frozen=True)
class Finding:
    """Something that a model does not explain.

    Attributes:
        kind: what it is.
        evidence: its numbers and names, of the type that `EVIDENCE` gives for the kind.
    """

    kind: FindingKind
    evidence: FindingEvidence

    def __post_init__(self) -> None:
        if not isinstance(self.evidence, EVIDENCE[self.kind]):
            raise TypeError(f"a {self.kind} has no evidence of type {type(self.evidence).__name__}")
