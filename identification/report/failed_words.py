"""The candidates that a search tried and could not evaluate, in lines."""

from __future__ import annotations

from identification.discovery.attempts import Failed
from identification.discovery.result import Discovery
from identification.prediction.result import RecordsDiscovery

FAILED = "tried, and not possible to simulate"
MANY = 8  # lines; of more the count is told


def failed_lines(found: Discovery | RecordsDiscovery) -> list[str]:
    """Returns a line for each candidate that failed, and one for those that are left out.

    Args:
        found: the discovery.
    """
    lines = [_line(f) for f in found.failed[:MANY]]
    more = len(found.failed) - len(lines)
    return [*lines, f"and {more} more"] if more > 0 else lines


def _line(failed: Failed) -> str:
    place = f", {failed.where}" if failed.where else ""
    return f"{failed.name.replace('_', ' ')}{place}: {failed.outcome}"
