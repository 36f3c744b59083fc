"""Where a force is missing: at which joint, in which part of its range and direction, how large.

Over a horizon it is read off the force that the joint would need, along a free run off the smooth
force that would explain the residual:

    f̄(i, ±) = mean of f over the samples in bin i of the position at which the rate is ± > 0

The place is the node or bin and the direction with the largest |f|, with those beside it that have
at least half of it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import floor, log10, nan

import mujoco
import numpy as np

from identification.discovery.missing_forces import MissingForce
from identification.discovery.result import Discovery
from identification.logs.log import Log
from identification.model.predictor import output_columns
from identification.quantities import alike
from identification.report.discovery.horizon_gap import find_gap
from identification.report.discovery.needed_forces import NeededForce
from identification.shares import percent

OWN = {  # what tells a place of a joint by itself: the words before its ends
    "position of {}": "near",
    "rate of {}": "at rates of",
    "force of the drives of {}": "at forces of its drives of",
    "time": "at times of",
}
WAYS = {  # directions of the motion, in words
    "": "", "both": ", in both directions", "rising": ", rising", "falling": ", falling",
    "against": ", in both directions, against the motion",
    "with": ", in both directions, with the motion",
}  # fmt: skip
DIGITS = 2  # of a force, and of the ends of a place
HALF = 0.5  # of the largest force: as much is of the same place
BINS = 8  # of a range of positions
FEWEST = 5  # samples, or windows, of a bin and a direction


@dataclass(frozen=True)
class MissingPlace:
    """A force that is missing, and where."""

    joint: str  # on which it acts
    reads: str  # what tells the place, such as "position of elbow" or "time"
    unit: str  # of that
    low: float  # end of the place, in `unit`
    high: float  # the other end
    # the direction of the motion: "rising", "falling", "both", "against" or "with" where the force
    # turns with the motion, "" where it is not known
    moves: str
    force: float  # at the place, in `force_unit`; against or with the motion its magnitude
    std: float  # of it by the noise alone; NaN where it is not known
    force_unit: str  # N or N m

    @property
    def size(self) -> str:
        """The force with its unit: a first estimate, of which two digits are told."""
        return f"about {alike([self.force], self.force_unit, DIGITS)[0]}"

    @property
    def own(self) -> str | None:
        """The words before the ends of the place; None where another joint tells it."""
        return next((OWN[w] for w in OWN if self.reads == w.format(self.joint)), None)

    @property
    def range(self) -> str:
        """Where it is, in words."""
        low, high = alike([self.low, self.high], self.unit, self._digits)
        number, _, unit = low.partition(" ")
        ends = f"{number if high.endswith(unit) else low} to {high}"
        if self.low == self.high:
            ends = high
        if self.own is None:
            return f"where the {self.reads} is {ends}{WAYS[self.moves]}"
        way = ""
        if self.reads.startswith("rate") and self.low * self.high > 0:  # it drives or brakes
            way = f", {'with' if self.low * self.force > 0 else 'against'} the motion"
        return f"{self.own} {ends}{way}{WAYS[self.moves]}"

    @property
    def _digits(self) -> int:
        """Digits of the ends, so many that they tell the width of the place."""
        far, width = max(abs(self.low), abs(self.high)), self.high - self.low
        return DIGITS if not width > 0 else max(DIGITS, floor(log10(far)) - floor(log10(width)) + 1)

    def __str__(self) -> str:
        """Returns the answer as a clause."""
        return f"joint {self.joint}, {self.range}: {self.size} are missing"


def find_place(found: Discovery) -> MissingPlace | None:
    """Returns where the largest force is missing; None where no force is known, or none is."""
    if found.verdict != "unknown effect":
        return None
    gap = find_gap(found)
    if gap is None:
        return _along(found, found.missing_forces)
    forces = gap.needed.forces
    return place_of(forces[0]) if forces else None


def place_of(needed: NeededForce) -> MissingPlace:
    """Returns the place of the force that a joint would need over a horizon."""
    (way, top), nodes = needed.largest, needed.nodes
    of_nodes, known = needed.force, needed.known
    same = known & (of_nodes * np.sign(of_nodes[way, top]) >= HALF * abs(of_nodes[way, top]))
    first, last = _beside(same[way], top)
    # a node tells of the force to half the way to the next one
    edges = np.concatenate([nodes.at[:1], (nodes.at[1:] + nodes.at[:-1]) / 2, nodes.at[-1:]])
    top = first + int(np.argmax(np.abs(of_nodes[way, first : last + 1])))  # the surest one before
    force, moves = float(of_nodes[way, top]), ""
    if needed.has_sides:
        other, moves = of_nodes[1 - way, top] if len(of_nodes) > 1 else force, "both"
        is_known = len(of_nodes) == 1 or bool(known[1 - way, top])
        if not is_known or abs(other) < HALF * abs(force):
            moves = ("rising", "falling")[way]
        elif other * force < 0:
            moves = "with" if force * (1 - 2 * way) > 0 else "against"
            force = abs(force)
    return MissingPlace(
        nodes.joint, nodes.reads, nodes.unit, float(edges[first]), float(edges[last + 1]), moves,
        force, float(needed.std[way, top]), needed.unit,
    )  # fmt: skip


def force_line(needed: NeededForce) -> str:
    """Returns what a force at a joint would explain, and where it would be largest.

    It is a first estimate, whose std by the noise alone would say too much.
    """
    at, reads = place_of(needed), needed.nodes.reads
    return (
        f"a force on {at.joint} that depends on the {reads} would remove {percent(needed.fall)} of"
        f" the fitted error; it would be largest {at.range}: {at.size}"
    )


def _beside(same: np.ndarray, top: int) -> tuple[int, int]:
    """Returns the first and the last of the places about `top` that are of the same kind."""
    first = last = top
    while first > 0 and same[first - 1]:
        first -= 1
    while last < len(same) - 1 and same[last + 1]:
        last += 1
    return first, last


def _measured(model: mujoco.MjModel, log: Log, joint: str) -> int | None:
    """Returns the output that measures the position of a joint; None where none does."""
    known = [model.joint(j).name for j in range(model.njnt)]
    if joint not in known:
        return None
    place = ("qpos", int(model.joint(joint).qposadr[0]))
    columns = output_columns(model, log.output_names)
    return columns.index(place) if place in columns else None


def _along(found: Discovery, forces: Sequence[MissingForce]) -> MissingPlace | None:
    """Returns the place of the largest mean force along a free run."""
    if found.run is None:
        return None
    for missing in sorted(forces, key=lambda m: -m.share):
        every = [_along_joint(found, missing, k, joint) for k, joint in enumerate(missing.names)]
        if places := [at for at in every if at is not None]:
            return max(places, key=lambda at: abs(at.force))
    return None


def _along_joint(
    found: Discovery, missing: MissingForce, k: int, joint: str
) -> MissingPlace | None:
    """Returns where a force on one joint is largest; None where no output measures the joint."""
    log = found.run.log if found.run else found.records[0].log
    model, unit = found.final.plant.model, missing.units[k]
    column = _measured(model, log, joint)
    if column is None:
        return None
    f = missing.force[:, k]
    x = log.outputs[: len(f), column]
    if len(x) < 2 or np.ptp(x) == 0:
        return None
    edges = np.linspace(x.min(), x.max(), BINS + 1)
    bins = np.clip(np.searchsorted(edges, x, side="right") - 1, 0, BINS - 1)
    rising = np.gradient(x) > 0
    mean = np.zeros((2, BINS))
    for way in (0, 1):
        mine = rising == bool(way)
        count = np.bincount(bins[mine], minlength=BINS)
        total = np.bincount(bins[mine], f[mine], BINS)
        enough = count >= FEWEST
        mean[way, enough] = total[enough] / count[enough]
    way, top = (int(i) for i in np.unravel_index(np.argmax(np.abs(mean)), mean.shape))
    if not mean[way, top]:
        return None
    sign = np.sign(mean[way, top])
    first, last = _beside(mean[way] * sign >= HALF * abs(mean[way, top]), top)
    both = mean[1 - way, first : last + 1] * sign
    is_one_way = bool(np.all(both < HALF * abs(mean[way, top])))
    return MissingPlace(
        joint, f"position of {joint}", log.units.get(log.output_names[column], ""),
        float(edges[first]), float(edges[last + 1]),
        ("falling", "rising")[way] if is_one_way else "", float(mean[way, top]), nan, unit,
    )  # fmt: skip
