"""Joints of one kind whose effects are listed together: their units, and what size is plausible.

    F = max force,  V = max speed,  A = max travel/2,  T = max duration          over the joints

A size is plausible up to a share of what the drives can do: of F for a force, of F/V for what
grows with speed, of F/A for what grows along the way, of F/T for what grows with time (see `axes`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from identification.effects.axes import Axis, Kind
from identification.effects.effect import Effect, Shape, Sign, Size
from identification.effects.kinds import prefix_of, with_kind
from identification.effects.places import places
from identification.native.element import Function

PROBE = 0.01  # of the largest plausible size


@dataclass(frozen=True)
class Group:
    """Hinges, or slides.

    Attributes:
        kind: of all of them.
        axes: the joints, one or more.
        turns: periods in a turn of a hinge that are tried.
        both: whether the robot has joints of the other kind too.
    """

    kind: Kind
    axes: tuple[Axis, ...]
    turns: Sequence[float]
    both: bool = False

    @property
    def prefix(self) -> str:
        """The prefix of the effects' names."""
        return prefix_of(self.kind, self.both)

    def told(self, phrase: str) -> str:
        """Returns an effect of these joints in words."""
        return with_kind(phrase, self.kind, self.both)

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
    def loaded(self) -> dict[str, str]:
        """Places where the drives' force is known and gravity acts."""
        return places("joint", tuple(a.joint for a in self.axes if a.plain and a.heavy))

    @cached_property
    def each(self) -> dict[str, str]:
        """Places: single joints."""
        return {where: suffix for where, suffix in self.at.items() if suffix}

    def size(self, name: str, largest: float, unit: str, about: str, sign: Sign = 0) -> Size:
        """Returns a size that is probed at a share of its largest plausible value."""
        return Size(name, unit, largest, PROBE * largest, sign, about)

    def friction(
        self, law: Function, said: str, sizes: tuple[Size, ...], phrase: str, reference: str = "",
        shapes: tuple[Shape, ...] = (), where: Mapping[str, str] | None = None,
        needs: str = "",
    ) -> Effect:  # fmt: skip
        """Returns an effect on the largest friction, named like its law."""
        found = self._effect("friction", law, said, sizes, phrase, reference, shapes, where)
        return replace(found, needs=self.prefix + needs) if needs else found

    def force(
        self, law: Function, said: str, sizes: tuple[Size, ...], phrase: str, reference: str = "",
        shapes: tuple[Shape, ...] = (), where: Mapping[str, str] | None = None,
    ) -> Effect:  # fmt: skip
        """Returns a force, named like its law."""
        return self._effect("force", law, said, sizes, phrase, reference, shapes, where)

    def _effect(
        self, hook: str, law: Function, said: str, sizes: tuple[Size, ...], phrase: str,
        reference: str, shapes: tuple[Shape, ...], where: Mapping[str, str] | None,
    ) -> Effect:  # fmt: skip
        return Effect(
            self.prefix + law.__name__, said, sizes, shapes, phrase=self.told(phrase),
            reference=reference,
            places=self.at if where is None else where, hooks={hook: law},
        )  # fmt: skip
