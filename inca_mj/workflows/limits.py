"""How far a run went: the limits of what an input may do, and what a user should know first.

    low ≤ i_k ≤ high;    T_k > margin;    |p - p(0)| ≤ reach in x, y, z;    angle(R(0)ᵀ R) ≤ turn

When a slack cable becomes taut again, the platform is jerked. After this the motion is chaotic, and
local sensitivities grow without meaning. So the margin of tension is also needed for a Fisher
information that can be believed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from identification.errors import InputError
from identification.shares import percent
from inca_mj.robot.geometry import DRIVES
from inca_mj.twin.run import Run


@dataclass(frozen=True)
class Limits:
    """Limits of an experiment.

    Attributes:
        low: smallest current [A].
        high: largest current [A].
        margin: every tension stays above it at every sample [N].
        reach: largest distance of the platform from its start in each of x, y, z [m].
        turn: largest rotation of the platform from its start [rad].

    Raises:
        InputError: a limit leaves no room.
    """

    low: float = 0.0
    high: float = 2.0
    margin: float = 0.2
    reach: float = 0.35
    turn: float = float(np.radians(60.0))

    def __post_init__(self) -> None:
        if not -np.inf < self.low < self.high < np.inf:
            raise InputError(
                f"currents from {self.low:g} A to {self.high:g} A leave nothing to choose;"
                " give a largest current above the smallest"
            )
        if not 0 <= self.margin < np.inf:
            raise InputError(
                f"a tension margin of {self.margin:g} N is no margin; cables only pull, so give"
                " zero or more"
            )
        if not self.reach > 0 or not self.turn > 0:
            raise InputError(
                f"a workspace of ±{self.reach:g} m and {np.degrees(self.turn):g} deg holds no"
                " motion; give positive numbers"
            )


@dataclass(frozen=True)
class Extent:
    """The extent of currents, tensions and pose in a run."""

    low: float  # smallest current [A]
    high: float  # largest current [A]
    tension: float  # least tension [N]
    reach: float  # largest move of the platform along x, y or z from its start [m]
    turn: float  # largest rotation from its start [rad]

    def within(self, limits: Limits) -> bool:
        """Returns whether a run kept the limits."""
        slack = 1e-12  # for rounding errors
        return (
            self.low >= limits.low - slack
            and self.high <= limits.high + slack
            and self.tension > limits.margin
            and self.reach <= limits.reach
            and self.turn <= limits.turn
        )


def extent(run: Run) -> Extent:
    """Returns how far a run went; between quaternions c₀ and c the angle is 2 arccos |c₀ᵀ c|."""
    turns = np.abs(run.qpos[:, 3:7] @ run.qpos[0, 3:7])
    return Extent(
        float(run.currents.min()),
        float(run.currents.max()),
        float(run.tension.min()),
        float(np.abs(run.position - run.position[0]).max()),
        float(2 * np.arccos(np.minimum(turns, 1.0)).max()),
    )


def remarks(run: Run) -> tuple[str, ...]:
    """Returns sentences on a run whose numbers are right and of little use; none for others."""
    out, slack = [], (run.tension <= 0).mean(axis=0)
    if slack.any():
        cables = ", ".join(str(k + 1) for k in range(DRIVES) if slack[k] > 0)
        out.append(
            f"Slack for a part of the run: cable {cables} (the longest"
            f" {percent(float(slack.max()))} of it). A slack cable holds nothing, and winds up"
            " loosely on a real drum."
        )
    low, high = run.twin.geometry.A.min(axis=0), run.twin.geometry.A.max(axis=0)
    beyond = ((run.position < low) | (run.position > high)).any(axis=1)
    if beyond.any():
        when = float(run.time[int(np.argmax(beyond))])
        out.append(
            f"The platform leaves the room between the exit points at {when:.2f} s: from there on"
            " this is no run of the real robot."
        )
    return tuple(out)
