"""Findings: where a model fails and what it leaves unexplained, each a kind and its evidence.

The verdict of a discovery depends on kinds and numbers only; `identification.report.finding_words`
puts findings into sentences.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from identification.discovery.findings import evidence as records
from identification.discovery.findings.evidence import Evidence


class FindingKind(StrEnum):
    """The kinds of findings; the first four say where the nominal model fails."""

    WORST_OUTPUT = "worst output"
    WORST_INTERVAL = "worst interval"
    MEDIAN_FREQUENCY = "median frequency"
    MISSING_FORCE = "missing force"
    INPUT_HOLD = "input hold"
    SPECTRAL_LINE = "spectral line"
    NOISY_OUTPUT = "noisy output"
    CORRELATED_INNOVATIONS = "correlated innovations"
    PARAMETERS_AT_LIMIT = "parameters at limit"
    LARGE_INPUT_ERROR = "large input error"
    ROBOT_CHANGE = "robot change"
    STRUCTURED_INPUT_ERROR = "structured input error"
    DOUBTFUL_EFFECT = "doubtful effect"
    OVERSIZED_EFFECT = "oversized effect"
    REMAINING_ERROR = "remaining error"
    UNPROVEN_EFFECT = "unproven effect"
    DIFFERENT_RECORD = "different record"
    SHIFTED_RECORD = "shifted record"
    WORSE_FIT = "worse fit"


EVIDENCE: dict[FindingKind, type[Evidence]] = {
    FindingKind.WORST_OUTPUT: records.WorstOutput,
    FindingKind.WORST_INTERVAL: records.WorstInterval,
    FindingKind.MEDIAN_FREQUENCY: records.MedianFrequency,
    FindingKind.MISSING_FORCE: records.ForceEvidence,
    FindingKind.INPUT_HOLD: records.InputHold,
    FindingKind.SPECTRAL_LINE: records.SpectralLine,
    FindingKind.NOISY_OUTPUT: records.NoisyOutput,
    FindingKind.CORRELATED_INNOVATIONS: records.CorrelatedInnovations,
    FindingKind.PARAMETERS_AT_LIMIT: records.ParametersAtLimit,
    FindingKind.LARGE_INPUT_ERROR: records.LargeInputError,
    FindingKind.ROBOT_CHANGE: records.RobotChange,
    FindingKind.STRUCTURED_INPUT_ERROR: records.StructuredInputError,
    FindingKind.DOUBTFUL_EFFECT: records.DoubtfulEffect,
    FindingKind.OVERSIZED_EFFECT: records.OversizedEffect,
    FindingKind.REMAINING_ERROR: records.RemainingError,
    FindingKind.UNPROVEN_EFFECT: records.UnprovenEffect,
    FindingKind.DIFFERENT_RECORD: records.DifferentRecord,
    FindingKind.SHIFTED_RECORD: records.ShiftedRecord,
    FindingKind.WORSE_FIT: records.WorseFit,
}


@dataclass(frozen=True)
class Finding:
    """Something that a model does not explain.

    Attributes:
        kind: what it is.
        evidence: its numbers and names, of the type that `EVIDENCE` gives for the kind.
    """

    kind: FindingKind
    evidence: Evidence

    def __post_init__(self) -> None:
        if not isinstance(self.evidence, EVIDENCE[self.kind]):
            raise TypeError(f"a {self.kind} has no evidence of type {type(self.evidence).__name__}")
