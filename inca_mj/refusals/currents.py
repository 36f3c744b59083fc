"""Other signs and places of a log's currents: does the twin move as the log only under these?

One current moves all angles, so that all of them judge it together, by γ (`angles.apart`): an angle
that hardly moves may be anywhere in a right log, and then another current may bring it nearer by
chance. Another reading must leave a tenth of γ, and every angle as near to the twin as that of a
right log (`bounds`).

Readings are proposed in two ways. Where the angles are right, feedback tells the places and signs
of all currents at once (`inca_mj.refusals.agreement`). Where an angle is wrong too, as in a drive
whose angle and current are turned or exchanged together, each current alone and each pair is read
in another way, all in one rollout; under each, the cosines between measured and simulated angles
tell the places and signs of all angles.

**Drives that bear the numbers of others**, as in reverse order, move their own angles still, so
that signs and cosines tell nothing. What tells is where the cables are: only in the right order do
eight angles belong to poses of the platform (κ of `agreement`). The frame is symmetric, and eight
orders are alike in that; a free run of the twin under each decides between them, as far as the
start and the load are not symmetric too. A log is refused only if both say the same.

    κ' <= κ/10,    γ' <= γ/3,    ε_k <= 0.2 for every angle
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np

from identification import Log
from identification.logs.units import UNITS
from identification.refusals.readings import Reading
from identification.shares import percent
from inca_mj.refusals import bounds
from inca_mj.refusals.agreement import (
    angles_under,
    assigned,
    follow,
    likely_orders,
    places_of,
    signed,
    some,
    unreached_share,
)
from inca_mj.refusals.angles import alike, apart, is_right, rewired
from inca_mj.robot.geometry import DRIVES
from inca_mj.twin.twin import Twin


def other_currents(
    plant: Twin, part: Log, predicted: np.ndarray, longer: Log | None
) -> tuple[Reading, str] | None:
    """Returns other signs or places of currents under which the twin moves as the log, with words.

    Args:
        plant: the twin.
        part: the first motion, n samples of k angles that all move.
        predicted: the twin's angles under the currents as they are read, shape (n, k) [rad].
        longer: the log a little longer, with all eight angles; None where not all of them move.
    """
    as_read = apart(part, predicted)
    if as_read <= bounds.ASTRAY:
        return None
    for Q in () if longer is None else _followed(plant, longer, predicted):
        found = _nearest(plant, part, as_read, [Q], False)
        if found is not None:
            return found
    return _nearest(plant, part, as_read, [*_single()], True)


def renamed_drives(plant: Twin, part: Log, predicted: np.ndarray) -> tuple[Reading, str] | None:
    """Returns another order of the drives under which the twin moves as the log, with words.

    Of orders that are about as near, it is the one that changes fewest drives. The part is the
    first motion, with all eight angles; the twin's are predicted under its currents, shape (n, 8)
    [rad].
    """
    as_read, y = apart(part, predicted), some(part.outputs)
    share = float(unreached_share(plant, y[None])[0])
    orders = likely_orders(plant, y, bounds.MAX_ORDERS)
    shares = unreached_share(plant, np.moveaxis(y[:, orders], 1, 0))
    first = np.argsort(shares, kind="stable")[: bounds.MAX_SIMULATED]
    close = [k for k in first.tolist() if shares[k] <= bounds.CLOSER * share]
    if not close:
        return None
    places = [np.eye(DRIVES)[orders[k]] for k in close]
    every = angles_under(plant, part, np.stack([part.inputs @ P.T for P in places]))
    found: list[tuple[float, int, int, Reading]] = []
    for k, P, angles in zip(close, places, every, strict=True):
        if not np.isfinite(angles).all():
            continue
        reading = rewired(part, P, P)
        rest = apart(reading.log, angles)
        if rest <= bounds.NEARER_RENAMED * as_read and is_right(reading.log, angles):
            found.append((rest, int(np.sum(orders[k] != np.arange(DRIVES))), k, reading))
    if not found:
        return None
    as_near = [each for each in found if each[0] <= bounds.NEARLY * min(each[0] for each in found)]
    rest, _, k, reading = min(as_near, key=lambda each: (each[1], each[0]))
    moved = [str(m + 1) for m in np.flatnonzero(orders[k] != np.arange(DRIVES))]
    others = f" (so they do in {len(as_near)} orders, since the robot is symmetric)"
    return reading, (
        f"explains {_percent(as_read)} of the motion, and {_percent(rest)} were the drives"
        f" {', '.join(moved)} numbered in another order, in which the angles also fit the cables of"
        f" one platform {share / shares[k]:.0f} times as well"
        f"{others if len(as_near) > 1 else ''}; {reading.cure}"
    )


def likely_units(log: Log, predicted: np.ndarray) -> list[float]:
    """Returns the two factors to radians that bring the angles' motion nearest to the twin's.

    Wrong currents change how far the twin moves, so that the nearest may be a wrong one.
    """
    y = log.outputs[: len(predicted)] - log.outputs[0]
    sizes = np.linalg.norm(y, axis=0) / np.linalg.norm(predicted, axis=0)
    far = np.log(np.median(sizes))  # of one angle in another unit, the others tell
    factors = [factor for si, factor in UNITS.values() if si == "rad"]
    distance = {factor: abs(far + np.log(factor)) for factor in factors}
    return sorted(factors, key=distance.__getitem__)[:2]


def _nearest(
    plant: Twin, part: Log, as_read: float, tried: Sequence[np.ndarray], with_angles: bool
) -> tuple[Reading, str] | None:
    """Returns the places Q of currents under which the twin is nearest, if near enough."""
    found: list[tuple[float, Reading]] = []
    every = angles_under(plant, part, np.stack([part.inputs @ Q.T for Q in tried]))
    for Q, predicted in zip(tried, every, strict=True):
        if not np.isfinite(predicted).all() or not predicted.any(axis=0).all():
            continue
        P = np.eye(part.outputs.shape[1])
        if with_angles:
            likeness = alike(part, predicted).T
            P = signed(likeness, assigned(np.abs(likeness)))
        if np.sum(np.diag(P) != 1) > bounds.MAX_ANGLES:
            continue
        reading = rewired(part, P, Q)
        remaining = apart(reading.log, predicted)
        if remaining < bounds.NEARER * as_read and is_right(reading.log, predicted):
            found.append((remaining, reading))
    if not found:
        return None
    (least, best), *rest = sorted(found, key=lambda each: each[0])
    as_near = [reading.words for remaining, reading in rest if remaining < bounds.NEARLY * least]
    mirror = f" (or, since the robot is symmetric, {' or '.join(as_near)})" if as_near else ""
    text = f"explains {_percent(as_read)} of the motion, and {_percent(least)} {best.words}{mirror}"
    return best, f"{text}; {best.cure}"


def _percent(γ: float) -> str:
    return percent(max(0.0, 1 - γ))


def _followed(plant: Twin, longer: Log, predicted: np.ndarray) -> Iterator[np.ndarray]:
    """Yields the places of currents with which the twin follows the log, in the likeliest units."""
    for factor in likely_units(longer, predicted):
        followed = follow(plant, replace(longer, outputs=factor * longer.outputs))
        if followed is None:
            continue
        Q = places_of(longer, followed[0])
        if not np.array_equal(Q, np.eye(DRIVES)):
            yield Q


def _single() -> Iterator[np.ndarray]:
    """Yields places of currents where one has the other sign, all have, or two are exchanged."""
    right = np.eye(DRIVES)
    for k in range(DRIVES):
        yield right * np.where(np.arange(DRIVES) == k, -1.0, 1.0)
    yield -right
    for i, j in combinations(range(DRIVES), 2):
        yield right[[{i: j, j: i}.get(k, k) for k in range(DRIVES)]]
