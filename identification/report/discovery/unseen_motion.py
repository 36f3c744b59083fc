"""What fitted data cannot show, because it acts only where the data that confirm go.

    fitted error ≈ noise  and  unseen error ≫ noise        per record, by the outputs' units

An end stop that only one record meets leaves no trace in the other, so that no candidate can be
fitted. The answer is then not another effect but other data: what confirms is to be fitted too.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification.discovery.effect_results import RecordError
from identification.discovery.result import Discovery
from identification.estimation.metrics import relative
from identification.logs.log import Log
from identification.quantities import quantity
from identification.report.words.errors import listed
from identification.report.words.parts import records_words
from identification.shares import times

AT_NOISE = 1.3  # times the noise: fitted data that err by no more show nothing of what is missing
FAR = 3.0  # times the noise: unseen data that err by more do
BEYOND = 0.02  # of the fitted range, by which another one goes farther
SHOWN = 2  # outputs whose ranges are told


def unseen_motion(found: Discovery) -> list[str]:
    """Returns sentences on what only the unseen data show; none where the fitted data show it too.

    Args:
        found: a discovery that names nothing.
    """
    fitted = [e for e in found.errors if e.role == "fit"]
    unseen = [e for e in found.errors if e.role == "confirm" and _ratio(e, found) > FAR]
    if found.horizon is None or not unseen or not fitted:
        return []
    if max(_ratio(e, found) for e in fitted) > AT_NOISE:
        return []
    at_most = max(_ratio(e, found) for e in unseen)
    mine, others = records_words([e.name for e in unseen]), records_words([e.name for e in fitted])
    said = (
        f"The fitted data do not show what is missing: in {others} the model errs by no more than"
        f" the noise, and in {mine} by up to {times(at_most)} as much. So it acts only where the"
        " unseen data go, and no effect could be fitted."
    )
    logs = {r.log.name: r.log for r in found.records}
    more = _farther([logs[e.name] for e in fitted], [logs[e.name] for e in unseen])
    said += f" They go farther: {listed(more)}." if more else ""
    advice = f"Fit {mine} too, so that its second half confirms, or record a log that goes there."
    if any(e.name.endswith("]") for e in fitted):  # a half of a log
        advice = "Record a log whose two halves both go there."
    return [said, advice]


def _ratio(error: RecordError, found: Discovery) -> float:
    """Returns the error of the model without effects on a record, over the noise."""
    units = found.floor
    by_unit = error.before_by_unit if len(units) > 1 else dict.fromkeys(units, error.before)
    return relative(by_unit, units)


def _farther(fitted: Sequence[Log], unseen: Sequence[Log]) -> list[str]:
    """Returns the outputs that leave their fitted range by most, in words, the farthest first."""
    known, new = (np.concatenate([log.outputs for log in logs]) for logs in (fitted, unseen))
    (least, most), (low, high) = ((y.min(axis=0), y.max(axis=0)) for y in (known, new))
    width = np.maximum(most - least, np.finfo(float).tiny)
    by = np.maximum(least - low, high - most) / width
    out, log = [], unseen[0]
    for k in np.argsort(-by)[:SHOWN]:
        name, unit = log.output_names[k], log.units.get(log.output_names[k], "")
        if by[k] > BEYOND:
            ranges = [
                f"{quantity(float(a), unit=unit)} to {quantity(float(b), unit=unit)}"
                for a, b in ((low[k], high[k]), (least[k], most[k]))
            ]
            out.append(f"{name} from {ranges[0]}, where the fitted data have {ranges[1]}")
    return out
