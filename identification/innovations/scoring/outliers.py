"""Times at which outputs jump, as the innovations tell, and jumps of sensors at these times.

A sensor that jumps gives one large innovation, and what the predictor makes of it fades within a
few samples: a jump of a sensor at a wrong time explains nothing. So its time is not looked for on a
grid only, but where an innovation is beyond chance among all samples of all outputs.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from identification.chances import normal_level
from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Candidate
from identification.logs.joined import records_of
from identification.logs.log import Log

# Times of jumps of an output that are tried; a log with more of them has another fault.
MAX_JUMPS = 3


def find_outlier_times(
    innovations: np.ndarray, log: Log, apart: float, options: DiscoveryOptions
) -> tuple[float, ...]:
    """Returns times [s] of the record at which innovations are beyond chance, the largest first.

    Args:
        innovations: in units of σ, shape (N, ny).
        log: whose samples they are.
        apart: outliers that are nearer than that are one [s].
        options: what is beyond chance.
    """
    size = np.abs(innovations).max(axis=1)
    time = np.concatenate([record.time - record.time[0] for _, record in records_of(log)])
    least = normal_level(options.significance / (2 * innovations.size))
    out: list[float] = []
    for k in np.argsort(-size):
        if size[k] < least or len(out) == MAX_JUMPS:
            break
        if all(abs(time[k] - other) >= apart for other in out):
            out.append(float(time[k]))
    return tuple(out)


def list_at_outliers(
    candidates: Sequence[Candidate], innovations: np.ndarray, log: Log, options: DiscoveryOptions
) -> tuple[Candidate, ...]:
    """Returns jumps of sensors at the times at which the outputs jump, at each place.

    Args:
        candidates: of all effects; of those with a reading and a stepped shape one at each place
            counts.
        innovations: as of `find_outlier_times`.
        log: as of `find_outlier_times`.
        options: as of `find_outlier_times`.
    """
    each = {c.key: c for c in candidates if "reading" in c.effect.hooks}
    out: list[Candidate] = []
    for c in each.values():
        for shape in c.effect.shapes:
            if shape.step:
                times = find_outlier_times(innovations, log, shape.step, options)
                out += [replace(c, shape={**c.shape, shape.name: t}) for t in times
                        if shape.lower <= t <= shape.upper]  # fmt: skip
    return tuple(out)
