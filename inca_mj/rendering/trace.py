"""The path that was asked of the platform and the platform's trace, as lines of a picture.

e = p - p_d        true position less that asked
p_d + k e          is drawn: a deviation of 2 mm is nothing in a frame of 3 m, 20 times it is seen
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil

import numpy as np

from inca_mj.rendering.colours import ASKED, HALO, TRACE
from inca_mj.rendering.overlay import Line
from inca_mj.twin.run import Run

MAGNIFY = 20.0  # k
LAST = 5.0  # [s] that a trace shows: less than a turn at 1 rad/s
_FINE = 0.02  # [s] between corners of a line
_MOST = 2000  # corners of a line, of a long run too


@dataclass(frozen=True)
class Trace:
    """The trace of a platform that follows what is asked.

    Attributes:
        time: sample times, shape (N,) [s].
        asked: positions asked of the platform, shape (N, 3) [m].
        error: true positions less those, shape (N, 3) [m].
        magnify: k, by which the error is drawn larger.
    """

    time: np.ndarray
    asked: np.ndarray
    error: np.ndarray
    magnify: float = MAGNIFY

    def distance(self, at: float) -> float:
        """Returns the distance from what is asked at a time [s], linear between samples [m]."""
        return float(np.linalg.norm(_between(self.time, self.error, at)))

    def lines(self, at: float, thickness: float) -> tuple[Line, ...]:
        """Returns the trace of the last seconds, the whole path, and a line from trace to target.

        Args:
            at: the time [s].
            thickness: of the path; the trace is thicker [px].
        """
        step = max(1, round(_FINE / (self.time[1] - self.time[0])), ceil(len(self.time) / _MOST))
        corners = np.union1d(np.arange(0, len(self.time), step), [len(self.time) - 1])
        times = self.time[corners]
        shown = corners[(times >= at - LAST) & (times < at)]
        asked, error = _between(self.time, self.asked, at), _between(self.time, self.error, at)
        end = asked + self.magnify * error
        trace = np.vstack([self.asked[shown] + self.magnify * self.error[shown], end])
        return (
            Line(trace, HALO, 4 * thickness),
            Line(trace, TRACE, 2.5 * thickness),
            Line(self.asked[corners], ASKED, thickness),  # over a trace that hardly leaves it
            Line(np.array([asked, end]), TRACE, thickness),
        )


def trace_of(run: Run, magnify: float = MAGNIFY) -> Trace | None:
    """Returns the trace of a run; None where nothing was asked."""
    if run.asked is None:
        return None
    return Trace(run.time, run.asked, run.position - run.asked, magnify)


def _between(time: np.ndarray, values: np.ndarray, at: float) -> np.ndarray:
    return np.array([np.interp(at, time, column) for column in values.T])
