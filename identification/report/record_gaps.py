"""The gap of each record of a discovery on its unseen samples, before and after."""

from __future__ import annotations

from typing import Any

import numpy as np

from identification.discovery.result import Discovery
from identification.logs.joined import JoinedLog, records_of, rows_of
from identification.quantities import alike

CONFIRMS = 0.75  # a record of which more is unseen was given to confirm


def record_gaps(found: Discovery) -> list[dict[str, Any]]:
    """Per record: its name, and the rms of free runs over its unseen samples.

    A record of which every sample was fitted has no gap: its rms are None.
    """
    whole = found.log.outputs
    errors = [whole - p for p in (found.predicted_before, found.predicted_after)]
    out, begun = [], 0
    for _, record in records_of(found.log):
        rows, unseen = slice(begun, begun + len(record)), ~rows_of(record, "estimation")
        begun += len(record)
        before, after = (
            float(np.sqrt(np.mean(e[rows][unseen] ** 2))) if unseen.any() else None for e in errors
        )
        role = "fit" if before is None or unseen.mean() < CONFIRMS else "confirm"
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
