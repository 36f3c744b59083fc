"""The outcome of a discovery, and what it rests on, whichever search has found it.

    floor_g = √(σ_g² + d_g²)        of the outputs of a unit g; d counts where it is believed
    times   = √mean_g (rms_g/floor_g)²
    share   = (times²(before) - times²(after))/(times²(before) - 1)      of a free run

σ is the sensors' noise, d what unlogged errors of the inputs do to a free run. A search along a
free run (`identification.innovations.discovery`) knows d, one over a horizon
(`identification.prediction.discovery`) the horizon, the shifts of records in time and those that
repeat others. What a search does not know is None or empty.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from math import hypot, isfinite
from typing import Literal

import numpy as np

from identification.discovery.attempts import Failed
from identification.discovery.effect_results import (
    Detectable,
    Gap,
    Hidden,
    NamedEffect,
    RecordDifference,
    RecordError,
    RejectedEffect,
    Rival,
    Scored,
    Unlogged,
)
from identification.discovery.findings.finding import Finding, FindingKind
from identification.discovery.findings.records_evidence import ShiftedRecord
from identification.discovery.fitted import Fitted
from identification.discovery.forces.recovered_force import RecoveredForce
from identification.discovery.free_run import FreeRun
from identification.discovery.missing_forces import MissingForce
from identification.discovery.options import DiscoveryOptions
from identification.discovery.second_opinion import TorqueOpinion
from identification.effects.effect import Candidate, Effect
from identification.estimation.metrics import output_units, relative
from identification.logs.joined import Record
from identification.model.parameter import Parameter
from identification.storage.shown import Shown
from identification.storage.written import Files, Written

Recover = Callable[[Candidate, Sequence[Rival]], RecoveredForce | None]
Verdict = Literal["named", "nothing missing", "unknown effect", "unlisted effect"]


@dataclass(frozen=True, kw_only=True, repr=False)
class Discovery(Shown, Written):
    """The outcome of a discovery.

    Attributes:
        records: what was fitted and what confirmed; where no record confirms, and along a free run,
            a part of each record is unseen.
        options: the judgement constants that were used.
        verdict: the outcome in a word.
        named: the missing effects, in the order in which they were found.
        rejected: effects that were refitted beside the named ones and not accepted, the best first.
        nearest: the best of them that unseen samples prove, and that is too small to matter or not
            the likeliest; None where there is none.
        unexplained: whether something is left that no named effect explains.
        share: of the mean square above the noise on unseen data, how much the named effects take
            away; None where nothing is above it.
        smooth_share: of what they and smooth forces at all joints could explain of the fitted
            windows, the share that they explain; None where that is not known.
        smooth_by_joint: with an unknown effect, the share of the fitted error of the nominal model
            that any smooth force at one joint could explain, by the joint in words, the largest
            first; empty else, and along a free run.
        horizon: over which records were predicted [s]; None for a free run.
        unit: of errors and noise over all outputs; "" where these have several units, or none.
        scale: rms error of each output under the nominal model, shape (ny,), in its unit, by which
            its error is divided in a mean square; None where 1 counts alike in all outputs.
        noise_rms: rms of the sensors' noise over all outputs, in `unit`.
        noise_by_unit: the same by the outputs' units, each in it.
        noise_by_output: std of each sensor's noise by output, in its unit; empty over a horizon.
        disturbance_rms: rms of what unlogged input errors do to the free run, by the noise model,
            in `unit`; zero where these errors are not random, and over a horizon.
        disturbance_by_unit: the same by the outputs' units, each in it.
        input_error: rms error of the inputs that would make what the final model leaves: over a
            horizon, of inputs that err by a constant in each window, or along a free run by the
            noise model; a share of the inputs' own rms, or of their own motion.
        unlogged: that error where a noise model has it; None where it was only computed.
        before: the gap of the fitted nominal model.
        after: the gap of the model with the named effects.
        doubtful: the gap of the model with all effects that were proven, where the name of none of
            them is sure, so that they stand among the rejected; None else, and along a free run.
        errors: of both models by record, in the order of `records`.
        nominal: the fit without effects.
        final: the fit with the named effects.
        at_bound: the nominal model's parameters that end on a bound of their range in `final`.
        scores: of all candidates on the nominal fit, the best first.
        remaining: of the other candidates on the final fit, the best first.
        scored_by: the measure of scores: "gain", twice the log likelihood that a candidate adds at
            once, or "fall", the share of the mean square of the fitted error that it takes away.
        next_best: the best remaining candidate, where none was refitted beside a named effect, and
            the chance that one of all does as well by luck; None where there is none.
        detectable: the smallest effects that this log would have shown; empty over a horizon.
        hidden: how large effects may be that the fitted noise hides, the likeliest first; likewise.
        findings: what the final model leaves unexplained; empty when it explains all.
        shifts: of records whose inputs look shifted in time against their outputs; empty for a
            free run.
        differences: what differs between records and is counted for each by itself, such as the
            zero of a sensor; likewise.
        torques: what the torques of the measured motion say of the names, and what they name.
        torques_refused: why they cannot say anything; "" where they can, None where nobody asked.
        repeats: names of the records that confirm, but whose motion is that of a fitted record or
            of one that confirms before them; likewise.
        took: wall time of the whole search [s].
        seconds: of it by stage, as far as stages were finished.
        failed: what was tried and could not be evaluated.
        moves: names of the moves that changed the effects, in their order
            (`identification.discovery.passes`).
        cut_short: names of the moves that `max_minutes` ended or did not let begin.
        run: the free runs of both fits; None over a horizon.
        recover: returns the force of a named effect, beside those of its rivals, as the data ask
            for it; None where it has none. It raises DivergenceError.
        files_of: returns what writes its files (`identification.storage.written`); None where no
            public function was asked.
    """

    records: tuple[Record, ...]
    options: DiscoveryOptions
    verdict: Verdict
    named: tuple[NamedEffect, ...]
    rejected: tuple[RejectedEffect, ...]
    nearest: RejectedEffect | None = None
    unexplained: bool
    share: float | None
    smooth_share: float | None = None
    smooth_by_joint: Mapping[str, float] = field(default_factory=dict)
    horizon: float | None = None
    unit: str
    scale: np.ndarray | None = None
    noise_rms: float
    noise_by_unit: Mapping[str, float] = field(default_factory=dict)
    noise_by_output: Mapping[str, float] = field(default_factory=dict)
    disturbance_rms: float = 0.0
    disturbance_by_unit: Mapping[str, float] = field(default_factory=dict)
    input_error: float
    unlogged: Unlogged | None = None
    before: Gap
    after: Gap
    doubtful: Gap | None = None
    errors: tuple[RecordError, ...]
    nominal: Fitted
    final: Fitted
    at_bound: tuple[str, ...]
    scores: tuple[Scored, ...]
    remaining: tuple[Scored, ...]
    scored_by: Literal["gain", "fall"]
    next_best: tuple[Scored, float] | None = None
    detectable: tuple[Detectable, ...] = ()
    hidden: tuple[Hidden, ...] = ()
    findings: tuple[Finding, ...]
    shifts: tuple[ShiftedRecord, ...] = ()
    differences: tuple[RecordDifference, ...] = ()
    torques: tuple[TorqueOpinion, ...] = ()
    torques_refused: str | None = None
    repeats: tuple[str, ...] = ()
    took: float
    seconds: Mapping[str, float]
    failed: tuple[Failed, ...] = ()
    moves: tuple[str, ...] = ()
    cut_short: tuple[str, ...] = ()
    run: FreeRun | None = None
    recover: Recover
    files_of: Callable[[Discovery], Files] | None = None

    @cached_property
    def missing_forces(self) -> tuple[MissingForce, ...]:
        """The forces that the nominal model lacks, by where they act; computed when asked for.

        Empty where nothing is missing, and over a horizon.
        """
        if self.verdict == "nothing missing" or self.run is None:
            return ()
        return self.run.missing_forces()

    @cached_property
    def located(self) -> tuple[Finding, ...]:
        """Places where the nominal model fails; likewise."""
        if self.verdict == "nothing missing" or self.run is None:
            return ()
        return self.run.located(self.missing_forces)

    @property
    def judged_by(self) -> Literal["free run", "windows"]:
        """Returns what errors are of: free runs, or predictions over windows of the horizon."""
        return "free run" if self.horizon is None else "windows"

    @property
    def over(self) -> str:
        """Over which time errors are meant, such as " over 0.2 s"; "" along a free run."""
        return "" if self.horizon is None else f" over {self.horizon:g} s"

    @property
    def is_told_by_record(self) -> bool:
        """Tells whether the errors of single records say more than that of all of them."""
        return self.horizon is not None or len(self.errors) > 1

    @property
    def is_begun(self) -> bool:
        """Tells whether the search began with the model's first values, as a fit was worse."""
        return any(finding.kind is FindingKind.WORSE_FIT for finding in self.findings)

    @property
    def has_deviations(self) -> bool:
        """Tells whether values of single drives or points were free (`NAME@PLACE`)."""
        free = {*self.nominal.told_std, *self.final.told_std}
        return any("@" in p.name and p.name in free for p in self._own_parameters)

    @property
    def held_fixed(self) -> tuple[str, ...]:
        """Names of the parameters whose errors the std leave out, because they were held fixed.

        Empty over a horizon: there std come from how much windows differ.
        """
        if self.horizon is not None:
            return ()
        free = {*self.nominal.told_std, *self.final.told_std}
        return tuple(
            p.name for p in self._own_parameters if p.name not in free and p.where != "start"
        )

    @property
    def _own_parameters(self) -> list[Parameter]:
        """The parameters of the model without those of effects."""
        return [p for p in self.final.plant.parameters if p.where != "effect"]

    @property
    def outputs(self) -> Mapping[str, str]:
        """The unit of each output by name; "" where it has none."""
        return output_units(self.records[0].log)

    def errors_of(self, gap: Gap) -> Mapping[str, float]:
        """Returns the rms of a gap by the outputs' units, each in its unit."""
        return gap.rms_by_unit if len(gap.rms_by_unit) > 1 else {self.unit: gap.rms}

    @property
    def sensors(self) -> Mapping[str, float]:
        """Rms of the sensors' noise by the outputs' units, each in its unit."""
        several = len(self.noise_by_unit) > 1
        return self.noise_by_unit if several else {self.unit: self.noise_rms}

    @property
    def floor_rms(self) -> float:
        """Rms that sensors and unlogged input errors make of the true model, over all outputs.

        Input errors count where they can be believed to be noise: where the model is believed, and
        where they are no larger than `allowed_input_error`.
        """
        return hypot(self.noise_rms, self.disturbance_rms if self._is_believed else 0.0)

    @property
    def floor(self) -> Mapping[str, float]:
        """`floor_rms` by the outputs' units, each in its unit."""
        if len(self.noise_by_unit) < 2:
            return {self.unit: self.floor_rms}
        disturbed = self.disturbance_by_unit if self._is_believed else {}
        return {unit: hypot(s, disturbed.get(unit, 0.0)) for unit, s in self.noise_by_unit.items()}

    def times_noise(self, gap: Gap) -> float:
        """Returns a gap relative to the noise, in one number; infinite where there is no noise."""
        return relative(self.errors_of(gap), self.floor)

    @property
    def _is_believed(self) -> bool:
        """Tells whether errors of the inputs pass for noise."""
        is_small = self.input_error <= self.options.allowed_input_error
        return self.verdict != "unknown effect" and is_small


def closed_share(found: Discovery) -> float | None:
    """Returns the share of power above the noise that named effects close; None without such."""
    before, after = (found.times_noise(gap) ** 2 for gap in (found.before, found.after))
    if not isfinite(before):
        of = [found.errors_of(gap) for gap in (found.after, found.before)]
        return min(1.0, max(0.0, 1 - relative(*of) ** 2)) if found.before.rms > 0 else None
    return min(1.0, max(0.0, (before - after) / (before - 1))) if before > 1 else None


def collect_final_values(found: Discovery) -> dict[str, float]:
    """Returns the values of all parameters of the final fit by name, named effects included."""
    return {**found.final.plant.parameters.values(), **found.final.values}


def keep_of_robot(values: Mapping[str, float], effects: Sequence[Effect]) -> dict[str, float]:
    """Returns the values of a robot that hold in every log.

    Args:
        values: values by name.
        effects: the effects that the robot may have; shapes that tell something of one log (what
            an input did before its first sample) are left out.
    """
    of_log = {f"{e.name}.{s.name}" for e in effects for s in e.shapes if s.of_log}
    return {name: value for name, value in values.items() if name not in of_log}
