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
from identification.logs.joined import Record, Role, records_of, rows_of
from identification.logs.log import Log
from identification.logs.parts import Parts


@dataclass(frozen=True, eq=False)
class FreeRun:
    """The free runs of two fits along a log."""

    log: Log  # the whole log of N samples; its part `estimation` was fitted, the rest is unseen
    nominal: Refit  # the fit without effects
    final: Refit  # the fit with the named effects
    before: np.ndarray  # y - ŷ of the nominal fit, shape (N, ny), in the outputs' units
    after: np.ndarray  # the same of the final fit
    # of the samples that no fit has seen; None where the search told none apart
    parts: Parts | None = None

    @property
    def unseen(self) -> np.ndarray:
        """Which samples no fit has seen, shape (N,); all of them where every one was fitted."""
        unseen = ~rows_of(self.log, "estimation")
        return unseen if unseen.any() else ~unseen

    @property
    def told(self) -> np.ndarray:
        """Which samples the errors are told of: those that the search has not used either, (N,)."""
        return self.unseen if self.parts is None else self.parts.report

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
        out, begun = [], 0
        for log, is_unseen in zip(logs, unseen, strict=True):
            rows = slice(begun, begun := begun + len(log))
            parts = self.parts.between(rows) if self.parts and is_unseen else None
            role: Role = "confirm" if is_unseen and not all(unseen) else "fit"
            out.append(Record(log, role, parts=parts))
        return tuple(out)

    @property
    def errors(self) -> tuple[RecordError, ...]:
        """The errors of both fits on what is told of each record; NaN where all was fitted."""
        out, begun = [], 0
        for record in self.records:
            log, rows = record.log, slice(begun, begun := begun + len(record.log))
            told = ~rows_of(log, "estimation") if self.parts is None else self.parts.report[rows]
            each = [e[rows][told] for e in (self.before, self.after)]
            before, after = (float(np.sqrt(np.mean(e**2))) if told.any() else nan for e in each)
            by_unit = [rms_by_unit(e, log) if told.any() else {} for e in each]
            out.append(RecordError(log.name, record.role, before, after, *by_unit))
        return tuple(out)
