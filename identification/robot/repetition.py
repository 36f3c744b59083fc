"""Does what is to confirm a model only repeat what was fitted?

Unseen data judge a model only where a replay of the fitted data (`identification.logs.replay`)
fails. A sine, or a motion that is repeated period by period, confirms a model that is wrong
elsewhere as well as a right one.
"""

from __future__ import annotations

from dataclasses import dataclass

from identification.logs.replay import REPLAYED, replayed_share
from identification.robot.robot import Robot


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
        """The repetition as a finding of JSON."""
        return {"kind": "repeated motion", "log": self.log, "share": self.share}


def find_repetitions(robot: Robot) -> tuple[Repetition, ...]:
    """Returns the confirming parts and records of a robot that repeat what is fitted."""
    fitted = [log.part("estimation") for log in (robot.log, *robot.others)]
    many = bool(robot.others) or robot.file.horizon is not None
    whole = many and bool(robot.records)  # then each log is fitted from end to end
    unseen = [] if whole else [log.part("validation") for log in (robot.log, *robot.others)]
    pieces = [robot.log, *robot.others] if whole else fitted
    shares = ((log.name, replayed_share(pieces, log)) for log in (*unseen, *robot.records))
    return tuple(Repetition(name, share) for name, share in shares if share > REPLAYED)
