"""The odds of an effect among what was refitted in its place.

What physics forbids takes its share of the odds and is no other name. A curve of the data is no
rival of a law, which it can imitate, and the same force by another name (`find_twin`) is none. The
same effect at more places is the same name: what it explains there is no reason to doubt this one.
So is the same effect with a value of each record; an input that comes late in all records is a
shift of their clocks.
"""

from __future__ import annotations

from dataclasses import dataclass

from identification.discovery.impossible import IMPOSSIBLE
from identification.effects.effect import Effect
from identification.prediction.fits.model import WindowModel
from identification.prediction.judging.evidence import compute_confidence
from identification.prediction.judging.trial import Contender, evidences, find_twin
from identification.prediction.scoring.screening import contains

LATE = {"time_shift": "delay"}  # what a shift is called that is the same in all records


@dataclass(frozen=True)
class Odds:
    """The odds of an effect and of its rivals."""

    own: float  # share of the effect
    rivals: tuple[tuple[Contender, float], ...]  # others that may be meant, each with its share
    forbidden: float  # share of those that physics forbids
    compared: int  # how many others were compared with it
    twin: str  # name of the effect that is the same force by another name; "" where there is none

    @property
    def likeliest(self) -> tuple[Contender, float] | None:
        """The rival with the largest share; None without rivals."""
        return max(self.rivals, key=lambda rival: rival[1], default=None)


def find_odds(accepted: Contender, final: WindowModel) -> Odds:
    """Returns the odds of an accepted effect among its alternatives.

    Args:
        accepted: the effect.
        final: the model with it, whose sizes tell whether it has a twin.
    """
    mine = accepted.candidate
    is_law = not mine.effect.is_curve
    twin = find_twin(final, mine)
    others = [
        o for o in accepted.alternatives
        if not (is_law and o.candidate.effect.is_curve) and o.candidate.effect.name != twin
        and not _is_same_in_records(o.candidate.effect, mine.effect)
    ]  # fmt: skip
    possible = [o for o in others if o.doubt not in IMPOSSIBLE]
    forbidden = [o for o in others if o.doubt in IMPOSSIBLE and not contains(o.candidate, mine)]
    shares = compute_confidence(evidences([accepted, *possible, *forbidden]))
    last = 1 + len(possible)
    rivals = zip(possible, map(float, shares[1:last]), strict=True)
    return Odds(float(shares[0]), tuple(rivals), float(shares[last:].sum()), len(others), twin)


def _is_same_in_records(other: Effect, mine: Effect) -> bool:
    """Returns whether an effect is another one with a value of each record."""
    names = {LATE.get(other.name, other.name), LATE.get(mine.name, mine.name)}
    return other.is_of_records and not mine.is_of_records and len(names) == 1
