"""An effect that a world may hide: how large it may be, where it acts, and which names are right.

Sizes are counted by what the robot does without the effect: F, the largest force of a joint's
drive, V, its top speed, L, how far it goes to either side, and its friction f_c.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

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
        curve: what an unlisted force depends on: the end of the name of the curve that draws it,
            "-" where no curve does; nothing where the effect is listed.
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
