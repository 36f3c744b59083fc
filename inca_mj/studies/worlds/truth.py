"""The truth about a world, kept apart from what its log says."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from identification.logs.log import Log
from inca_mj.studies.worlds.effect import HiddenEffect


@dataclass(frozen=True, eq=False, kw_only=True)
class HiddenTruth:
    """The answer to a world.

    Attributes:
        seed: of the world.
        effects: what was on.
        ratios: of each effect, where it was asked for by ratio.
        parameters: every true value by name, start pose included.
        noise_rms: of the measurement [rad].
        error_rms: of the unlogged error of the currents [A].
        angles: true angles at the samples, shape (n, 8) [rad].
        error: the unlogged error of the currents, shape (n, 8) [A].
    """

    seed: int
    effects: tuple[HiddenEffect, ...]
    ratios: tuple[float, ...]
    parameters: Mapping[str, float]
    noise_rms: float
    error_rms: float
    angles: np.ndarray = field(repr=False)
    error: np.ndarray = field(repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "parameters", MappingProxyType(dict(self.parameters)))
        for array in (self.angles, self.error):
            array.setflags(write=False)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the effects."""
        return tuple(effect.name for effect in self.effects)

    @property
    def where(self) -> tuple[str, ...]:
        """The part of the robot each effect acts on."""
        return tuple(effect.where for effect in self.effects)

    @property
    def sizes(self) -> tuple[dict[str, float], ...]:
        """The numbers of each effect's law."""
        return tuple(effect.values() for effect in self.effects)

    def as_dict(self) -> dict[str, Any]:
        """Returns everything but the arrays, for a file of labels."""
        return {
            "seed": self.seed,
            "effects": [
                {"name": e.name, "where": e.where, "sizes": e.values()} for e in self.effects
            ],
            "ratios": list(self.ratios),
            "parameters": dict(self.parameters),
            "noise_rms": self.noise_rms,
            "error_rms": self.error_rms,
        }


class HiddenWorld(NamedTuple):
    """A log, and the truth about it."""

    log: Log
    truth: HiddenTruth
