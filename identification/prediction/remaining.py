"""The findings on what the final model of a discovery leaves.

Where the error at the horizon is that of the sensors, nothing is left that an effect or a shift of
a record could explain. Among many that are tried one gains by luck, so that such a doubt counts
only where more than `min_gap_share` is left above the sensors' noise. All outputs together say that
least of one that errs while the others, which the nominal model predicts as well, do not: an output
by itself counts where its error is more than `MAX_OUTPUT_RATIO` times its noise.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification.chances import mean_above_other
from identification.discovery.effect_results import RejectedEffect
from identification.discovery.findings.finding import Finding, FindingKind
from identification.discovery.findings.records_evidence import (
    DifferentRecord,
    RemainingError,
    ShiftedRecord,
    UnprovenEffect,
    WorseFit,
)
from identification.effects.named import phrase_there
from identification.model.predictor import Plant
from identification.prediction.clocks import told_shifts
from identification.prediction.state import rise
from identification.prediction.task import WindowSearch
from identification.prediction.unseen import Unseen

# Of an output's error to its noise, which its own differences tell to a tenth or two.
MAX_OUTPUT_RATIO = 1.5
# Of a record's rms error to that of the others: beyond it, and beyond chance, it is reported.
DIFFERENT_RECORD_RATIO = 2.0
MIN_COMPARED_RECORDS = 3  # of two nobody knows which one is different


def find_remaining(
    state: WindowSearch, rejected: Sequence[RejectedEffect], shifts: Sequence[ShiftedRecord]
) -> tuple[Finding, ...]:
    """Returns what the final model leaves: errors above the sensors' noise, and doubtful effects.

    Args:
        state: the finished state.
        rejected: effects that were refitted and not proven.
        shifts: of records, of `identification.prediction.clocks`.
    """
    out: list[Finding] = []
    if state.worse_fit is not None:
        worse = WorseFit(rise(state.begun, state.worse_fit))
        out.append(Finding(FindingKind.WORSE_FIT, worse))
    left = _error_left(state)
    places: set[tuple[str, str]] = set()  # each is told once, as it did best
    for r in rejected if left else ():
        seen = r.proof
        if seen.is_everywhere and seen.fall > 0 and seen.t > state.task.options.min_proof_t:
            unproven = _unproven(r, state.model.plant)
            if (unproven.name, unproven.where) not in places:
                out.append(Finding(FindingKind.UNPROVEN_EFFECT, unproven))
            places.add((unproven.name, unproven.where))
    if state.accepted and left:
        out.append(Finding(FindingKind.REMAINING_ERROR, left))
    out += [Finding(FindingKind.DIFFERENT_RECORD, e) for e in different_records(state)]
    told = told_shifts(shifts, len(state.task.records), state.task.options) if left else ()
    out += [Finding(FindingKind.SHIFTED_RECORD, e) for e in told]
    return tuple(out)


def _error_left(state: WindowSearch) -> RemainingError | None:
    """Returns the error above the sensors' noise; None where the noise alone explains it."""
    options, ratio = state.task.options, noise_ratio(state)
    names, ratios = state.task.records[0].log.output_names, output_ratios(state.model.unseen)
    worst = int(np.argmax(ratios))
    if len(names) > 1 and ratios[worst] > max(MAX_OUTPUT_RATIO, ratio):
        return RemainingError(float(ratios[worst]), names[worst])
    return RemainingError(ratio) if ratio > 1 + options.min_gap_share else None


def output_ratios(unseen: Unseen) -> np.ndarray:
    """Returns each output's rms error over that of its noise, (ny,); zero where that is unknown."""
    squares, noise = np.concatenate(unseen.of_outputs).mean(axis=0), unseen.noise
    return np.sqrt(np.divide(squares, noise, out=np.zeros_like(squares), where=noise > 0))


def noise_ratio(state: WindowSearch) -> float:
    """Returns the final model's rms error on unseen records over that of the sensors' noise."""
    unseen = state.model.unseen
    square = float(np.mean(np.concatenate(unseen.at_horizon)))
    return float(np.sqrt(square / unseen.floor)) if unseen.floor else np.inf


def different_records(state: WindowSearch) -> list[DifferentRecord]:
    """Returns records that the final model predicts much worse than the others, by Welch's t-test.

    The sample are logarithms of the windows' mean squares, and the records are paid for.
    """
    unseen, options = state.model.unseen, state.task.options
    errors = {
        r.log.name: np.log(squares + unseen.floor)
        for r, squares in zip(state.task.confirm, unseen.at_horizon, strict=True)
    }
    fitted = [r for r in state.task.records if r.role == "fit"]
    scale = state.model.scale
    for r, e in zip(fitted, state.model.fit.errors, strict=True):
        errors[f"{r.log.name} (fit)"] = np.log(
            np.mean((e / scale) ** 2, axis=(1, 2)) + unseen.floor
        )
    out: list[DifferentRecord] = []
    if len(errors) < MIN_COMPARED_RECORDS:
        return out
    for name, mine in errors.items():
        rest = np.concatenate([e for n, e in errors.items() if n != name])
        ratio = float(np.exp((mine.mean() - rest.mean()) / 2))
        chance = mean_above_other(mine, rest)
        if ratio > DIFFERENT_RECORD_RATIO and chance * len(errors) < options.significance:
            out.append(DifferentRecord(name, ratio, chance))
    return out


def _unproven(r: RejectedEffect, plant: Plant) -> UnprovenEffect:
    c = r.candidate
    doubt = r.doubt or "chance"
    return UnprovenEffect(
        c.effect.name, phrase_there(c, plant), c.where, r.proof.fall, r.proof.t, doubt
    )
