"""What the torques that a measured motion needs say of what a search has named.

They come without a simulation and without the states of windows, from accelerations of the measured
positions (`identification.torques`). An effect that both ways prove rests on two legs; what only
one of them proves is told so. No search decides on them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class TorqueOpinion:
    """What the torques say of one effect."""

    name: str  # as in the catalogue
    where: str
    sizes: Mapping[str, tuple[float, float, str]]  # by name: value, std, unit
    # of the torques' mean square on data that no fit has seen, negative where it rises; None for a
    # friction that every fit of torques has
    fall: float | None
    t: float  # of the fall, or of the size
    is_proven: bool
    is_named: bool  # whether the search has named it too
