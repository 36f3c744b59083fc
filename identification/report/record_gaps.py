"""The gap of each record of a discovery on its unseen samples, before and after."""

from __future__ import annotations

from typing import Any

import numpy as np

from identification.discovery.result import Discovery
from identification.logs.by_unit import relative, rms_by_unit
from identification.logs.joined import JoinedLog, records_of, rows_of
from identification.report.error_words import pair_words


def record_gaps(found: Discovery) -> list[dict[str, Any]]:
    """Returns for each record its name, its role, and the rms of free runs over unseen samples.

    A record of which every sample was fitted has no gap: its rms are None. Records are fitted whole
    where others confirm, and those others are all that is left.
    """
    whole = found.log.outputs
    errors = [whole - p for p in (found.predicted_before, found.predicted_after)]
    records = [record for _, record in records_of(found.log)]
    unseens = [~rows_of(record, "estimation") for record in records]
    confirmed = not all(unseen.any() for unseen in unseens)
    out, begun = [], 0
    for record, unseen in zip(records, unseens, strict=True):
        rows = slice(begun, begun + len(record))
        begun += len(record)
        each = [e[rows][unseen] for e in errors]
        before, after = (float(np.sqrt(np.mean(e**2))) if unseen.any() else None for e in each)
        before_of, after_of = (rms_by_unit(e, record) if unseen.any() else None for e in each)
        role = "confirm" if confirmed and unseen.any() else "fit"
        out.append(
            {"file": record.name, "role": role, "before": before, "after": after,
             "before_by_unit": before_of, "after_by_unit": after_of}
        )  # fmt: skip
    return out


def record_lines(found: Discovery) -> list[str]:
    """Returns the gaps of records as lines of text; none for a single record."""
    if not isinstance(found.log, JoinedLog):
        return []
    lines, gaps = ["unseen samples of each record:"], record_gaps(found)
    pairs = [(g["before_by_unit"], g["after_by_unit"]) for g in gaps if g["before"] is not None]
    words = iter(pair_words(pairs, "rms" if any(len(of) > 1 for of, _ in pairs) else "", 3))
    for gap in gaps:
        if gap["before"] is None:
            lines.append(f"  {gap['file']}: all of it was fitted")
            continue
        pair = gap["before_by_unit"], gap["after_by_unit"]
        before, after = next(words)
        rms = " rms" if len(pair[0]) == 1 else ""
        worse = "; it is predicted worse" if relative(*pair[::-1]) > 1 else ""
        lines.append(f"  {gap['file']}: {before} -> {after}{rms}{worse}")
    return lines
