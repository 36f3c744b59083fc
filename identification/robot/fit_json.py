"""A fit of a robot as plain values for JSON, with its verdict in sentences.

A fit that is proven to predict unseen records worse is told otherwise, and its values are not to be
used. One that is worse and not proven to be is still no better, and a reader should not have to
find that out from two numbers. So is one that predicts the outputs of one unit worse: a fit may
give up the angles to win the slides, which one number over all outputs hides.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from identification.quantities import plain
from identification.report.error_words import kind, listed
from identification.report.fit_json import fit_to_json
from identification.robot.free_swing import impossible_sentence
from identification.robot.reading import doubtful
from identification.robot.record_error import Confirmation, find_repetitions
from identification.robot.robot_fit import RobotFit
from identification.shares import change

LEAST = 0.01  # rise of the mean square that is told; the noise of a right fit makes less
LEAST_OF_UNIT = 0.1  # rise of the mean square of one unit that is told
FARTHEST = 100.0  # a value that changes by this factor is not believed


def robot_fit_to_json(result: RobotFit, confirmed: Sequence[Confirmation] = ()) -> dict[str, Any]:
    """Returns the numbers and the verdict of a fit; unknown and infinite numbers are null."""
    found = result.found
    record = {"horizon": None, "worse": None, **fit_to_json(found)}
    repeated = find_repetitions(result.robot)
    said = (*(confirmed or result.unseen), *repeated)
    far = _far(record["parameters"])
    first = int(
        result.is_worse or result.stopped
    )  # then nothing else of the verdict matters as much
    far = [*doubtful(result.robot), *no_better(result, confirmed or result.unseen), *far]
    if no_body := impossible_sentence(result.robot, result.shared):
        far.append(no_body)
    verdict = [*record["verdict"][:first], *far, *record["verdict"][first:], *map(str, said)]
    return {
        **record, "confirm": plain(tuple(confirmed)), "verdict": verdict,
        "findings": [r.finding for r in repeated],
        "remarks": list(result.robot.remarks),
    }  # fmt: skip


def no_better(result: RobotFit, confirmed: Sequence[Confirmation]) -> list[str]:
    """Returns a sentence where the fitted values predict worse and this is not proven, or none."""
    if result.is_worse or result.stopped or not confirmed:
        return []
    if result.found.horizon is not None:
        before, after = result.found.unseen_rms
    else:
        before, after = (_over_all([getattr(c, k) for c in confirmed]) for k in ("before", "after"))
    rise = (after / before) ** 2 - 1 if before > 0 else 0.0
    if not rise > LEAST:
        return worse_unit(confirmed)
    return [
        "The fitted values predict unseen data worse than the values with which the fit"
        f" began (mean square {change(rise)}). This may be chance, but it does not confirm"
        " the fitted values: fit a longer log, or more logs, before you use them.",
        *worse_unit(confirmed),
    ]


def worse_unit(confirmed: Sequence[Confirmation]) -> list[str]:
    """Returns one sentence that names outputs that are predicted worse while others are not."""
    rises = _rises(confirmed)
    worse = {unit: rise for unit, rise in rises.items() if rise > LEAST_OF_UNIT}
    others = {unit: rise for unit, rise in rises.items() if unit not in worse}
    if not worse or not others:
        return []
    return [
        f"The fitted values predict {_told(worse)} of the unseen data worse than the values with"
        f" which the fit began, but not {_told(others)}. This may be chance, or the fit improves"
        " one at the cost of the other: fit a longer log, or more logs, before you rely on"
        f" what it predicts of {listed([kind(unit) for unit in worse])}."
    ]


def _over_all(rms: Sequence[float]) -> float:
    """Returns the rms over records, each of which counts alike."""
    return float(np.sqrt(np.mean(np.square(rms))))


def _rises(confirmed: Sequence[Confirmation]) -> dict[str, float]:
    """Returns the rise of the mean square by unit, over records, each of which counts alike."""
    rises = {}
    for unit in dict.fromkeys(unit for c in confirmed for unit in c.before_by_unit):
        before = sum(c.before_by_unit.get(unit, 0.0) ** 2 for c in confirmed)
        after = sum(c.after_by_unit.get(unit, 0.0) ** 2 for c in confirmed)
        if before > 0:
            rises[unit] = after / before - 1
    return rises


def _told(rises: Mapping[str, float]) -> str:
    """Returns the outputs with the change of their mean square, in words."""
    return listed([f"the {kind(u)} (mean square {change(r)})" for u, r in rises.items()])


def _far(parameters: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """Returns a sentence about values that changed by a factor that no robot explains."""
    far = [
        n for n, p in parameters.items()
        if p["initial"] and not 1 / FARTHEST < abs(p["value"] / p["initial"]) < FARTHEST
        and p["initial"] * p["value"] > 0
    ]  # fmt: skip
    if not far:
        return []
    return [
        f"{', '.join(far)}: more than {FARTHEST:g} times from where the fit began; the log's units"
        " and signs must be those of the model (rad or m, s, and what its actuators take)."
    ]
