"""What the forces of the drives say of a log and of other readings of it, without a simulation.

    η > 1         however light, friction, gravity, payload and springs may be, more is left of the
                  balance of forces than the drives gave

The balance is that of `identification.refusals.balance`, where masses may be off by a factor of
four, and with springs, which the model may lack too. A smaller motion needs less force for its
masses, and all else that it needs is free in the balance. So only a motion that is too large for
the forces has η > 1: where inertia needs all of them, a model that is more than eight times too
heavy would be needed for as much. Such a log is refused where another unit leaves far less. A
motion that is rougher than its noise (the steps of an encoder) has false accelerations: ψ is made
wider too, and the smallest η counts. A payload that the model lacks bars nothing.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import chain

import mujoco
import numpy as np

from identification.logs.log import Log
from identification.quantities import held
from identification.refusals.balance import Unbalanced, unbalanced, unbalanced_share
from identification.refusals.columns import Doubt, factor_readings, turned_units, unit_readings
from identification.refusals.readings import EXPLAINED, NEARER, SAME, UNEXPLAINED, Reading
from identification.refusals.turned_inputs import with_turned_ranges
from identification.shares import percent

WIDER = (1, 2, 4)  # times ψ; a fourfold one has 32 times less noise in its accelerations
DIGITS = 6  # of a change; a factor of 1000 and the unit mrad are the same one
NEEDED = 1.0  # η of a motion that the drives cannot have made


@dataclass(frozen=True)
class Balance:
    """The balance of forces of a log as it is read, which other readings are compared with."""

    model: mujoco.MjModel
    log: Log

    @cached_property
    def whole(self) -> Unbalanced | None:
        """What the balance leaves of the log as it is read."""
        return unbalanced(self.model, self.log)

    @property
    def as_read(self) -> np.ndarray | None:
        """η_j of each output, shape (ny,)."""
        return None if self.whole is None else self.whole.of_outputs

    @property
    def contradicts(self) -> bool:
        """Tells whether forces do not explain the log as it is read, or say nothing of it."""
        return self.as_read is None or bool((self.as_read > UNEXPLAINED).any())

    @property
    def excludes(self) -> bool:
        """Tells whether forces cannot be those of the log as it is read, whatever it lacks."""
        return self.whole is not None and self.whole.whole > NEEDED

    def confirms(self, reading: Reading, rest: np.ndarray) -> bool:
        """Returns whether forces speak for a reading that leaves ε (ny,).

        Where they say nothing, the reading must explain nearly all. Then they say nothing of
        another unit of a servo's setpoint and position either: it makes gravity and friction a
        smaller part of the motion, as a larger gain does, and the gain of a servo is a guess.
        """
        k = list(reading.columns)
        if self.as_read is None:
            is_rescaled = "units" in reading.kinds and np.any(reading.log.inputs != self.log.inputs)
            return bool(not is_rescaled and (rest[k] < UNEXPLAINED).all())
        other = self.of(reading)
        # Together, because a joint without a drive looks the same from both sides.
        return other is not None and bool(other[k].sum() < NEARER * self.as_read[k].sum())

    def decides(self, reading: Reading) -> str | None:
        """Says how much less of the forces is unexplained by a reading; None where not far less."""
        rest = None if self.as_read is None else self.of(reading)
        if self.as_read is None or rest is None or (rest > UNEXPLAINED).any():
            return None
        if rest.sum() > NEARER * self.as_read.sum():
            return None
        times = held(float(self.as_read.sum() / max(rest.sum(), np.finfo(float).tiny)))
        return (
            f"leaves {times} times as much of the drives' forces unexplained as it would"
            f" {reading.words}, whatever payload, gravity and friction it has; {reading.cure}"
        )

    def of(self, reading: Reading) -> np.ndarray | None:
        """Returns η_j of another reading of the log, shape (ny,)."""
        return unbalanced_share(with_turned_ranges(self.model, self.log, reading.log), reading.log)


def rescaled(
    model: mujoco.MjModel, doubt: Doubt, signs: bool = True, alone: bool = True
) -> tuple[Reading, str] | None:
    """Returns the unit in which the forces of the drives explain a motion that they else cannot.

    All outputs are in doubt. A sign may be turned besides where `signs`; such a unit counts where
    it leaves less than a fifth of the unit alone. Where `alone`, one column of several of a kind
    may be in another unit.

    Returns:
        Of the units that explain it the one that changes least, if none leaves a fifth of it, and
        in words what it explains; None where the motion can be as it is read.
    """
    log = doubt.log
    as_read = _least_share(model, log)
    if as_read is None or as_read <= NEEDED:
        return None
    both = turned_units(doubt) if signs else ()
    found: list[tuple[Reading, float]] = []
    for reading in chain(factor_readings(doubt), unit_readings(doubt, alone=alone), both):
        rest = unbalanced(model, reading.log, springs=True)
        if rest is not None and rest.whole <= min(EXPLAINED, NEARER * as_read):
            found.append((reading, rest.whole))
    if not found:
        return None
    least = min(rest for _, rest in found)
    near = [(r, rest) for r, rest in found if NEARER * rest <= least]
    # Rounded, so that of two readings that are the same the first one counts.
    reading, left = min(near, key=lambda each: round(_change(each[0].log, log), DIGITS))
    times = held(float(np.sqrt(as_read)))
    return reading, (
        f"needs forces {times} times those of the drives for this motion, whatever"
        f" payload and friction it has, and explains {percent(1 - left)} of them"
        f" {reading.words}; {reading.cure} (where the outputs are right, the inputs are in a larger"
        " unit: write that of the inputs)"
    )


def balanced_otherwise(
    model: mujoco.MjModel, doubt: Doubt, readings: Iterable[Reading]
) -> tuple[Reading, str] | None:
    """Returns the reading with which forces balance, where they do not as read, in words too.

    Nothing is simulated, so that forces alone must tell: η of all outputs must fall below what is
    unexplained, and to less than a fifth in all. With another unit it need only fall to a fifth of
    the largest one, because a robot may lack a force besides. Of several readings, it is the one
    that leaves least.
    """
    balance = Balance(model, doubt.log)
    as_read = balance.as_read
    if as_read is None or as_read.max() <= UNEXPLAINED:
        return None
    best, least = None, NEARER * float(as_read.sum())
    # a reading that explains less than half is no cure, however little the present one explains
    most = min(EXPLAINED, max(UNEXPLAINED, NEARER * float(as_read.max())))
    for reading in readings:
        rest = balance.of(reading)
        if rest is None or rest.sum() >= least:
            continue
        if rest.max() < (most if "units" in reading.kinds else UNEXPLAINED):
            best, least = (reading, rest), (1 - SAME) * float(rest.sum())
    if best is None:
        return None
    reading, rest = best
    before, after = (percent(1 - float(min(1.0, e.max()))) for e in (as_read, rest))
    return reading, (
        f"explains at most {before} of the force of a drive, whatever payload, gravity and friction"
        f" it has, and would explain {after} {reading.words}; {reading.cure}"
    )


def _change(other: Log, log: Log) -> float:
    """Returns how far another reading is from a log: Σ |ln factor| over its columns."""
    pairs = (other.outputs, log.outputs), (other.inputs, log.inputs)
    sizes = [[np.abs(x).max(axis=0) for x in pair] for pair in pairs]
    return sum(float(np.abs(np.log(a[b > 0] / b[b > 0])).sum()) for a, b in sizes)


def _least_share(model: mujoco.MjModel, log: Log) -> float | None:
    """Returns η with the ψ that leaves least; None where it cannot be had."""
    best: float | None = None
    for wider in WIDER:
        rest = unbalanced(model, log, springs=True, wider=wider)
        if rest is None:
            return best
        best = rest.whole if best is None else min(best, rest.whole)
        if best <= NEEDED:
            return best
    return best
