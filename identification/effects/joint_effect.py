"""A candidate effect of a joint or of an input, and where in the model its numbers go."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from identification.effects.effect import Effect

Change = Callable[..., np.ndarray]


@dataclass(frozen=True)
class JointEffect:
    """An effect and how a plant has it.

    Attributes:
        effect: name, law, sizes, shapes and places.
        columns: of `law.Numbers`, where its numbers go, sizes first; empty for an input.
        inputs: (u (steps,), step [s], *numbers) -> u (steps,), for an effect of an input.
    """

    effect: Effect
    columns: tuple[str, ...] = ()
    inputs: Change | None = None

    @property
    def name(self) -> str:
        """Canonical name."""
        return self.effect.name

    def parameters_at(self, thing: str) -> list[list[str]]:
        """Names of the parameters that add up to each number at a joint or input, sizes first.

        Args:
            thing: name of the joint or actuator; it has nothing where the list is empty.
        """
        suffixes = [s for s in self.effect.places.values() if s in ("", f"@{thing}")]
        if not suffixes:
            return []
        sizes = [[f"{self.name}.{s.name}{at}" for at in suffixes] for s in self.effect.sizes]
        return sizes + [[f"{self.name}.{shape.name}"] for shape in self.effect.shapes]


def places(kind: str, names: tuple[str, ...]) -> dict[str, str]:
    """Where an effect may act among some joints or inputs: on all alike, or on one."""
    each = {f"{kind} {name}": f"@{name}" for name in names}
    return each if len(names) < 2 else {f"all {kind}s": "", **each}
