"""The question that a discovery answers; it stays the same during a search."""

from __future__ import annotations

from dataclasses import dataclass

from identification.discovery.nominal_model import NominalModel
from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Effect
from identification.logs.log import Log


@dataclass(frozen=True)
class DiscoveryTask:
    """The question of a discovery: what does this model lack to explain this log?

    Attributes:
        nominal_model: the model with every candidate effect compiled in, and its free parameters.
        log: its part `estimation` (or first half) is fitted; the rest is unseen and confirms.
        effects: the candidates.
        options: all judgement constants.
    """

    nominal_model: NominalModel
    log: Log
    effects: tuple[Effect, ...]
    options: DiscoveryOptions
