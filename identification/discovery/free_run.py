"""The free runs of two fits along a log: their errors, and where the nominal model fails.

A record of which some samples are unseen confirms where others are fitted whole; where every record
has unseen samples, all of them are fitted.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import nan

import numpy as np

from identification.discovery.effect_results import RecordError
from identification.discovery.findings.finding import Finding
from identification.discovery.missing_forces import (
    MissingForce,
    estimate_missing_forces,
    locate_error,
)
from identification.estimation.metrics import rms_by_unit
from identification.kalman.refit import Refit
from identification.logs.joined import Record, records_of, rows_of
from identification.logs.log import Log, halves


@dataclass(frozen=True, eq=False)
class FreeRun:
    """The free runs of two fits along a log.

    Attributes:
        log: the whole log of N samples; its part `estimation` was fitted, the rest is unseen.
        nominal: the fit without effects.
        final: the fit with the named effects.
        before: y - ŷ of the nominal fit, shape (N, ny), in the outputs' units.
        after: the same of the final fit.
    """

    log: Log
    nominal: Refit
    final: Refit
    before: np.ndarray
    after: np.ndarray

    @property
    def unseen(self) -> np.ndarray:
        """Which samples no fit has seen, shape (N,); all of them where every one was fitted."""
        start, end = (self.log.splits or halves(self.log))["estimation"]
        unseen = (self.log.time < start) | (self.log.time >= end)
        return unseen if unseen.any() else ~unseen

    def missing_forces(self) -> tuple[MissingForce, ...]:
        """Returns the forces that the nominal model lacks, by where they act."""
        return estimate_missing_forces(self.nominal)

    def located(self, forces: Sequence[MissingForce]) -> tuple[Finding, ...]:
        """Returns places where the nominal model fails on the fitted samples."""
        return locate_error(self.nominal, forces)

    @property
    def records(self) -> tuple[Record, ...]:
        """The records with their roles."""
        logs = [log for _, log in records_of(self.log)]
        unseen = [bool((~rows_of(log, "estimation")).any()) for log in logs]
        confirms = [is_unseen and not all(unseen) for is_unseen in unseen]
        pairs = zip(logs, confirms, strict=True)
        return tuple(Record(log, "confirm" if confirm else "fit") for log, confirm in pairs)

    @property
    def errors(self) -> tuple[RecordError, ...]:
        """The errors of both fits on the unseen samples of each record; NaN where it has none."""
        out, begun = [], 0
        for record in self.records:
            log, rows = record.log, slice(begun, begun + len(record.log))
            begun += len(log)
            unseen = ~rows_of(log, "estimation")
            each = [e[rows][unseen] for e in (self.before, self.after)]
            before, after = (float(np.sqrt(np.mean(e**2))) if unseen.any() else nan for e in each)
            told = [rms_by_unit(e, log) if unseen.any() else {} for e in each]
            out.append(RecordError(log.name, record.role, before, after, *told))
        return tuple(out)
