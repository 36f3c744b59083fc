"""The gap of each record of a discovery on its unseen samples, before and after."""

from __future__ import annotations

from typing import Any

import numpy as np

from identification.discovery.result import Discovery
from identification.logs.joined import JoinedLog, records_of, rows_of
from identification.quantities import alike


def record_gaps(found: Discovery) -> list[dict[str, Any]]:
    """Per record: its name, its role, and the rms of free runs over its unseen samples.

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
        before, after = (
            float(np.sqrt(np.mean(e[rows][unseen] ** 2))) if unseen.any() else None for e in errors
        )
        role = "confirm" if confirmed and unseen.any() else "fit"
        out.append({"file": record.name, "role": role, "before": before, "after": after})
    return out


def record_lines(found: Discovery) -> list[str]:
    """The same as lines of text; nothing for a single record."""
    if not isinstance(found.log, JoinedLog):
        return []
    lines = ["unseen samples of each record:"]
    for gap in record_gaps(found):
        if gap["before"] is None:
            lines.append(f"  {gap['file']}: all of it was fitted")
            continue
        before, after = alike([gap["before"], gap["after"]], found.log.output_unit)
        worse = "; it is predicted worse" if gap["after"] > gap["before"] else ""
        lines.append(f"  {gap['file']}: {before} -> {after} rms{worse}")
    return lines
