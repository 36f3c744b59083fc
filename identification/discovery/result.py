"""The outcome of a discovery, and what it rests on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

import numpy as np

from identification.discovery.attempts import Failed
from identification.discovery.effect_results import (
    Detectable,
    Gap,
    Hidden,
    NamedEffect,
    RejectedEffect,
)
from identification.discovery.findings.finding import Finding
from identification.discovery.findings.location import locate_error
from identification.discovery.missing_forces import MissingForce, estimate_missing_forces
from identification.discovery.options import DiscoveryOptions
from identification.discovery.scoring.scores import Score
from identification.kalman.refit import Refit
from identification.logs.log import Log
from identification.shown import Shown

Verdict = Literal["named", "nothing missing", "unknown effect"]


@dataclass(frozen=True, kw_only=True, repr=False)
class Discovery(Shown):
    """The outcome of a discovery.

    Attributes:
        log: the whole log of N samples; its part `estimation` was fitted, the rest is unseen.
        options: the judgement constants that were used.
        verdict: the outcome in a word.
        named: the missing effects, in the order in which they were found.
        rejected: effects that were refitted beside the named ones and not accepted, the best first.
        unexplained: whether something is left that no named effect explains.
        noise_rms: rms of the sensors' noise, estimated from the data, in the outputs' unit.
        disturbance_rms: rms of what unlogged input errors do to the free run, by the noise model;
            zero where these errors are not random.
        noise_by_unit: what the filter leaves of the fitted samples, one step ahead, by the outputs'
            units, each in it.
        disturbance_by_unit: `disturbance_rms` likewise.
        before: the gap of the fitted nominal model.
        after: the gap of the model with the named effects.
        nominal: the fit without effects.
        final: the fit with the named effects.
        predicted_before: free run of the nominal fit over the whole log, shape (N, ny), in the
            outputs' units.
        predicted_after: free run of the final fit, shape (N, ny), in the outputs' units.
        scores: of all candidates on the nominal fit, the best first.
        remaining: of the other candidates on the final fit, the best first.
        detectable: the smallest effects that this log would have shown.
        hidden: how large effects may be that the fitted noise hides, the likeliest first.
        findings: what the final model leaves unexplained; empty when it explains all.
        seconds: wall time by stage [s].
        failed: what was tried and could not be evaluated.
    """

    log: Log
    options: DiscoveryOptions
    verdict: Verdict
    named: tuple[NamedEffect, ...]
    rejected: tuple[RejectedEffect, ...]
    unexplained: bool
    noise_rms: float
    disturbance_rms: float
    noise_by_unit: Mapping[str, float] = field(default_factory=dict)
    disturbance_by_unit: Mapping[str, float] = field(default_factory=dict)
    before: Gap
    after: Gap
    nominal: Refit
    final: Refit
    predicted_before: np.ndarray
    predicted_after: np.ndarray
    scores: tuple[Score, ...]
    remaining: tuple[Score, ...]
    detectable: tuple[Detectable, ...]
    hidden: tuple[Hidden, ...]
    findings: tuple[Finding, ...]
    seconds: Mapping[str, float]
    failed: tuple[Failed, ...] = ()

    @cached_property
    def missing_forces(self) -> tuple[MissingForce, ...]:
        """The forces that the nominal model lacks, by where they act; computed when asked for."""
        if self.verdict == "nothing missing":
            return ()
        return estimate_missing_forces(self.nominal)

    @cached_property
    def located(self) -> tuple[Finding, ...]:
        """Places where the nominal model fails; empty if nothing is missing; computed on demand."""
        if self.verdict == "nothing missing":
            return ()
        return locate_error(self.nominal, self.missing_forces)
