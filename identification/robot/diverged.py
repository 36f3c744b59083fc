"""A search over a horizon that diverges, told with what a user wrote and can correct.

No simulation asks here whether a factor is the cause, because a search diverges at values that
nobody has written. So all factors are named, as what may be wrong.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from identification.errors import DivergenceError
from identification.logs.log import Log
from identification.robot.robot import Robot


@contextmanager
def told_of_factors(robot: Robot) -> Iterator[None]:
    """Adds to a divergence of the block the factors of the robot's logs, or where the step is."""
    try:
        yield
    except DivergenceError as error:
        raise DivergenceError(f"{error}. {_next_step(robot)}") from error


def _next_step(robot: Robot) -> str:
    file = robot.file
    where = (
        f"The step is timestep in <option> of {file.model}, and the nominal values are those of"
        f" {file.path}"
    )
    given = [said for log in (robot.log, *robot.others, *robot.records)
             for said in _factors(log, robot)]  # fmt: skip
    if not given:
        return where
    it = "it is" if len(given) == 1 else "they are"
    return f"First see whether {it} right: {'; '.join(given)}. {where}"


def _factors(log: Log, robot: Robot) -> list[str]:
    """Returns the factors of a log that change the size of its numbers, and what they make."""
    column = robot.file.columns
    return [
        f"the factor {f:g} of {column.get(n, n)} under [factors] for log {log.name!r}, which makes"
        f" numbers up to {float(np.abs(log.columns[n]).max()):.3g}"
        for n, f in log.factors.items()
        if abs(f) != 1 and n in log.columns
    ]
