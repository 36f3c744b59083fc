"""What the final model of a discovery leaves, as findings.

Where the error at the horizon is that of the sensors, nothing is left that an effect or a shift of
a record could explain. Among many that are tried one gains by luck, so that such a doubt counts
only where more than `min_gap_share` is left above the sensors' noise.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.stats import ttest_ind

from identification.discovery.findings.finding import Finding, FindingKind
from identification.discovery.findings.records_evidence import (
    DifferentRecord,
    RemainingError,
    ShiftedRecord,
    UnprovenEffect,
    WorseFit,
)
from identification.effects.neighbours import phrase_there
from identification.model.predictor import Plant
from identification.prediction.clocks import told_shifts
from identification.prediction.result import (
    RefittedEffect,
)
from identification.prediction.state import RecordsState, rise


def find_remaining(
    state: RecordsState, rejected: Sequence[RefittedEffect], shifts: Sequence[ShiftedRecord]
) -> tuple[Finding, ...]:
    """What the final model leaves: errors above the sensors' noise, and doubtful effects.

    Args:
        state: the finished state.
        rejected: effects that were refitted and not proven.
        shifts: of records, of `identification.prediction.clocks`.
    """
    out: list[Finding] = []
    if state.worse_fit is not None:
        worse = WorseFit(rise(state.begun, state.worse_fit))
        out.append(Finding(FindingKind.WORSE_FIT, worse))
    ratio = noise_ratio(state)
    is_left = ratio > 1 + state.task.options.min_gap_share
    places: set[tuple[str, str]] = set()  # each is told once, as it did best
    for r in rejected if is_left else ():
        seen = r.prediction
        if seen.is_everywhere and seen.fall > 0 and seen.t > state.task.options.min_proof_t:
            unproven = _unproven(r, state.model.plant)
            if (unproven.name, unproven.where) not in places:
                out.append(Finding(FindingKind.UNPROVEN_EFFECT, unproven))
            places.add((unproven.name, unproven.where))
    if state.accepted and is_left:
        out.append(Finding(FindingKind.REMAINING_ERROR, RemainingError(ratio)))
    out += [Finding(FindingKind.DIFFERENT_RECORD, e) for e in different_records(state)]
    told = told_shifts(shifts, len(state.task.records), state.task.options) if is_left else ()
    out += [Finding(FindingKind.SHIFTED_RECORD, e) for e in told]
    return tuple(out)


def noise_ratio(state: RecordsState) -> float:
    """Rms error of the final model on unseen records over that of the sensors' noise."""
    unseen = state.model.unseen
    square = float(np.mean(np.concatenate(unseen.at_horizon)))
    return float(np.sqrt(square / unseen.floor)) if unseen.floor else np.inf


def different_records(state: RecordsState) -> list[DifferentRecord]:
    """Records that the final model predicts much worse than the others, by Welch's t-test.

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
    out = []
    for name, mine in errors.items():
        rest = np.concatenate([e for n, e in errors.items() if n != name])
        ratio = float(np.exp((mine.mean() - rest.mean()) / 2))
        chance = float(ttest_ind(mine, rest, equal_var=False, alternative="greater").pvalue)
        if ratio > options.different_ratio and chance * len(errors) < options.significance:
            out.append(DifferentRecord(name, ratio, chance))
    return out


def _unproven(r: RefittedEffect, plant: Plant) -> UnprovenEffect:
    c = r.candidate
    doubt = r.doubt or "chance"
    return UnprovenEffect(
        c.effect.name, phrase_there(c, plant), c.where, r.prediction.fall, r.prediction.t, doubt
    )
