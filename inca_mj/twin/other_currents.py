"""Other signs and places of a log's currents: does the twin move as the log only under these?

    γ = 1 - Σ_k ⟨y_k, ŷ_k⟩ / √(Σ_k ‖y_k‖² Σ_k ‖ŷ_k‖²)         over all angles together

One current moves all angles, so that all of them judge it together: an angle that hardly moves may
be anywhere in a right log, and then another current may bring it nearer by chance. Another reading
must leave a tenth of γ, and every angle as near to the twin as that of a right log. In 58 robots as
built (worlds 31000 to 31057, 4 s of PRBS or multisine) γ was 0.040 at most, and no other reading
left less than 0.63 of it. Of 210 right logs of worlds 32000 to 32289, none was refused.

Readings are proposed in two ways. Where the angles are right, feedback tells the places and signs
of all currents at once (`inca_mj.twin.agreement`). Where an angle is wrong too, as in a drive
whose angle and current are turned or exchanged together, each current alone and each pair is read
in another way, all in one rollout; under each, the cosines between measured and simulated angles
tell the places and signs of all angles.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np

from identification import Log
from identification.logs.readings import Reading
from identification.logs.units import UNITS
from inca_mj.robot.geometry import DRIVES
from inca_mj.twin.agreement import angles_under, assigned, follow, places_of
from inca_mj.twin.bounds import BOUNDS
from inca_mj.twin.other_wiring import alike
from inca_mj.twin.rewired import Places, rewired
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
    own = apart(part, predicted)
    if own <= BOUNDS.astray:
        return None
    for Q in () if longer is None else _followed(plant, longer, predicted):
        found = _nearest(plant, part, own, [Q], False)
        if found is not None:
            return found
    return _nearest(plant, part, own, [*_single()], True)


def _nearest(
    plant: Twin, part: Log, own: float, tried: Sequence[np.ndarray], with_angles: bool
) -> tuple[Reading, str] | None:
    """Returns the places of currents under which the twin is nearest to a log, if near enough.

    Args:
        plant: the twin.
        part: the first motion, n samples of k angles.
        own: γ as it is read.
        tried: places of currents, shape (8, 8) each.
        with_angles: whether angles may have other places and signs too.
    """
    found: list[tuple[float, Reading]] = []
    every = angles_under(plant, part, np.stack([part.inputs @ Q.T for Q in tried]))
    for Q, predicted in zip(tried, every, strict=True):
        if not np.isfinite(predicted).all() or not predicted.any(axis=0).all():
            continue
        P = _places_of_angles(part, predicted) if with_angles else np.eye(part.outputs.shape[1])
        if np.sum(np.diag(P) != 1) > BOUNDS.max_angles:
            continue
        reading = rewired(part, Places(P, Q))
        left = apart(reading.log, predicted)
        if left < BOUNDS.nearer * own and is_right(reading.log, predicted):
            found.append((left, reading))
    if not found:
        return None
    (least, best), *rest = sorted(found, key=lambda each: each[0])
    before, after = (100 * max(0.0, 1 - γ) for γ in (own, least))
    as_near = [reading.said for left, reading in rest if left < BOUNDS.nearly * least]
    mirror = f" (or, since the robot is symmetric, {' or '.join(as_near)})" if as_near else ""
    said = f"explains {before:.0f} % of the motion, and {after:.0f} % {best.said}{mirror}"
    return best, f"{said}; {best.cure}"


def _followed(plant: Twin, longer: Log, predicted: np.ndarray) -> Iterator[np.ndarray]:
    """Yields the places of currents with which the twin follows the log, in the likeliest units."""
    for factor in likely_units(longer, predicted):
        scaled = replace(longer, outputs=factor * longer.outputs)
        followed = follow(plant, scaled)
        if followed is None:
            continue
        Q = places_of(longer, followed[0])
        if not np.array_equal(Q, np.eye(DRIVES)):
            yield Q


def likely_units(log: Log, predicted: np.ndarray) -> list[float]:
    """Returns the two factors to radians that bring the angles' motion nearest to the twin's.

    Wrong currents change how far the twin moves, so that the nearest may be a wrong one.

    Args:
        log: with all eight angles.
        predicted: of the twin, shape (n, 8) [rad].
    """
    y = log.outputs[: len(predicted)] - log.outputs[0]
    sizes = np.linalg.norm(y, axis=0) / np.linalg.norm(predicted, axis=0)
    far = np.log(np.median(sizes))  # of one angle in another unit, the others tell
    factors = [factor for si, factor in UNITS.values() if si == "rad"]
    off = {factor: abs(far + np.log(factor)) for factor in factors}
    return sorted(factors, key=off.__getitem__)[:2]


def _single() -> Iterator[np.ndarray]:
    """Yields places of currents where one has the other sign, all have, or two are exchanged."""
    right = np.eye(DRIVES)
    for k in range(DRIVES):
        yield right * np.where(np.arange(DRIVES) == k, -1.0, 1.0)
    yield -right
    for i, j in combinations(range(DRIVES), 2):
        yield right[[{i: j, j: i}.get(k, k) for k in range(DRIVES)]]


def _places_of_angles(part: Log, predicted: np.ndarray) -> np.ndarray:
    """Returns P that brings the angles nearest to the twin's, by the cosines between them."""
    cosine = alike(predicted, part.outputs - part.outputs[0])
    k, m = np.arange(len(cosine)), assigned(np.abs(cosine))
    P = np.zeros_like(cosine)
    P[k, m] = np.where(cosine[k, m] < 0, -1.0, 1.0)
    return P


def is_right(part: Log, predicted: np.ndarray) -> bool:
    """Returns whether every angle is as near to the twin's as one of a right log."""
    return bool(
        (1 - np.diag(alike(part.outputs - part.outputs[0], predicted)) <= BOUNDS.right).all()
    )


def apart(part: Log, predicted: np.ndarray) -> float:
    """Returns γ of the angles of a log and the twin's from its first sample on, shape (n, k) [rad].

    An angle that moves far more than the others is in another unit; it counts as the others do.
    """
    y = part.outputs - part.outputs[0]
    own, simulated = np.linalg.norm(y, axis=0), np.linalg.norm(predicted, axis=0)
    ratio = own / np.maximum(simulated, np.finfo(float).tiny)
    usual = np.median(ratio)
    y = y * np.where(
        ratio > BOUNDS.far * usual, usual / np.maximum(ratio, np.finfo(float).tiny), 1.0
    )
    sizes = np.linalg.norm(y) * np.linalg.norm(simulated)
    return float(1 - np.sum(y * predicted) / sizes) if sizes > 0 else np.inf
