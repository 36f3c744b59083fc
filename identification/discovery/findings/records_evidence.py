"""The evidence of a finding about records that are predicted over a horizon."""

from __future__ import annotations

from dataclasses import dataclass
from math import nan


@dataclass(frozen=True)
class RemainingError:
    """An error on unseen records that no named effect explains."""

    noise_ratio: float  # its rms over that of the sensors' noise
    # of which both are, the one whose error is the most times its noise; "" where they are of all
    # outputs together
    output: str = ""
    records: tuple[str, ...] = ()  # names of the records whose unseen windows it is of


@dataclass(frozen=True)
class DifferentRecord:
    """A record that is predicted much worse than the others."""

    record: str  # its name
    ratio: float  # rms error of its windows over that of the others' windows (geometric means)
    chance: float  # of as large a difference by luck
    others: tuple[str, ...] = ()  # names of the others


@dataclass(frozen=True)
class UnprovenEffect:
    """An effect that predicts unseen records better on average, and yet is not proven."""

    name: str  # of the effect
    phrase: str  # the effect in words, as its catalogue has them
    where: str  # its place
    fall: float  # relative fall of the unseen mean square, at the horizon
    t: float  # of its gain over blocks there
    doubt: str  # what is against it, a word of `identification.prediction.judging.trial.Doubt`
    luck: float = nan  # see `RejectedEffect.luck`


@dataclass(frozen=True)
class ShiftedRecord:
    """A record whose inputs are shifted in time against its outputs."""

    record: str  # its name
    shift: float  # how much later the inputs act than their stamps say [s]
    std: float  # of the shift, by blocks of windows [s]
    fall: float  # of the record's mean square with the shift, relative
    chance: float  # of as much by luck, in this record


@dataclass(frozen=True)
class WorseFit:
    """A fit of the nominal model that made predictions of unseen records worse."""

    rise: float  # of the mean square on unseen records, relative
