"""Does a fit predict unseen records worse than the values with which it began, maybe by chance?

A fit that is proven to be worse is told otherwise, and its values are not to be used. One that is
worse and not proven to be is still no better, and a reader should not have to find that out from
two numbers.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification.robot.fitting import RobotFit
from identification.robot.record_error import Confirmation
from identification.robot.worse_unit import worse_unit

LEAST = 0.01  # rise of the mean square that is told; the noise of a right fit makes less


def no_better(result: RobotFit, confirmed: Sequence[Confirmation]) -> list[str]:
    """Returns a sentence where the fitted values predict worse and this is not proven, or none."""
    if result.is_worse or result.stopped or not confirmed:
        return []
    if result.found.horizon is not None:
        before, after = result.found.unseen_rms
    else:
        before, after = (_over_all([getattr(c, k) for c in confirmed]) for k in ("before", "after"))
    rise = (after / before) ** 2 - 1 if before > 0 else 0.0
    if not rise > LEAST:
        return worse_unit(confirmed)
    return [
        "The fitted values predict what was not fitted worse than the values with which the fit"
        f" began (mean square {100 * rise:+z.0f} %). This may be chance, but it does not confirm"
        " the fitted values: fit a longer log, or more logs, before you use them.",
        *worse_unit(confirmed),
    ]


def _over_all(rms: Sequence[float]) -> float:
    """Returns the rms over records, each of which counts alike."""
    return float(np.sqrt(np.mean(np.square(rms))))
