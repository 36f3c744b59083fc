"""The question of a search along a free run; it stays the same during the search."""

from __future__ import annotations

from dataclasses import dataclass

from identification.discovery.moves import Task
from identification.logs.joined import Log


@dataclass(frozen=True, kw_only=True)
class DiscoveryTask(Task):
    """The question what a model lacks to explain one log.

    Attributes:
        log: its part `estimation` (or first half) is fitted; the rest is unseen and confirms.
    """

    log: Log
