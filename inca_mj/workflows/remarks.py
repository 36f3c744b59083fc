"""Remarks on a run that a user should know first: slack cables, a robot that left its room."""

from __future__ import annotations

import numpy as np

from inca_mj.robot.geometry import DRIVES
from inca_mj.twin.run import Run


def remarks(run: Run) -> tuple[str, ...]:
    """Returns sentences on a run whose numbers are right and of little use; none for a usual run.

    Args:
        run: the run.
    """
    return (*_slack(run), *_outside(run))


def _slack(run: Run) -> tuple[str, ...]:
    slack = (run.tension <= 0).mean(axis=0)
    if not slack.any():
        return ()
    cables = ", ".join(str(k + 1) for k in range(DRIVES) if slack[k] > 0)
    return (
        f"Slack for a part of the run: cable {cables} (the longest {100 * slack.max():.0f} % of"
        " it). A slack cable holds nothing, and winds up loosely on a real drum.",
    )


def _outside(run: Run) -> tuple[str, ...]:
    exits = run.twin.geometry.A
    low, high = exits.min(axis=0), exits.max(axis=0)
    beyond = ((run.position < low) | (run.position > high)).any(axis=1)
    if not beyond.any():
        return ()
    when = float(run.time[int(np.argmax(beyond))])
    return (
        f"The platform leaves the room between the exit points at {when:.2f} s: from there on this"
        " is no run of the real robot.",
    )
