"""The effects that a world may hide: how large, where, which names are right, how they are drawn.

Listed ones have a name, others are forces in no catalogue. Sizes are counted by what the robot does
without the effect: F, the largest force of a joint's drive, V, its top speed, L, how far it goes to
either side, and its friction f_c.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from joint_worlds import slots as at
from joint_worlds.robot import JointRobot


@dataclass(frozen=True)
class Habits:
    """What a joint does without the effect, and its friction, in SI units."""

    force: float  # largest force of its drive; it is below `often` in 98 % of the samples
    speed: float  # top speed
    travel: float  # how far it goes to either side
    coulomb: float  # Coulomb friction
    damping: float  # viscous friction
    often: float


Rng = np.random.Generator
Largest = Callable[[Habits], float]
Put = Callable[[np.ndarray, float, "Shape"], None]
Shape = dict[str, float]


@dataclass(frozen=True, kw_only=True)
class Hidden:
    """An effect that a world may hide."""

    name: str  # the project's name of it
    largest: Largest  # size that is never exceeded
    # writes size and shape into the numbers of a joint, shape (SLOTS,)
    put: Put = lambda joint, size, shape: None
    # draws what the size does not say
    shape: Callable[[Habits, Rng], Shape] = lambda habits, rng: {}
    kinds: tuple[str, ...] = ("hinge", "slide")  # of joints on which it acts
    # whether gravity must act on the joint; None where that does not matter
    heavy: bool | None = None
    # kinds of parameters that are known exactly in its worlds, because they would pass for it
    known: tuple[str, ...] = ()
    body: str = ""  # "payload" or "link" where it changes a mass and not a joint
    everywhere: bool = False  # whether it acts on all joints alike
    coupled: bool = False  # whether it needs a robot of several joints
    also: tuple[str, ...] = ()  # names that mean the same on a robot of one joint
    # what an unlisted force depends on: the end of the name of the curve that draws it, "-" where
    # no curve does; nothing where the effect is listed
    curve: str = ""

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
        """Names that are right; none where the force is in no catalogue."""
        if self.curve:
            return ()
        same = ("mass_mismatch",) if self.body and robot.kind == "slide" else ()
        return (self.name, *(self.also if robot.n == 1 else ()), *same)

    def drawn_as(self, j: int) -> str:
        """The curve that draws a force on joint j that is in no catalogue; "" where none does."""
        what = self.curve.replace("beside", "before" if j else "behind").replace(" ", "_")
        return f"curve_{what}" if what.strip("-") else ""


def put_into(*columns: int, **named: int) -> Put:
    """Writes the size into some columns, and the shape into others."""

    def put(joint: np.ndarray, size: float, shape: Shape) -> None:
        joint[list(columns)] = size
        for word, column in named.items():
            joint[column] = shape[word]

    return put


def wave(cos: int, sin: int, waves: int) -> Put:
    """Writes cosine and sine of the drawn phase, and how many waves where that has a column."""

    def put(joint: np.ndarray, size: float, shape: Shape) -> None:
        joint[cos], joint[sin] = size * np.cos(shape["phase"]), size * np.sin(shape["phase"])
        if waves >= 0:
            joint[waves] = shape["n"]

    return put


def limit(joint: np.ndarray, size: float, shape: Shape) -> None:
    """A limit between the largest input (size 0), one often reached (1), and less."""
    if size:
        joint[at.LIMIT] = shape["full"] * (shape["often"] / shape["full"]) ** size


def signed(put: Put) -> Put:
    """With the sign that was drawn."""
    return lambda joint, size, shape: put(joint, shape["sign"] * size, shape)


def sign(habits: Habits, rng: Rng) -> Shape:
    """Either sign."""
    return {"sign": float(rng.choice([-1.0, 1.0]))}


def peak(habits: Habits, rng: Rng) -> Shape:
    """Speed [rad/s or m/s] and power of a Stribeck peak."""
    return {"v_s": habits.speed * float(np.exp(rng.uniform(np.log(0.03), np.log(0.2)))),
            "p": float(rng.uniform(1.0, 2.0))}  # fmt: skip


def hinge_wave(habits: Habits, rng: Rng) -> Shape:
    """Whole periods of a turn, two of which at least lie in the travel."""
    least = int(np.ceil(2 * np.pi / habits.travel))
    return {"n": float(rng.integers(max(3, least), 13)), "phase": float(rng.uniform(0, 2 * np.pi))}


def slide_wave(habits: Habits, rng: Rng) -> Shape:
    n = np.pi / habits.travel * rng.uniform(3.0, 12.0)  # periods in the travel
    return {"n": float(n), "phase": float(rng.uniform(0, 2 * np.pi))}


def wave_of(habits: Habits, rng: Rng) -> Shape:
    return (hinge_wave if habits.travel > 0.4 else slide_wave)(habits, rng)


def bump(habits: Habits, rng: Rng) -> Shape:
    """Place and width of a bump within the travel [rad or m]."""
    return {**sign(habits, rng), "place": float(habits.travel * rng.uniform(-0.5, 0.5)),
            "width": float(habits.travel * rng.uniform(0.15, 0.4))}  # fmt: skip


def stop(habits: Habits, rng: Rng) -> Shape:
    """Where a soft stop begins, from the middle [rad or m]."""
    return {"place": float(habits.travel * rng.uniform(0.4, 0.7))}


def fast(habits: Habits, rng: Rng) -> Shape:
    """The speed from which a brake acts [rad/s or m/s]."""
    return {"speed": float(habits.speed * rng.uniform(0.2, 0.5))}


def beside(habits: Habits, rng: Rng) -> Shape:
    """One to three radians of the sine in a radian of the neighbour: no more than two periods."""
    return {"waves": float(rng.uniform(1.0, 3.0)), "phase": float(rng.uniform(0, 2 * np.pi))}


def ripple(habits: Habits, rng: Rng) -> Shape:
    """One to three periods in the whole travel [1/rad or 1/m]."""
    return {"waves": float(np.pi / habits.travel * rng.uniform(1.0, 3.0))}


COG = wave(at.COG_COS, at.COG_SIN, at.COG_WAVES)
GRIP = wave(at.GRIP_COS, at.GRIP_SIN, at.GRIP_WAVES)
OFF = wave(at.OFF_COS, at.OFF_SIN, -1)

HIDDEN: dict[str, Hidden] = {h.name: h for h in (
    Hidden(name="coulomb_friction", largest=lambda h: 0.3 * h.force, put=put_into(at.COULOMB),
           known=("coulomb",)),
    Hidden(name="asymmetric_friction", largest=lambda h: 0.8 * h.coulomb,
           put=signed(put_into(at.UNEVEN)), shape=sign),
    Hidden(name="asymmetric_viscous_friction", largest=lambda h: 0.8 * h.damping,
           put=signed(put_into(at.UNEVEN_VISCOUS)), shape=sign),
    Hidden(name="stribeck_friction", largest=lambda h: 0.2 * h.force,
           put=put_into(at.PEAK, v_s=at.PEAK_SPEED, p=at.PEAK_POWER), shape=peak),
    Hidden(name="transmitted_load_friction", largest=lambda h: 0.2, put=put_into(at.LOAD),
           heavy=True),
    Hidden(name="load_dependent_friction", largest=lambda h: 0.2, put=put_into(at.LOAD),
           heavy=False,
           also=("transmitted_load_friction",)),
    Hidden(name="quadratic_friction", largest=lambda h: 0.3 * h.force / h.speed**2,
           put=put_into(at.SQUARE)),
    Hidden(name="sublinear_friction", largest=lambda h: 0.3 * h.force / h.speed**0.5,
           put=put_into(at.ROOT, p=at.ROOT_POWER),
           shape=lambda h, rng: {"p": float(rng.uniform(0.3, 0.7))}),
    Hidden(name="hardening", largest=lambda h: 0.3 * h.force / h.travel**3, put=put_into(at.CUBE)),
    # On one joint a free mass does the same.
    Hidden(name="gravity_force", largest=lambda h: 1.0, put=put_into(at.FLOAT), heavy=True,
           coupled=True),
    Hidden(name="offset", largest=lambda h: 0.2 * h.force, put=signed(put_into(at.PUSH)),
           shape=sign),
    Hidden(name="cogging", largest=lambda h: 0.2 * h.force, put=COG, shape=wave_of),
    Hidden(name="periodic_friction", largest=lambda h: 0.8 * h.coulomb, put=GRIP,
           shape=wave_of),
    Hidden(name="delay", largest=lambda h: 0.02, put=put_into(at.DELAY), also=("time_shift",)),
    Hidden(name="lag", largest=lambda h: 0.01, put=put_into(at.LAG)),
    Hidden(name="saturation", largest=lambda h: 1.5, put=limit,
           shape=lambda h, rng: {"full": h.force, "often": h.often}),
    Hidden(name="gain_drift", largest=lambda h: 0.01, put=put_into(at.SAG)),
    Hidden(name="presliding", largest=lambda h: 0.02 * h.travel / h.coulomb, put=put_into(at.GIVE)),
    Hidden(name="payload", largest=lambda h: 0.5, body="payload", known=("mass",)),
    Hidden(name="mass_mismatch", largest=lambda h: 0.5, body="link", known=("mass",),
           kinds=("hinge",)),
    Hidden(name="time_shift", largest=lambda h: 0.02, put=put_into(at.SHIFT), everywhere=True,
           also=("delay",)),
    Hidden(name="encoder_lag", largest=lambda h: 0.02, put=put_into(at.SHIFT), coupled=True),
    Hidden(name="encoder_offset", largest=lambda h: 0.1, put=signed(put_into(at.ZERO)),
           shape=sign,
           heavy=True),
    Hidden(name="torque_saturation", largest=lambda h: 0.3 / h.force**2, put=put_into(at.WEAK)),
    Hidden(name="encoder_scale", largest=lambda h: 0.05, put=signed(put_into(at.SCALE)),
           shape=sign),
    Hidden(name="encoder_eccentricity", largest=lambda h: 0.03, put=OFF, shape=wave_of,
           kinds=("hinge",)),
)}  # fmt: skip
UNLISTED: dict[str, Hidden] = {h.name: h for h in (
    Hidden(name="bump", largest=lambda h: 0.5 * h.force, curve="position",
           put=signed(put_into(at.BUMP, place=at.BUMP_PLACE, width=at.BUMP_WIDTH)),
           shape=bump),
    Hidden(name="stop", largest=lambda h: 3.0 * h.force / h.travel, curve="position",
           put=put_into(at.STOP, place=at.STOP_PLACE), shape=stop),
    Hidden(name="fast", largest=lambda h: 3.0 * h.force / h.speed, curve="speed",
           put=put_into(at.FAST, speed=at.FAST_SPEED), shape=fast),
    Hidden(name="beside", largest=lambda h: 0.5 * h.force, coupled=True, curve="beside",
           put=put_into(at.BESIDE, waves=at.BESIDE_WAVES, phase=at.BESIDE_PHASE),
           shape=beside),
    Hidden(name="drag", largest=lambda h: 0.5 * h.force / h.speed, coupled=True,
           curve="speed beside", put=signed(put_into(at.DRAG)), shape=sign),
    Hidden(name="ripple", largest=lambda h: 0.5 * h.force / h.speed, curve="-",
           put=put_into(at.RIPPLE, waves=at.RIPPLE_WAVES), shape=ripple),
)}  # fmt: skip
EVERY = {**HIDDEN, **UNLISTED}
NULL = "nothing"
THREE = "three"  # effects of the catalogue at once, each somewhere


def effects_of(robot: JointRobot) -> tuple[str, ...]:
    """Names of what a world of a robot may hide, in the order of `EVERY`."""
    return tuple(name for name, hidden in EVERY.items() if hidden.joints(robot))
