"""The question of a search along a free run; it stays the same during the search."""

from __future__ import annotations

from dataclasses import dataclass

from identification.discovery.moves import Task
from identification.logs.log import Log
from identification.logs.parts import Parts


@dataclass(frozen=True, kw_only=True)
class DiscoveryTask(Task):
    """The question what a model lacks to explain one log."""

    log: Log  # its part `estimation` (or first half) is fitted; the rest is unseen and confirms
    # of what is unseen; None before the nominal fit, whose memory says how long they are
    parts: Parts | None = None
