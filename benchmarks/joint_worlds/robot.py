"""What is known of a robot: its numbers, its sensors, its habits, and what of it is free."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from joint_worlds import slots as at
from joint_worlds.slots import plain_joints

SPREAD = 0.10  # the truth is within so much of what is known
KNOWN = 0.2  # what is said to be known of a free parameter
PRESLIDING = 0.1  # a joint that friction holds moves by so much of the sensor's noise


@dataclass(frozen=True)
class Free:
    """A parameter that is not known exactly."""

    name: str  # as the robot's TOML calls it: a path into the model, or a size of an effect
    kind: str  # "mass", "armature", "spring", "damping" or "coulomb"
    # where it stands among the robot's numbers; None for a number of a joint
    number: int | None = None
    slot: tuple[int, int] | None = None  # joint and column among the numbers of the joints


@dataclass(frozen=True, kw_only=True)
class JointRobot:
    """A robot as its nominal model says, in SI units; tuples have an entry per joint."""

    name: str  # of the robot
    code: int  # by which the compiled dynamics know it
    # names in the MJCF
    joints: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    kind: str  # "hinge" or "slide"
    numbers: tuple[float, ...]  # of its dynamics, in the order of its module
    payload: tuple[int, ...]  # index of the payload among them
    # indices of mass and inertia of the body whose mass may differ; `end` is its name
    link: tuple[int, ...]
    end: str
    tip: tuple[int, ...]  # indices of the place of a payload
    damping: tuple[float, ...]  # viscous [N m s/rad or N s/m]
    coulomb: tuple[float, ...]  # Coulomb friction [N m or N]
    heavy: tuple[bool, ...]  # whether gravity acts on the joint
    travel: tuple[float, ...]  # how far a reference goes to either side of zero [rad or m]
    speed: tuple[float, ...]  # top speed of a reference [rad/s or m/s]
    bandwidth: float  # of its controller [rad/s]
    white: tuple[float, ...]  # std of the white noise of its sensors [rad or m]
    sampling_time: float  # of its log and its controller [s]
    substeps: int  # of the integrator in a sample
    horizon: float  # over which its predictions are judged [s]
    free: tuple[Free, ...]  # free parameters beside damping and Coulomb friction
    mjcf: Callable[[np.ndarray, np.ndarray], str]  # writes its model from numbers and damping
    # encoder counts in a turn; or `step`: the sensor's step [rad or m]
    counts: tuple[int, ...] = ()
    step: tuple[float, ...] = field(default=())

    @property
    def n(self) -> int:
        """How many joints it has."""
        return len(self.joints)

    @property
    def steps(self) -> np.ndarray:
        """Steps of its sensors [rad or m], shape (n,)."""
        return np.array(self.step or [2 * np.pi / c for c in self.counts])

    @property
    def noise(self) -> np.ndarray:
        """Std of its sensors' errors: rounding and white noise [rad or m], shape (n,)."""
        return np.sqrt(self.steps**2 / 12 + np.square(self.white))

    @cached_property
    def all_free(self) -> tuple[Free, ...]:
        """Every parameter that is not known exactly."""
        joints = [
            free
            for j, name in enumerate(self.joints)
            for free in (
                Free(f"joint/{name}.damping", "damping", slot=(j, at.VISCOUS)),
                Free(f"coulomb_friction.f_c@{name}", "coulomb", slot=(j, at.COULOMB)),
            )
        ]
        return (*self.free, *joints)

    def plain(self) -> tuple[np.ndarray, np.ndarray]:
        """Numbers of the dynamics and of the joints, of the nominal robot."""
        p, joints = np.array(self.numbers), plain_joints(self.n)
        joints[:, at.VISCOUS] = self.damping
        joints[:, at.COULOMB] = self.coulomb
        return p, joints
