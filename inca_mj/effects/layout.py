"""Where the parameters of a set of effects live in the model.

Those of drives and cables in the rows of `actuator_user`, behind the law's own columns; those of
the platform in its row of `body_user`; those of the inputs nowhere: they act before the model.
States of their own follow d₀ in a drive's activations. One column holds the key of the set, so
that a model is never advanced by the law of another.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from zlib import crc32

from identification.errors import InputError
from inca_mj.effects.hooks import DriveEffect
from inca_mj.robot import law

KEY = law.ACTUATOR_COLUMNS  # column of `actuator_user` with the key of the set
FIRST = KEY + 1


@dataclass(frozen=True)
class Place:
    """Where one effect is: its first column, and which of a drive's own states it has.

    Attributes:
        effect: which.
        column: first column in `actuator_user` (or `body_user`), -1 where it has none.
        state: index among a drive's activations, 0 where it has none (that is d₀).
    """

    effect: DriveEffect
    column: int
    state: int

    @property
    def on_drives(self) -> bool:
        """Whether its parameters are in `actuator_user`."""
        return self.column >= 0 and self.effect.wrench is None

    @property
    def on_platform(self) -> bool:
        """Whether its parameters are in `body_user`."""
        return self.effect.wrench is not None


@dataclass(frozen=True)
class Layout:
    """Columns and states of a set of effects.

    Attributes:
        effects: the set, in order.
        settled: whether a robot starts at rest with its effects, as one that has stood for a
            while; else with the nominal T(0), as one that was held until then.

    Raises:
        InputError: two effects have one name.
    """

    effects: tuple[DriveEffect, ...] = ()
    settled: bool = field(default=False, compare=False)  # the compiled law is the same

    def __post_init__(self) -> None:
        names = [e.name for e in self.effects]
        twice = sorted({n for n in names if names.count(n) > 1})
        if twice:
            raise InputError(f"two effects are called {twice[0]!r}; rename one")

    @property
    def key(self) -> float:
        """Tells this set from others."""
        return float(crc32(repr([(e.name, e.names, e.effect.law) for e in self.effects]).encode()))

    def __iter__(self) -> Iterator[Place]:
        drive, platform, state = FIRST, 0, 0
        for effect in self.effects:
            width = len(effect.names)
            if effect.inputs is not None or effect.centre:
                yield Place(effect, -1, 0)
            elif effect.wrench is not None:
                yield Place(effect, platform, 0)
                platform += width
            else:
                state += effect.rate is not None
                yield Place(effect, drive, state if effect.rate is not None else 0)
                drive += width

    @property
    def actuator_columns(self) -> int:
        """Width of `actuator_user`."""
        if not self.effects:
            return KEY
        return FIRST + sum(len(p.effect.names) for p in self if p.on_drives)

    @property
    def body_columns(self) -> int:
        """Width of `body_user`."""
        return sum(len(p.effect.names) for p in self if p.on_platform)

    @property
    def states(self) -> int:
        """Activations of a drive: d₀ and the effects' own."""
        return 1 + sum(e.rate is not None for e in self.effects)
