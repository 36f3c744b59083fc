"""The quantity that a force follows: the force is a function of it along a trajectory.

    u(x) = Σ_i (f_(i+1) - f_(i))² / 2 Σ f²        f_(i): the forces in the order of x

u is 0 where f is a smooth function of x, and 1 where it is none (von Neumann 1941). The first of
these with u below `EXPLAINED_TOLERANCE` is taken: the time, where the force knows it; the joint's
rate; the angle within one period of a law that repeats; its position; the force of its own drives.
A friction may also be a function of one of them when it is counted against the motion. Where none
is enough, it is the one with the least u, if this is below `FAIR_TOLERANCE`: where a joint turns, a
friction is any force below its level. Else, as where a law is a product of two of them, it is what
the law multiplies by its size; but where this is mostly zero or at an end, as of a friction that
holds or slips, a figure over it shows nothing, and the rate is taken where the friction slips.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import mujoco
import numpy as np

from identification.discovery.forces.force_along import ForceAlong
from identification.effects.effect import Candidate

EXPLAINED_TOLERANCE = 0.01  # of a force: what may be left of it by the quantity that it follows
FAIR_TOLERANCE = 0.1  # the same where no quantity is enough, and the best one is taken
LAW_POINTS_SHARE = 0.8  # of the points: where a joint is held, no law of friction shows
NEAR_END = 0.02  # of the range of what a law multiplies
HELD_SPEED_SHARE = 2e-3  # of the top speed: below it a friction may hold the joint
SLIDE = int(mujoco.mjtJoint.mjJNT_SLIDE)


@dataclass(frozen=True, kw_only=True)
class Regressor:
    """A quantity that a force follows."""

    along: str  # "rate", "position", "phase", "time", "drive", "law" or "reading"
    # at the points of a trajectory, for each of n degrees of freedom, shape (M, n)
    values: np.ndarray
    # where the force follows it: a joint that is held, or turns, shows no law; shape (M, n)
    moving: np.ndarray
    # 1, or the sign against the motion where the force is a friction, shape (M, n)
    turn: np.ndarray
    unit: str  # of the values
    force_unit: str  # of the force

    @property
    def resists(self) -> bool:
        """Tells whether the force is shown as a resistance, in both directions of motion."""
        return bool((self.turn < 0).any())

    def samples(self, force: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Returns the followed values, and a force (M, n) as it is shown, where the joints move."""
        return self.values[self.moving], (self.turn * force)[self.moving]


def find_regressor(
    candidate: Candidate, values: Mapping[str, float], along: ForceAlong
) -> Regressor:
    """Returns the quantity that the force of an effect follows.

    Args:
        candidate: the effect.
        values: of the plant's parameters by name.
        along: its force along a trajectory, the first of them.
    """
    q, v, force = along.position, along.rate, along.forces[0]
    x, f = ("m", "N") if along.kind == SLIDE else ("rad", "N m")
    plain, against = np.ones_like(v), -np.where(v < 0, -1.0, 1.0)
    moving = (np.abs(v) > HELD_SPEED_SHARE * np.abs(v).max()) & ~along.turning

    def follows(what: str, of: np.ndarray, turn: np.ndarray, unit: str) -> Regressor:
        return Regressor(
            along=what, values=of, moving=moving, turn=turn, unit=unit, force_unit=f
        )  # fmt: skip

    options = [
        follows("time", along.time, turn, "s")
        for turn in (plain, against)
        if along.is_timed and _is_of_time(along, turn)
    ]
    rate = follows("rate", v, plain, f"{x}/s")
    options.append(rate)
    if (n := _waves(candidate, values)) is not None:
        options.append(follows("phase", np.mod(n * q, 2 * np.pi), plain, "rad"))
    for turn in (plain, against):
        options += [follows("position", q, turn, x), follows("drive", along.drives, turn, f)]
    for option in options:
        if unexplained(option, force) < EXPLAINED_TOLERANCE:
            return option
    best = min(options, key=lambda option: unexplained(option, force))
    size = _single(candidate, values)
    if size and unexplained(best, force) > FAIR_TOLERANCE:
        law = follows("law", force / size, plain, "")
        ends = np.array([law.values.min(initial=0.0), 0.0, law.values.max(initial=0.0)])
        near = np.abs(law.values[..., None] - ends) <= NEAR_END * np.ptp(ends)
        if np.mean(near.any(axis=-1)) > LAW_POINTS_SHARE:
            slips = replace(rate, moving=moving & near[..., [0, 2]].any(axis=-1) & ~near[..., 1])
            return slips if unexplained(slips, force) < FAIR_TOLERANCE else law
        return law
    return best


def find_reading(
    own: np.ndarray, rate: np.ndarray, time: np.ndarray, error: np.ndarray, unit: str
) -> Regressor:
    """Returns what a sensor's error follows: its reading, the time or, else, the reading's rate.

    Args:
        own: readings of n outputs without the error, shape (N, n) [unit].
        rate: of these, shape (N, n) [unit/s].
        time: of the samples, shape (N,) [s].
        error: of the readings, shape (N, n) [unit].
        unit: of the readings.
    """
    plain = np.ones_like(own)
    times = time[:, None] * plain
    options = [
        Regressor(
            along=along, values=values, moving=plain > 0, turn=plain, unit=x, force_unit=unit
        )
        for along, values, x in (
            ("reading", own, unit), ("rate", rate, f"{unit}/s"), ("time", times, "s")
        )
    ]  # fmt: skip
    return min(options, key=lambda option: unexplained(option, error) > EXPLAINED_TOLERANCE)


def unexplained(regressor: Regressor, force: np.ndarray) -> float:
    """Returns u, the share of a force (M, n) that is no smooth function of what it may follow."""
    x, f = regressor.samples(force)
    jumps = np.diff(f[np.argsort(x, kind="stable")])
    return float(np.sum(jumps**2) / (2 * max(np.sum(f**2), 1e-300)))


def _is_of_time(along: ForceAlong, turn: np.ndarray) -> bool:
    """Returns whether a force, turned, is the same at all states that a joint has at one time."""
    time, f = along.time.ravel(), (turn * along.forces[0]).ravel()
    order = np.argsort(time, kind="stable")
    expected = np.interp(along.late_time.ravel(), time[order], f[order])
    off = (turn * along.late).ravel() - expected
    near = float(np.quantile(np.abs(off), LAW_POINTS_SHARE))
    return near < EXPLAINED_TOLERANCE * float(np.abs(f).max())


def _waves(candidate: Candidate, values: Mapping[str, float]) -> float | None:
    """Returns 2π times the periods per radian or metre of a cos nq + b sin nq; None otherwise."""
    effect = candidate.effect
    if [s.name for s in effect.sizes] != ["a", "b"] or [s.name for s in effect.shapes] != ["n"]:
        return None
    return values[effect.parameter("n", candidate.where)]


def _single(candidate: Candidate, values: Mapping[str, float]) -> float:
    """Returns the size of an effect that has only one; 0 for any other effect."""
    return values[candidate.sizes[0]] if len(candidate.sizes) == 1 else 0.0
