"""What a world may hide: one effect, its size, and the names under which it is right.

Sizes are counted by what the robot does without the effect: F, the largest force of a joint's
drive, V, its top speed, L, how far it goes to either side, and its friction f_c.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from joint_worlds import slots as at
from joint_worlds.robot import JointRobot


@dataclass(frozen=True)
class Habits:
    """What a joint does without the effect, and its friction, in SI units.

    Attributes:
        force: largest force of its drive; it is below `often` in 98 % of the samples.
        speed: top speed.
        travel: how far it goes to either side.
        coulomb: Coulomb friction.
        damping: viscous friction.
    """

    force: float
    speed: float
    travel: float
    coulomb: float
    damping: float
    often: float


Rng = np.random.Generator
Largest = Callable[[Habits], float]
Put = Callable[[np.ndarray, float, "Shape"], None]
Shape = dict[str, float]


@dataclass(frozen=True, kw_only=True)
class Hidden:
    """An effect that a world may hide.

    Attributes:
        name: the project's name of it.
        largest: size that is never exceeded.
        put: writes size and shape into the numbers of a joint, shape (SLOTS,).
        shape: draws what the size does not say.
        kinds: of joints on which it acts.
        heavy: whether gravity must act on the joint; None where that does not matter.
        known: kinds of parameters that are known exactly in its worlds, because they would pass
            for it.
        body: "payload" or "link" where it changes a mass and not a joint.
        everywhere: whether it acts on all joints alike.
        coupled: whether it needs a robot of several joints.
        also: names that mean the same on a robot of one joint.
    """

    name: str
    largest: Largest
    put: Put = lambda joint, size, shape: None
    shape: Callable[[Habits, Rng], Shape] = lambda habits, rng: {}
    kinds: tuple[str, ...] = ("hinge", "slide")
    heavy: bool | None = None
    known: tuple[str, ...] = ()
    body: str = ""
    everywhere: bool = False
    coupled: bool = False
    also: tuple[str, ...] = ()

    def joints(self, robot: JointRobot) -> list[int]:
        """Where it may act."""
        if robot.kind not in self.kinds or (self.coupled and robot.n == 1):
            return []
        if self.body:
            return [robot.n - 1]
        return [j for j in range(robot.n) if self.heavy is None or robot.heavy[j] == self.heavy]

    def places(self, robot: JointRobot, j: int) -> tuple[str, ...]:
        """Words for where it acts: joint, input and output; a body; nothing where it is clear."""
        if self.everywhere or self.body == "payload":
            return ()
        return (robot.end,) if self.body else (robot.joints[j], robot.inputs[j], robot.outputs[j])

    def names(self, robot: JointRobot) -> tuple[str, ...]:
        """Names that are right."""
        same = ("mass_mismatch",) if self.body and robot.kind == "slide" else ()
        return (self.name, *(self.also if robot.n == 1 else ()), *same)


def _set(*columns: int, **named: int) -> Put:
    """Writes the size into some columns, and the shape into others."""

    def put(joint: np.ndarray, size: float, shape: Shape) -> None:
        joint[list(columns)] = size
        for word, column in named.items():
            joint[column] = shape[word]

    return put


def _wave(cos: int, sin: int, waves: int) -> Put:
    def put(joint: np.ndarray, size: float, shape: Shape) -> None:
        joint[cos], joint[sin] = size * np.cos(shape["phase"]), size * np.sin(shape["phase"])
        if waves >= 0:
            joint[waves] = shape["n"]

    return put


def _limit(joint: np.ndarray, size: float, shape: Shape) -> None:
    """A limit between the largest input (size 0), one often reached (1), and less."""
    if size:
        joint[at.LIMIT] = shape["full"] * (shape["often"] / shape["full"]) ** size


def _signed(put: Put) -> Put:
    """With the sign that was drawn."""
    return lambda joint, size, shape: put(joint, shape["sign"] * size, shape)


def _sign(habits: Habits, rng: Rng) -> Shape:
    return {"sign": float(rng.choice([-1.0, 1.0]))}


def _peak(habits: Habits, rng: Rng) -> Shape:
    return {"v_s": habits.speed * float(np.exp(rng.uniform(np.log(0.03), np.log(0.2)))),
            "p": float(rng.uniform(1.0, 2.0))}  # fmt: skip


def _hinge_wave(habits: Habits, rng: Rng) -> Shape:
    """Whole periods of a turn, two of which at least lie in the travel."""
    least = int(np.ceil(2 * np.pi / habits.travel))
    return {"n": float(rng.integers(max(3, least), 13)), "phase": float(rng.uniform(0, 2 * np.pi))}


def _slide_wave(habits: Habits, rng: Rng) -> Shape:
    n = np.pi / habits.travel * rng.uniform(3.0, 12.0)  # periods in the travel
    return {"n": float(n), "phase": float(rng.uniform(0, 2 * np.pi))}


def _wave_of(habits: Habits, rng: Rng) -> Shape:
    return (_hinge_wave if habits.travel > 0.4 else _slide_wave)(habits, rng)


COG = _wave(at.COG_COS, at.COG_SIN, at.COG_WAVES)
GRIP = _wave(at.GRIP_COS, at.GRIP_SIN, at.GRIP_WAVES)
OFF = _wave(at.OFF_COS, at.OFF_SIN, -1)

HIDDEN: dict[str, Hidden] = {h.name: h for h in (
    Hidden(name="coulomb_friction", largest=lambda h: 0.3 * h.force, put=_set(at.COULOMB),
           known=("coulomb",)),
    Hidden(name="asymmetric_friction", largest=lambda h: 0.8 * h.coulomb,
           put=_signed(_set(at.UNEVEN)), shape=_sign),
    Hidden(name="asymmetric_viscous_friction", largest=lambda h: 0.8 * h.damping,
           put=_signed(_set(at.UNEVEN_VISCOUS)), shape=_sign),
    Hidden(name="stribeck_friction", largest=lambda h: 0.2 * h.force,
           put=_set(at.PEAK, v_s=at.PEAK_SPEED, p=at.PEAK_POWER), shape=_peak),
    Hidden(name="transmitted_load_friction", largest=lambda h: 0.2, put=_set(at.LOAD), heavy=True),
    Hidden(name="load_dependent_friction", largest=lambda h: 0.2, put=_set(at.LOAD), heavy=False,
           also=("transmitted_load_friction",)),
    Hidden(name="quadratic_friction", largest=lambda h: 0.3 * h.force / h.speed**2,
           put=_set(at.SQUARE)),
    Hidden(name="sublinear_friction", largest=lambda h: 0.3 * h.force / h.speed**0.5,
           put=_set(at.ROOT, p=at.ROOT_POWER),
           shape=lambda h, rng: {"p": float(rng.uniform(0.3, 0.7))}),
    Hidden(name="hardening", largest=lambda h: 0.3 * h.force / h.travel**3, put=_set(at.CUBE)),
    Hidden(name="offset", largest=lambda h: 0.2 * h.force, put=_signed(_set(at.PUSH)),
           shape=_sign),
    Hidden(name="cogging", largest=lambda h: 0.2 * h.force, put=COG, shape=_wave_of),
    Hidden(name="periodic_friction", largest=lambda h: 0.8 * h.coulomb, put=GRIP, shape=_wave_of),
    Hidden(name="delay", largest=lambda h: 0.02, put=_set(at.DELAY), also=("time_shift",)),
    Hidden(name="lag", largest=lambda h: 0.01, put=_set(at.LAG)),
    Hidden(name="saturation", largest=lambda h: 1.5, put=_limit,
           shape=lambda h, rng: {"full": h.force, "often": h.often}),
    Hidden(name="gain_drift", largest=lambda h: 0.01, put=_set(at.SAG)),
    Hidden(name="presliding", largest=lambda h: 0.02 * h.travel / h.coulomb, put=_set(at.GIVE)),
    Hidden(name="payload", largest=lambda h: 0.5, body="payload", known=("mass",)),
    Hidden(name="mass_mismatch", largest=lambda h: 0.5, body="link", known=("mass",),
           kinds=("hinge",)),
    Hidden(name="time_shift", largest=lambda h: 0.02, put=_set(at.SHIFT), everywhere=True,
           also=("delay",)),
    Hidden(name="encoder_lag", largest=lambda h: 0.02, put=_set(at.SHIFT), coupled=True),
    Hidden(name="encoder_offset", largest=lambda h: 0.1, put=_signed(_set(at.ZERO)), shape=_sign,
           heavy=True),
    Hidden(name="torque_saturation", largest=lambda h: 0.3 / h.force**2, put=_set(at.WEAK)),
    Hidden(name="encoder_scale", largest=lambda h: 0.05, put=_signed(_set(at.SCALE)), shape=_sign),
    Hidden(name="encoder_eccentricity", largest=lambda h: 0.03, put=OFF, shape=_wave_of,
           kinds=("hinge",)),
)}  # fmt: skip
NULL = "nothing"


def effects_of(robot: JointRobot) -> tuple[str, ...]:
    """Names of what a world of a robot may hide, in the order of `HIDDEN`."""
    return tuple(name for name, hidden in HIDDEN.items() if hidden.joints(robot))
