"""One finding of every kind, its evidence written by hand."""

from fake_discovery import LATE, REJECTED, score_of

from identification.discovery.findings import evidence, records_evidence
from identification.discovery.findings.finding import Finding, FindingKind

EVIDENCE_OF = {
    FindingKind.WORST_OUTPUT: evidence.WorstOutput("angle_5", "rad", 0.0143, 0.16, 20.6),
    FindingKind.WORST_INTERVAL: evidence.WorstInterval(2.0, 3.0, 0.25),
    FindingKind.MEDIAN_FREQUENCY: evidence.MedianFrequency(0.4),
    FindingKind.MISSING_FORCE: evidence.ForceEvidence(
        where="platform", units=("N", "N m"), rms=(0.0049, 3.1e-4), share=0.97,
        regressor="rate near zero", regressor_share=0.31,
    ),
    FindingKind.INPUT_HOLD: evidence.InputHold("foh", "A", 2e-3, 0.05),
    FindingKind.SPECTRAL_LINE: evidence.SpectralLine("angle_2", 2.3, 3e-9),
    FindingKind.CORRELATED_INNOVATIONS: evidence.CorrelatedInnovations(0.26, 1e-20),
    FindingKind.PARAMETERS_AT_LIMIT: evidence.ParametersAtLimit(("b_v", "J")),
    FindingKind.LARGE_INPUT_ERROR: evidence.LargeInputError("A", 0.09, 0.35, 0.12),
    FindingKind.ROBOT_CHANGE: evidence.RobotChange(2.4, 10.5),
    FindingKind.UNEXPECTED_ERROR: evidence.UnexpectedError(9.4),
    FindingKind.STRUCTURED_INPUT_ERROR: evidence.StructuredInputError(
        "output rate", "current_3", "A", 0.004, 0.4
    ),
    FindingKind.DOUBTFUL_EFFECT: evidence.DoubtfulEffect(REJECTED),
    FindingKind.UNTRIED_EFFECT: evidence.UntriedEffect(score_of(LATE, 0.1, 412.0)),
    FindingKind.OVERSIZED_EFFECT: evidence.OversizedEffect(
        score_of(LATE, 0.3, 412.0), {"tau": 0.1}
    ),
    FindingKind.REMAINING_ERROR: records_evidence.RemainingError(7.1, "x", ("c.csv",)),
    FindingKind.DIFFERENT_RECORD: records_evidence.DifferentRecord("c.csv", 4.2, 1e-6),
    FindingKind.SHIFTED_RECORD: records_evidence.ShiftedRecord("c.csv", -0.014, 0.003, 0.3, 1e-5),
    FindingKind.WORSE_FIT: records_evidence.WorseFit(7.96),
    FindingKind.UNPROVEN_EFFECT: records_evidence.UnprovenEffect(
        "com_offset", "body: centre of mass displaced", "body arm", 0.2, 1.9, "chance"
    ),
}  # fmt: skip
FINDINGS = tuple(Finding(kind, EVIDENCE_OF[kind]) for kind in FindingKind)
