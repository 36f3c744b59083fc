"""What a fit of one log tells the fit of another: values with their std, in the robot's file.

    [fitted]                   # written by `--out`: the logs to which the values were fitted
    first = "5f0c3a…"          # name of a log, and the digest of its samples

For logs that it has not seen, each value of the file with a `std` is what is known before the log
speaks: value ± std. A log that was fitted already is not counted twice: then `prior` and `known`
hold, as before the first fit.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from hashlib import sha256

import numpy as np

from identification.logs.log import Log
from identification.logs.names import listed
from identification.robot.file.file import RobotFile

DIGITS = 16  # of a digest


def digest(log: Log) -> str:
    """Returns a word that tells the samples of a log from those of all others."""
    parts = (log.time - log.time[0], log.inputs, log.outputs)
    content = b"".join(np.ascontiguousarray(part, dtype="<f8").tobytes() for part in parts)
    return sha256(content).hexdigest()[:DIGITS]


def with_carried(file: RobotFile, logs: Sequence[Log]) -> tuple[RobotFile, tuple[str, ...]]:
    """Returns a robot's file whose stds count for some logs, and a sentence where they do."""
    # A held value is not fitted, so that its std says nothing.
    stds = [n for n, record in file.records.items() if "std" in record and n not in file.held]
    if not stds:
        return file, ()
    again = [log.name for log in logs if digest(log) in file.fitted.values()]
    if not again:
        logged = f", fitted to {listed(file.fitted)}," if file.fitted else ""
        return file, (
            f"The values of {file.path.name}{logged} count as known with their std"
            f" ({listed(stds)}); delete the lines `std` there to begin with what was known before.",
        )
    records = {n: {k: v for k, v in r.items() if k != "std"} for n, r in file.records.items()}
    was = "was" if len(again) == 1 else "were"
    return replace(file, records=records), (
        f"{listed(again)} {was} fitted before, so that the std of the values in {file.path.name}"
        " do not count: what was known before that fit does.",
    )
