"""The verdict of a discovery by prediction.

The confidence of a name is its share of the odds among its rivals, in the mean over resamples
(`identification.prediction.judging.evidence`). A name below even odds is no name, unless it is told
with its look-alike; nor is a law beside which a curve of the data still explains much, for the
right one would not leave that (`identification.prediction.verdict.neighbours`). What was tried is
then told, and the verdict is "unknown effect".
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from identification.discovery.attempts import Failed, attempt, listed_once
from identification.discovery.effect_results import (
    Gap,
    NamedEffect,
    RecordDifference,
)
from identification.discovery.findings.finding import Finding, FindingKind
from identification.discovery.options import DiscoveryOptions
from identification.discovery.passes import uses
from identification.discovery.result import Discovery, Verdict
from identification.logs.joined import REPLAYED, replayed_share
from identification.logs.log import Log
from identification.logs.rest import is_at_rest
from identification.prediction.fits.model import WindowModel
from identification.prediction.fits.record_errors import error_of_all, errors_by_unit, record_errors
from identification.prediction.judging.extension import as_last_fit, refitted
from identification.prediction.judging.trial import Contender, Doubt
from identification.prediction.task import WindowSearch
from identification.prediction.verdict.clocks import record_shifts
from identification.prediction.verdict.doubts import doubts_of_names, forbidden_of, names_of
from identification.prediction.verdict.recovery import recover_over_horizon
from identification.prediction.verdict.remaining import find_remaining, is_off, needed_input_error
from identification.prediction.verdict.told_effects import (
    fitted_sizes,
    rejected_effect,
    unnamed_effect,
)
from identification.prediction.verdict.yardstick import measure
from identification.windows.comparison import rise
from identification.windows.records import Record
from identification.windows.unseen import Unseen

# With these findings and no name, the model lacks something.
SUSPECT = (
    FindingKind.UNPROVEN_EFFECT, FindingKind.DIFFERENT_RECORD, FindingKind.SHIFTED_RECORD,
    FindingKind.UNTRIED_EFFECT,
)  # fmt: skip


def conclude(state: WindowSearch) -> Discovery:
    """Returns the outcome of a finished search.

    Args:
        state: the finished state.
    """
    state = _with_last_fit(state)
    task, model = state.task, state.model
    options = task.options
    rejected = listed_once([rejected_effect(state, c) for c in state.rejected])
    shifts = record_shifts(task, model)
    differ = [a for a in state.accepted if a.candidate.effect.is_of_records]
    nominal = _with_differences(state, differ)
    # Beside a model with effects that diverges there, the nominal one tells it.
    needed = attempt(None, partial(_needed_input_error, model, options))
    if needed is None:
        needed = _needed_input_error(nominal, options)
    findings = find_remaining(state, rejected, shifts, needed)
    # That the fit without effects was worse is told; what was found says why, and nothing is left.
    left = [f for f in findings if f.kind is not FindingKind.WORSE_FIT or not state.accepted]
    limit = options.left_confidence if left else options.max_confidence
    named, stick = names_of(state, limit, bool(left))
    is_unexplained = _is_worse(state) or _errs(model, needed, options)
    # Where the fit was worse than the values with which it began, an effect says why.
    closes = largest_share(state.worse_fit or nominal.unseen, model.unseen, options)
    doubts = doubts_of_names(named, forbidden_of(state), left, closes, options)
    verdict, doubtful = decide(named, doubts, findings, is_unexplained), None
    log, by_joint = task.records[0].log, dict[str, float]()
    if verdict == "unknown effect":
        doubtful = _gap(model.unseen, nominal.scale, log) if named else None
        unnamed = [unnamed_effect(n, d or "beside") for n, d in zip(named, doubts, strict=True)]
        alone = attempt(None, partial(_needed_input_error, nominal, options))
        needed = needed if alone is None else alone  # what is told is of the model without effects
        rejected, named, model = listed_once([*unnamed, *rejected]), (), nominal
        any_force = attempt(None, partial(measure, nominal, task.effects, is_left=True))
        by_joint = dict(any_force.of_joint) if any_force else by_joint
    smooth = stick.share(nominal.fitted_power, model.fitted_power) if stick and named else None
    noise = model.unseen.noise
    return Discovery(
        records=task.records, options=options, horizon=task.horizon, verdict=verdict, named=named,
        rejected=rejected, share=_share(nominal.unseen, model.unseen),
        smooth_share=smooth,
        smooth_by_joint=dict(sorted(by_joint.items(), key=lambda share: -share[1])),
        unexplained=bool(left) or (
            # inputs that err by what is usual may excuse an error that is far above the noise
            is_off(model, options) if verdict == "nothing missing" else not named
        ),
        noise_rms=error_of_all(noise, nominal.scale, log), unit=log.output_unit,
        scale=nominal.scale, input_error=needed,
        noise_by_unit=errors_by_unit(noise, nominal.scale, log),
        before=_gap(nominal.unseen, nominal.scale, log),
        after=_gap(model.unseen, nominal.scale, log), doubtful=doubtful,
        errors=record_errors(
            task.records, nominal.scale, (nominal.unseen, model.unseen),
            (nominal.fit.errors, model.fit.errors),
        ),
        nominal=nominal, final=model, scored_by="fall",
        # Values with which a search began, because its fit was worse, lie inside their bounds.
        at_bound=tuple(n for n in model.at_bound if n in nominal.fit.problem.names),
        scores=state.nominal_scores, remaining=state.scores if named else state.nominal_scores,
        findings=findings, shifts=shifts,
        differences=tuple(_difference(state.model, a) for a in differ),
        repeats=_repeats(task.records),
        seconds=state.seconds, moves=state.made, cut_short=state.cut_short,
        failed=_failed(state), recover=partial(recover_over_horizon, model), took=state.took,
    )  # fmt: skip


def decide(
    named: Sequence[NamedEffect], doubts: Sequence[Doubt | None], findings: Sequence[Finding],
    is_unexplained: bool,
) -> Verdict:  # fmt: skip
    """Returns the verdict.

    Args:
        named: the accepted effects, with their confidence.
        doubts: why each of them is no name.
        findings: what the final model leaves.
        is_unexplained: whether the model errs by more than noise, and no effect says why.
    """
    if named and not any(doubts):
        is_drawn = all(n.candidate.effect.is_curve for n in named)
        return "unlisted effect" if is_drawn else "named"
    if named or is_unexplained or any(f.kind in SUSPECT for f in findings):
        return "unknown effect"
    return "nothing missing"


def _share(before: Unseen, after: Unseen) -> float:
    """Returns the share of the power above the noise that a model takes away on untouched data."""
    old, new = (float(np.mean(np.concatenate(u.report.at_horizon))) for u in (before, after))
    above = old - min(after.floor, new)
    return (old - new) / above if above > 0 else 0.0


def largest_share(before: Unseen, after: Unseen, options: DiscoveryOptions) -> float:
    """Returns the same share of the output of which a model takes away most.

    An effect at one joint may do nothing for the outputs of others, which lack something else.
    """
    old, new = (np.concatenate(u.report.of_outputs).mean(axis=0) for u in (before, after))
    above = old - np.minimum(after.noise, new)
    is_off = old > after.noise * (1 + options.min_gap_share)
    return float(np.max((old - new)[is_off] / above[is_off], initial=0.0))


def _with_differences(state: WindowSearch, differ: Sequence[Contender]) -> WindowModel:
    """Returns the nominal model with the differences between records that the final one has.

    It sees the windows of the final one, which a shift of clocks that was asked for has cut.
    """
    if not differ and not any(r.edge for r in state.task.records):
        return state.nominal
    if len(differ) == len(state.accepted):
        return state.model
    found = [a.candidate for a in differ]
    kept = [c for c in state.model.candidates if c.key in {d.key for d in found}]
    bare = refitted(state.model, kept, state.task.nominal_model, state.task.confirm)
    return bare or state.nominal


def _difference(model: WindowModel, a: Contender) -> RecordDifference:
    """Returns what each record has for itself of an effect."""
    candidate, parameters = fitted_sizes(model, a.candidate)
    (unit,) = {unit for _, _, unit in parameters.values()}
    return RecordDifference(
        candidate, {name: (value, std) for name, (value, std, _) in parameters.items()}, unit
    )


def _failed(state: WindowSearch) -> tuple[Failed, ...]:
    """Returns what failed or was begun and left, but for what another round has refitted."""
    refitted = {c.candidate.key for c in (*state.accepted, *state.rejected)}
    return tuple(f for f in state.failed if not (f.dropped and f.key in refitted))


def _with_last_fit(state: WindowSearch) -> WindowSearch:
    """Returns the state whose final model is fitted as the last one (`as_last_fit`).

    Values that are worse after a fit than before it are kept as they were, and none is fitted.

    Args:
        state: of a search that is over.
    """
    task, model = state.task, state.model
    if state.worse_fit is not None and not model.candidates:
        return state
    is_weighed = bool(model.candidates) and uses(task.options, "priors_of_last_fit")
    last = partial(as_last_fit, model, task.horizon, task.confirm, is_weighed)
    final = attempt(None, last) or model
    return replace(state, model=final, nominal=final if state.nominal is model else state.nominal)


def _repeats(records: Sequence[Record]) -> tuple[str, ...]:
    """Returns the names of records that confirm, but repeat a fitted one or one before them.

    One in which the robot hardly moves, which any rest of a fitted one replays, is told apart.
    """
    fitted = [r.log for r in records if r.role == "fit"]
    distinct, repeats = [*fitted], []
    moving = [r.log for r in records if r.role == "confirm" and not is_at_rest(fitted, r.log)]
    for log in moving:
        if replayed_share(distinct, log) > REPLAYED:
            repeats.append(log.name)
        else:
            distinct.append(log)
    return tuple(repeats)


def _is_worse(state: WindowSearch) -> bool:
    """Returns whether the fit worsens predictions enough to matter, and no effect explains why."""
    if state.worse_fit is None or state.accepted:
        return False
    return rise(state.begun.report, state.worse_fit.report) > state.task.options.min_gap_share


def _errs(model: WindowModel, needed: float, options: DiscoveryOptions) -> bool:
    """Returns whether a model errs by more than noise and than errors of its inputs would make."""
    return is_off(model, options) and needed > options.max_input_error


def _needed_input_error(model: WindowModel, options: DiscoveryOptions) -> float:
    """Returns the error of the inputs that would make what a model leaves, a share of their rms."""
    unseen = model.unseen
    return needed_input_error(
        model.fit, options, model.scale, unseen.noise, unseen.report.of_outputs
    )


def _gap(unseen: Unseen, scale: np.ndarray, log: Log) -> Gap:
    squares = np.concatenate(unseen.report.of_outputs)
    each = errors_by_unit(squares, scale, log)
    return Gap(error_of_all(squares, scale, log), unseen.fit_percent, each)
