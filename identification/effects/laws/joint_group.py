"""Joints of one kind whose effects are listed together: their units, and what size is plausible.

    F = max force,  V = max speed,  A = max travel/2,  T = max duration          over the joints

A size is plausible up to a share of what the drives can do: of F for a force, of F/V for what
grows with speed, of F/A for what grows along the way, of F/T for what grows with time (see `axes`).

One law has other units on a slide than on a hinge. A robot with both therefore has two effects of
it: `coulomb_friction` of its hinges, and `slide_coulomb_friction` of its slides. A robot with
joints of one kind has `coulomb_friction`, whichever kind that is.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property, partialmethod
from math import pi
from typing import Any

from identification.effects.axes import Axis, Kind
from identification.effects.effect import Effect, places
from identification.effects.sizes import Shape, Sign, Size
from identification.native.element import Function

PROBE = 0.01  # of the largest plausible size
# Of a slide's travel, to try: a wave that is off by one period of the travel is out of step with
# the true one at an end, so that none is left out up to the pitch of usual linear motors.
PERIODS = tuple(map(float, range(2, 33)))
SEEN = 2.0  # periods within the travel, below which a curve is not seen to repeat


@dataclass(frozen=True)
class Group:
    """Hinges, or slides."""

    kind: Kind  # of all of them
    axes: tuple[Axis, ...]  # the joints, one or more
    turns: Sequence[float]  # periods in a turn of a hinge that are tried
    both: bool = False  # whether the robot has joints of the other kind too

    @property
    def prefix(self) -> str:
        """The prefix of the effects' names."""
        return prefix_of(self.kind, self.both)

    @property
    def F(self) -> float:
        """Largest force of the drives [N m or N]."""
        return max(a.force for a in self.axes)

    @property
    def V(self) -> float:
        """Top speed [rad/s or m/s]."""
        return max(a.speed for a in self.axes)

    @property
    def L(self) -> float:
        """Largest travel [rad or m]."""
        return max(a.travel for a in self.axes)

    @property
    def A(self) -> float:
        """Half the largest travel [rad or m]."""
        return self.L / 2

    @property
    def T(self) -> float:
        """Longest record [s]; 0 where it is not known."""
        return max(a.duration for a in self.axes)

    @property
    def f(self) -> str:
        """Unit of a force."""
        return "N m" if self.kind == "hinge" else "N"

    @property
    def x(self) -> str:
        """Unit of a way."""
        return "rad" if self.kind == "hinge" else "m"

    @cached_property
    def at(self) -> dict[str, str]:
        """Places: all joints, and each."""
        return places("joint", tuple(a.joint for a in self.axes))

    @cached_property
    def plain(self) -> dict[str, str]:
        """Places where the drives' force is known."""
        return places("joint", tuple(a.joint for a in self.axes if a.plain))

    @cached_property
    def heavy(self) -> dict[str, str]:
        """Places on which gravity acts."""
        return places("joint", tuple(a.joint for a in self.axes if a.heavy))

    @cached_property
    def tilting(self) -> dict[str, str]:
        """Places on which gravity's force changes with the pose."""
        return places("joint", tuple(a.joint for a in self.axes if a.heavy and a.tilts))

    @cached_property
    def loaded(self) -> dict[str, str]:
        """Places where the drives' force is known and gravity acts."""
        return places("joint", tuple(a.joint for a in self.axes if a.plain and a.heavy))

    @cached_property
    def servos(self) -> dict[str, str]:
        """Places that a position servo drives."""
        return places("joint", tuple(a.joint for a in self.axes if a.servo))

    @property
    def k(self) -> float:
        """Largest stiffness of the position servos [N m/rad or N/m]."""
        return max(a.stiffness for a in self.axes)

    @cached_property
    def each(self) -> dict[str, str]:
        """Places: single joints."""
        return {where: suffix for where, suffix in self.at.items() if suffix}

    def size(self, name: str, largest: float, unit: str, about: str, sign: Sign = 0) -> Size:
        """Returns a size that is probed at a share of its largest plausible value."""
        return Size(name, unit, largest, PROBE * largest, sign, about)

    def effect(
        self, hook: str, law: Function, said: str, phrase: str, *sizes: Size, **more: Any
    ) -> Effect:
        """Returns an effect that is named like its law and acts on all these joints, or on one.

        Args:
            hook: "force", "friction", "series", "slip", "integral" or "input".
            law: its njit function.
            said: the law as a reader writes it.
            phrase: the effect in words.
            sizes: its sizes.
            more: other fields of `Effect`, such as shapes, places and reference.
        """
        phrase = with_kind(phrase, self.kind, self.both)
        fields = {"places": self.at, **more, "hooks": {hook: law}, "phrase": phrase}
        return Effect(self.prefix + law.__name__, said, sizes, **fields)

    force = partialmethod(effect, "force")
    friction = partialmethod(effect, "friction")


def groups(axes: Sequence[Axis], turns: Sequence[float] = ()) -> list[Group]:
    """Returns the hinges and the slides, where there are any.

    Args:
        axes: the joints.
        turns: periods in a turn of a hinge that are tried.
    """
    kinds: list[Kind] = ["hinge", "slide"]
    each = [(kind, tuple(a for a in axes if a.kind == kind)) for kind in kinds]
    both = all(group for _, group in each)
    return [Group(kind, group, turns, both) for kind, group in each if group]


def wave_sizes(g: Group) -> tuple[Size, ...]:
    """Returns the amplitudes of cosine and sine."""
    return (
        g.size("a", 0.2 * g.F, g.f, "amplitude of the cosine"),
        g.size("b", 0.2 * g.F, g.f, "amplitude of the sine"),
    )


def waves(g: Group) -> tuple[Shape, ...]:
    """Returns how often a periodic force repeats: per revolution, or in 2π m of a slide.

    A wave of which the log shows fewer than `SEEN` periods is not seen to repeat: any curve would
    do as well. Returns none where there is no wave to try.
    """
    least = 2 * pi * SEEN / g.L
    if g.kind == "slide":
        grid = tuple(2 * pi * w / g.L for w in PERIODS)
        return (Shape("n", "rad/m", grid, 0.9 * least, 2 * grid[-1], about="wave number"),)
    seen = tuple(n for n in g.turns if n >= least)
    if not seen:
        return ()
    high = max(48.0, *seen)
    return (Shape("n", "", seen, least, high, free=False, about="periods per revolution"),)


SLIDE = "slide_"  # before names of effects of slides, on a robot that has hinges too
_WORDS: dict[Kind, str] = {"hinge": "(hinges)", "slide": "(slides)"}


def prefix_of(kind: Kind, both: bool) -> str:
    """Returns the prefix of names of effects of a kind of joints; `both`: the robot has both."""
    return SLIDE if both and kind == "slide" else ""


def with_kind(phrase: str, kind: Kind, both: bool) -> str:
    """Returns an effect in words, with the kind of its joints where the robot has both."""
    return f"{phrase} {_WORDS[kind]}" if both else phrase


def about_names(asked: str, known: Iterable[str]) -> str:
    """Returns a sentence on the names of slides' effects, behind a list of good names, or ""."""
    if any(name.startswith(SLIDE) for name in known):
        where = "here, because effects may act on hinges too."
    elif asked.startswith(SLIDE):
        where = "only where effects may act on hinges too."
    else:
        return ""
    return f" Names of effects of slides begin with {SLIDE} {where}"
