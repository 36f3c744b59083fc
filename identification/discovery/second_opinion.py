"""What the torques that a measured motion needs say of what a search has named.

They come without a simulation and without the states of windows, from accelerations of the measured
positions (`identification.torques`). An effect that both ways prove rests on two legs; what only
one of them proves is told so. No search decides on them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

# named      they name it too
# alike      they name another effect, and predict as well with this one in its place
# alone      they name another effect, and would prove this one if it were alone
# unproven   they do not prove it
# forbidden  they would name it with a size that physics forbids, or beside such an effect
Standing = Literal["named", "alike", "alone", "unproven", "forbidden"]


@dataclass(frozen=True, kw_only=True)
class TorqueOpinion:
    """What the torques say of one effect."""

    name: str  # as in the catalogue
    where: str
    phrase: str = ""  # what it is, in words
    sizes: Mapping[str, tuple[float, float, str]]  # by name: value, std, unit; of a curve none
    # of the torques' mean square on data that no fit has seen, negative where it rises; None for a
    # friction that every fit of torques has
    fall: float | None
    t: float  # of the fall, or of the size
    chance: float | None = None  # of as much by luck, all candidates counted; None likewise
    standing: Standing  # with the torques
    # why it is not proven or no name of theirs, a word of `identification.torques.scores.Doubt` or
    # `identification.torques.evidence.Doubt`; "" where it is
    doubt: str = ""
    is_named: bool  # whether the search has named it
    is_first: bool = False  # whether it is what the torques name first
    free: str = ""  # number of the model that it changes, to be freed; "" where there is none

    @property
    def is_proven(self) -> bool:
        """Tells whether the torques prove it, alone or with others."""
        return not self.doubt
