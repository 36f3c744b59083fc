"""The evidence of a finding about records that are predicted over a horizon."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class RemainingError:
    """An error on unseen records that no named effect explains.

    Attributes:
        noise_ratio: its rms over that of the sensors' noise.
        output: of which both are, the one whose error is the most times its noise; "" where they
            are of all outputs together.
    """

    noise_ratio: float
    output: str = ""


@dataclass(frozen=True)
class DifferentRecord:
    """A record that is predicted much worse than the others.

    Attributes:
        record: its name.
        ratio: rms error of its windows over that of the others' windows (geometric means).
        chance: of as large a difference by luck.
        others: names of the others.
    """

    record: str
    ratio: float
    chance: float
    others: tuple[str, ...] = ()


@dataclass(frozen=True)
class UnprovenEffect:
    """An effect that predicts unseen records better on average, and yet is not proven.

    Attributes:
        name: of the effect.
        phrase: the effect in words, as its catalogue has them.
        where: its place.
        fall: relative fall of the unseen mean square, at the horizon.
        t: of its gain over blocks.
        doubt: what is against it, a word of `identification.prediction.trial.Doubt`.
    """

    name: str
    phrase: str
    where: str
    fall: float
    t: float
    doubt: str


@dataclass(frozen=True)
class ShiftedRecord:
    """A record whose inputs are shifted in time against its outputs.

    Attributes:
        record: its name.
        shift: how much later the inputs act than their stamps say [s].
        std: of the shift, by blocks of windows [s].
        fall: of the record's mean square with the shift, relative.
        chance: of as much by luck, in this record.
    """

    record: str
    shift: float
    std: float
    fall: float
    chance: float


@dataclass(frozen=True)
class WorseFit:
    """A fit of the nominal model that made predictions of unseen records worse.

    Attributes:
        rise: of the mean square on unseen records, relative.
    """

    rise: float
