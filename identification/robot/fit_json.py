"""A fit of a robot as plain values for JSON, with its verdict in sentences."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from identification.report.fit_json import fit_to_json, records_fit_to_json
from identification.robot.fitting import RobotFit
from identification.robot.free_inertias import impossible_sentence
from identification.robot.no_better import no_better
from identification.robot.reading import doubtful
from identification.robot.record_error import Confirmation
from identification.robot.repetition import find_repetitions

FARTHEST = 100.0  # a value that changes by this factor is not believed


def robot_fit_to_json(result: RobotFit, confirmed: Sequence[Confirmation] = ()) -> dict[str, Any]:
    """Returns the numbers and the verdict of a fit; unknown and infinite numbers are null."""
    found = result.found
    if found.horizon is None:
        record = {**fit_to_json(found), "horizon": None, "worse": None}
    else:
        record = records_fit_to_json(found)
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
        **record, "confirm": [vars(c) for c in confirmed], "verdict": verdict,
        "findings": [r.finding for r in repeated],
        "remarks": list(result.robot.remarks),
    }  # fmt: skip


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
