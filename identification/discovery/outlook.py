"""How far a search is: which of its stages, how long the rest takes, and what it has so far.

    rest = elapsed · (low … high)       where a stage begins, in wall time
    rest - passed                       within the stage, of which `passed` has gone by

A search has five stages. The third is repeated for each effect that is found, so that nobody knows
beforehand how long a search takes. `RESTS` of an evidence holds the range of the rest, as a share
of the time passed, for each stage and number of effects. On a slower machine, or with a longer log,
both times grow. benchmarks/forecast.py times searches and prints such ranges (the 10th and the 90th
percentile); one search is timed so far.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from identification.runtime.progress import duration

FIT, SCORES, EFFECT, CHECKS, LEFT = STAGES = (
    "the fit without effects", "scores of all candidates", "one effect more",
    "last checks", "what is left, and what the data could show",
)  # fmt: skip
Rest = tuple[float, float]  # of the elapsed time
Rests = Mapping[tuple[str, int], Rest]  # by stage, and number of effects when it begins


@dataclass
class Outlook:
    """The stages of a search as they begin.

    Attributes:
        say: is told a line where a stage begins.
        rests: what the rest took in other searches; a stage that is missing has no forecast.
        clock: the time [s].
        stage: that is at work.
        began: when the search began [s].
        entered: when the stage began [s].
        rest: forecast of the rest when the stage began, from and to [s]; None where none is known.
    """

    say: Callable[[str], None]
    rests: Rests
    clock: Callable[[], float] = time.monotonic
    stage: str = field(default="", init=False)
    began: float = field(default=0.0, init=False)
    entered: float = field(default=0.0, init=False)
    rest: Rest | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        self.began = self.clock()

    def enter(self, stage: str, effects: int = 0, said: str = "") -> None:
        """Begins a stage.

        Args:
            stage: one of `STAGES`.
            effects: that the model has.
            said: what is known now, behind the forecast.
        """
        self.stage, self.entered = stage, self.clock()
        table = [n for name, n in self.rests if name == stage]
        self.rest = None
        if table:
            low, high = self.rests[stage, min(effects, max(table))]
            elapsed = self.entered - self.began
            self.rest = low * elapsed, high * elapsed
        self.say(f"{self}{f'; {said}' if said else ''}")

    @property
    def left(self) -> Rest | None:
        """Forecast of what is left now, from and to [s]; None where none is known or left."""
        if self.rest is None:
            return None
        passed = self.clock() - self.entered
        low, high = (max(0.0, each - passed) for each in self.rest)
        return (low, high) if high > 0 else None

    def __str__(self) -> str:
        said = f"stage {1 + STAGES.index(self.stage)} of {len(STAGES)}, {self.stage}"
        return f"{said}: {told}" if (told := self._told()) else said

    def _told(self) -> str:
        left = self.left  # asked once: the clock goes on, and soon nothing is left
        if left is not None:
            return f"{between(*left)} left"
        return "" if self.rest is None else "it takes longer than forecast"


def between(low: float, high: float) -> str:
    """Returns a range of times as a person says it: 20 to 50 s, 40 s to 3 min, up to 5 s."""
    first, last = duration(_coarse(low)), duration(_coarse(high))
    if low < 1:
        return f"up to {last}"
    if first == last:
        return f"about {last}"
    size, _, unit = first.partition(" ")
    return f"{size} to {last}" if unit == last.partition(" ")[2] else f"{first} to {last}"


def _coarse(seconds: float) -> float:
    """Returns a time as precise as a forecast is: whole seconds, then five, then minutes."""
    step = 1.0 if seconds < 20 else 5.0 if seconds < 120 else 60.0
    return max(1.0, step * round(seconds / step))
