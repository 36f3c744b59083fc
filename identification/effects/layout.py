"""The places of the parameters of a set of effects in the rows of what they act on.

    row of a thing = (…, parameters of effect 1, parameters of effect 2, …)

Sizes come first, shapes follow. The key of a set says which compiled law its rows are made for.
"""

from __future__ import annotations

from collections.abc import Sequence
from zlib import crc32

from identification.effects.effect import Effect
from identification.errors import InputError
from identification.native.element import Element, Term


def terms_of(
    effects: Sequence[Effect], element: Element, *, first: int = 0, own: str = ""
) -> tuple[Term, ...]:
    """Returns the effects of one element, and where in its row their parameters stand.

    Args:
        effects: a set; those that act on other elements are passed over.
        element: what they act on.
        first: column of the first parameter.
        own: the hook that an effect with a state of its own has, "" where none can have one.
    """
    out: list[Term] = []
    column, states = first, _states(effects, own)
    for effect in effects:
        if not _acts_on(effect, element):
            continue
        out.append(
            Term(
                effect=effect.name,
                functions=tuple(effect.hooks.items()),
                names=effect.names,
                sizes=len(effect.sizes),
                column=column,
                state=states.get(effect.name, 0),
            )
        )
        column += len(effect.names)
    return tuple(out)


def _states(effects: Sequence[Effect], own: str) -> dict[str, int]:
    """Returns the number of each effect's state, counted from 1, by the effect's name."""
    numbers: dict[object, int] = {}
    having = [e for e in effects if own in e.hooks]
    keys = {e.name: e.hooks[own] if e.shares else e.name for e in having}
    return {name: numbers.setdefault(key, len(numbers) + 1) for name, key in keys.items()}


def key_of(effects: Sequence[Effect], of: str = "") -> float:
    """Returns the number that tells a set of effects from others.

    Args:
        effects: the set.
        of: what they act on, where sets of other things may bear the same names.
    """
    return float(crc32((of + repr([(e.name, e.names, e.law) for e in effects])).encode()))


def refuse_misplaced(effects: Sequence[Effect], elements: Sequence[Element]) -> None:
    """Refuse effects that a robot cannot have.

    Args:
        effects: the set.
        elements: what a robot has that effects may act on.

    Raises:
        InputError: two effects have one name, or the hooks of one are not those of one element.
    """
    names = [e.name for e in effects]
    twice = sorted({n for n in names if names.count(n) > 1})
    if twice:
        raise InputError(f"two effects are called {twice[0]!r}; rename one")
    for effect in effects:
        if sum(_acts_on(effect, element) for element in elements) != 1:
            own = f"the hooks {', '.join(effect.hooks)}" if effect.hooks else "no hook"
            known = "; ".join(
                f"{element.name}: {', '.join(hook.name for hook in element.hooks)}"
                for element in elements
            )
            raise InputError(
                f"effect {effect.name!r} has {own}; give it hooks of one of the things that this"
                f" robot has ({known})"
            )


def _acts_on(effect: Effect, element: Element) -> bool:
    return bool(effect.hooks) and effect.hooks.keys() <= {hook.name for hook in element.hooks}
