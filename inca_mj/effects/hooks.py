"""The hooks of this robot's effects: what they act on, what they see, where they add to its law.

    i + Δi      current                    L + ΔL     path of the cable, with ∂ΔL/∂r
    R + ΔR      roller radius              T + ΔT     tension
    τ + Δτ      torque on the motor        F          force of a cable on its connector
    ẋ           rate of a state of its own            wrench on the platform

An effect is an `Effect` whose `hooks` name some of these. A hook's function is compiled by njit and
takes a `Drive` (or a `Platform`) and the tuple of the effect's parameters, sizes first; it returns
what is added. Everything added is zero when the sizes are.

The parameters of drives and cables stand in the rows of `actuator_user`, behind the law's own
columns; those of the platform in its row of `body_user`; those of inputs and sensors nowhere: they
act before the model and behind it. States of effects follow d₀ in a drive's activations. One column
holds the key of the set, so that a model is never advanced by the law of another.
"""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from identification.effects.effect import Effect
from identification.effects.sizes import Shape, Size
from identification.effects.values import key_of, refuse_misplaced, terms_of
from identification.native.element import Element, Hook, Term
from identification.native.input_filter import INPUT
from identification.native.reading import SENSOR
from inca_mj.robot import law
from inca_mj.robot.geometry import DRIVES

# What a hook sees of a drive; NaN where it comes before the quantity is known.
#   time [s]; phi [rad], omega [rad/s] of the motor; i [A] as logged; x own state
#   i_before, i_after [A] as logged, of the drives beside it, zero where there is none; for the hook
#   `current` only
#   rx, ry, rz [m] connector minus exit point, in O; d [m] path, d_0 [m] no-load length
#   strain [-], strain_rate [1/s]; T [N], F_s [N]; R, R_s [m], k_s [N/m], b_v [N m s/rad],
#   b_c [N m], beta [s/rad], K_t [N m/A], lambda_ [N], b [N s/m]: the model's numbers, without what
#   effects add to them
Drive: Any = namedtuple(
    "Drive",
    "time phi omega i i_before i_after x rx ry rz d d_0 strain strain_rate T F_s"
    " R R_s k_s b_v b_c beta K_t lambda_ b",
)

# What a hook sees of the platform: position [m], velocity [m/s] in O, body rates [rad/s], and
# R_AB, which turns body axes into O, row by row
Platform: Any = namedtuple(
    "Platform", "time x y z vx vy vz wx wy wz R11 R12 R13 R21 R22 R23 R31 R32 R33"
)

_XYZ_FORCE = ("force along x [N]", "along y [N]", "along z [N]")

DRIVE = Element(
    "drive",
    Drive,
    (
        Hook("current", ("Δi [A]",)),  # of what is known before the tension
        Hook("radius", ("ΔR [m]",)),  # of phi and x
        Hook("path", ("ΔL [m]", "∂ΔL/∂rx", "∂ΔL/∂ry", "∂ΔL/∂rz")),  # of rx, ry, rz
        Hook("tension", ("ΔT [N]",)),
        Hook("torque", ("Δτ on the motor [N m]",)),
        Hook("force", _XYZ_FORCE),  # on the connector, in O
        Hook("rate", ("ẋ of its own state [1/s]",)),
        Hook("start", ("its own state at the start, zero where this hook is not given",)),
    ),
)
PLATFORM = Element(
    "platform",
    Platform,
    (
        # at the centre of mass, in O
        Hook("wrench", (*_XYZ_FORCE, "torque about x [N m]", "about y [N m]", "about z [N m]")),
    ),
)
CENTRE = Element(
    "centre of mass",
    Platform,
    (
        # in body axes; called where values are written into the model, and never while it moves
        Hook("centre", ("its offset along x [m]", "along y [m]", "along z [m]")),
    ),
)
ELEMENTS = (DRIVE, PLATFORM, CENTRE, INPUT, SENSOR)

# Where effects may act, with the suffix of their parameters' names.
THINGS = tuple(str(k) for k in range(1, DRIVES + 1))
_EACH = {f"drive {k}": f"@{k}" for k in THINGS}

DRIVES_EACH = {"all drives": "", **_EACH}  # on all alike, or on one
ONE_DRIVE = _EACH  # on one only: common to all, it would be a base parameter
CABLES = {"all cables": ""}
ON_PLATFORM = {"platform": ""}


def by_law(
    function: Any, hook: str, text: str, sizes: tuple[Size, ...], shapes: tuple[Shape, ...] = (),
    places: Mapping[str, str] = DRIVES_EACH, *, phrase: str, reference: str, **hooks: Any,
) -> Effect:  # fmt: skip
    """Returns the effect that a compiled function is named after; `hooks` are further ones."""
    return Effect(
        function.__name__, text, sizes, shapes, places=places, phrase=phrase, reference=reference,
        hooks={hook: function, **hooks},
    )  # fmt: skip


KEY = law.ACTUATOR_COLUMNS  # column of `actuator_user` with the key of the set
FIRST = KEY + 1


@dataclass(frozen=True)
class Layout:
    """Columns and states of a set of effects.

    Attributes:
        effects: the set, in order.
        settled: whether a robot starts at rest with its effects, as one that has stood for a
            while; else with the nominal T(0), as one that was held until then.

    Raises:
        InputError: two effects have one name, or one has a hook that this robot has not.
    """

    effects: tuple[Effect, ...] = ()
    settled: bool = field(default=False, compare=False)  # the compiled law is the same

    def __post_init__(self) -> None:
        refuse_misplaced(self.effects, ELEMENTS)

    @cached_property
    def key(self) -> float:
        """Tells this set from others; zero, as where a drive carries no key, without effects."""
        return key_of(self.effects) if self.effects else 0.0

    @cached_property
    def on_drives(self) -> tuple[Term, ...]:
        """The effects with parameters in `actuator_user`."""
        return terms_of(self.effects, DRIVE, first=FIRST, state_hook="rate")

    @cached_property
    def on_platform(self) -> tuple[Term, ...]:
        """The effects with parameters in `body_user`."""
        return terms_of(self.effects, PLATFORM)

    @property
    def actuator_columns(self) -> int:
        """Width of `actuator_user`."""
        if not self.effects:
            return KEY
        return FIRST + sum(len(term.names) for term in self.on_drives)

    @property
    def body_columns(self) -> int:
        """Width of `body_user`."""
        return sum(len(term.names) for term in self.on_platform)

    @property
    def states(self) -> int:
        """Activations of a drive: d₀ and the effects' own."""
        return 1 + max((term.state for term in self.on_drives), default=0)
