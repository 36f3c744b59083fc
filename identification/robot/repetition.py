"""Does what is to confirm a model only repeat what was fitted?

    R = 1 - Σ_blocks min_s Σ_t ‖z(t) - z_f(t - s)‖² / Σ_blocks Σ_t ‖z(t)‖²      about block means

z are the inputs and outputs of the confirming part, each divided by its std there, and z_f those of
the fitted part, without the mean of a block, because an axis that integrates drifts; twice the
variance of the noise is taken off the error. R is what a mere replay of
the fitted data explains, without any model: each quarter of the confirming part beside the most
alike piece of the fitted one. Unseen data judge a model only where a replay fails. A sine, or a
motion that is repeated period by period, confirms a model that is wrong elsewhere as well as a
right one. Where R is above 0.95 a replay leaves as little as a model that is said to explain a log.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.signal import fftconvolve

from identification.logs.log import Log
from identification.logs.noise import noise_floor
from identification.logs.readings import UNEXPLAINED
from identification.robot.robot import Robot

REPLAYED = 1 - UNEXPLAINED  # R above which the confirming part says little
BLOCKS = 4


@dataclass(frozen=True)
class Repetition:
    """A part of a log, or a record, that repeats what was fitted.

    Attributes:
        log: name of the part or of the record.
        share: R, without unit.
    """

    log: str
    share: float

    def __str__(self) -> str:
        return (
            f"{self.log} repeats what was fitted: a replay of the fitted samples, without any"
            f" model, explains {100 * self.share:.0f} % of it, so it confirms less; confirm on"
            " another motion."
        )

    @property
    def finding(self) -> dict[str, str | float]:
        """As a finding of JSON."""
        return {"kind": "repeated motion", "log": self.log, "share": self.share}


def find_repetitions(robot: Robot) -> tuple[Repetition, ...]:
    """The confirming parts and records of a robot that repeat what is fitted."""
    fitted = [log.part("estimation") for log in (robot.log, *robot.others)]
    many = bool(robot.others) or robot.file.horizon is not None
    whole = many and bool(robot.records)  # then each log is fitted from end to end
    unseen = [] if whole else [log.part("validation") for log in (robot.log, *robot.others)]
    pieces = [robot.log, *robot.others] if whole else fitted
    shares = ((log.name, replayed_share(pieces, log)) for log in (*unseen, *robot.records))
    return tuple(Repetition(name, share) for name, share in shares if share > REPLAYED)


def replayed_share(fitted: Sequence[Log], log: Log) -> float:
    """R of a log, without unit; 0 where nothing varies or no fitted piece is long enough.

    Args:
        fitted: logs of the same columns and sampling time.
        log: what is to confirm.
    """
    z = np.hstack([log.inputs, log.outputs])
    scale = z.std(axis=0)
    kept = scale > 0
    if not kept.any():
        return 0.0
    size = len(log) // BLOCKS
    middle = z[:, kept].mean(axis=0)
    noise = 2 * float(np.sum((noise_floor(z[:, kept]) / scale[kept]) ** 2))
    pieces = [(np.hstack([f.inputs, f.outputs])[:, kept] - middle) / scale[kept]
              for f in fitted if len(f) >= size > 0]  # fmt: skip
    if not pieces:
        return 0.0
    z = (z[:, kept] - middle) / scale[kept]
    error = total = 0.0
    for k in range(BLOCKS):
        block = z[k * size : (k + 1) * size]
        block = block - block.mean(axis=0)
        total += float(np.sum(block**2))
        error += max(0.0, min(_least(block, piece) for piece in pieces) - size * noise)
    return 1 - error / total if total > 0 else 0.0


def _least(block: np.ndarray, piece: np.ndarray) -> float:
    """min_s Σ ‖block - piece_s‖² over all places s in a piece, each about its own mean."""
    size = len(block)
    pairs = zip(piece.T, block.T, strict=True)
    across = np.sum([fftconvolve(p, b[::-1], "valid") for p, b in pairs], axis=0)
    sums, power = (
        np.concatenate([np.zeros((1, x.shape[1])), np.cumsum(x, axis=0)]) for x in (piece, piece**2)
    )
    sums, power = sums[size:] - sums[:-size], power[size:] - power[:-size]
    own = np.sum(power - sums**2 / size, axis=1)
    return float(np.min(own - 2 * across) + np.sum(block**2))
