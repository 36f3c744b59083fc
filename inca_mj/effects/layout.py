"""The places of the parameters of a set of effects in the model of this robot.

Those of drives and cables in the rows of `actuator_user`, behind the law's own columns; those of
the platform in its row of `body_user`; those of the inputs nowhere: they act before the model.
States of their own follow d₀ in a drive's activations. One column holds the key of the set, so
that a model is never advanced by the law of another.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

from identification.effects.effect import Effect
from identification.effects.layout import key_of, refuse_misplaced, terms_of
from identification.native.element import Term
from inca_mj.effects.hooks import DRIVE, ELEMENTS, PLATFORM
from inca_mj.robot import law

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
        return terms_of(self.effects, DRIVE, first=FIRST, own="rate")

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
