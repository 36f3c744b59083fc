"""The elements that effects act on, such as a joint or a drive: their state, and their hooks.

A hook is one place of a law where effects may add. Its function takes the element's state and the
effect's parameters, sizes first, and returns one number or a tuple of them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from numba import types
from numba.core.registry import cpu_target

from identification.errors import InputError

_LONGEST = 160  # of numba's words in a message


def refuse_unfit_functions(element: Element, terms: Iterable[Term]) -> None:
    """Refuse a function that cannot be compiled for its hook or returns something else."""
    for term in terms:
        for name, function in term.functions:
            _refuse_unfit(element, element.hook(name), term, function)


def _refuse_unfit(element: Element, hook: Hook, term: Term, function: Function) -> None:
    takes = (
        f"it must take a {element.state.__name__} ({', '.join(element.state._fields)}) and a tuple"
        f" of {len(term.names)} ({', '.join(term.names)}), and return {hook}"
    )
    where = f"effect {term.effect!r}: the function {function.__name__} of its hook {hook.name!r}"
    try:
        returned = _returned(element, term, function)
    except Exception as error:  # numba passes on whatever a function's own names raise
        raise InputError(f"{where} cannot be compiled ({_reason(error)}); {takes}") from None
    if isinstance(returned, types.Optional):
        raise InputError(f"{where} returns nothing in some branch; {takes}")
    if not cpu_target.typing_context.can_convert(returned, hook.type):
        raise InputError(f"{where} returns {_said(returned)}; {takes}")


def _returned(element: Element, term: Term, function: Function) -> Any:
    """Returns numba's type of what a function returns for its hook's state and parameters."""
    signature = (element.type, types.UniTuple(types.float64, len(term.names)))
    dispatcher: Any = function
    dispatcher.compile(signature)
    return dispatcher.overloads[signature].signature.return_type


def _said(returned: Any) -> str:
    if isinstance(returned, types.NoneType):
        return "nothing"
    if isinstance(returned, types.BaseTuple):
        return f"{len(returned)} numbers" if len(returned) != 1 else "a tuple of one number"
    real = isinstance(returned, (types.Integer, types.Float))
    return "one number" if real else f"a value of type {returned}"


def _reason(error: Exception) -> str:
    """Returns the line of numba's page that says what it is about."""
    lines = [line.strip() for line in str(error).splitlines()]
    reasons = [line for line in lines if line and not line.startswith("Failed in")]
    reason = reasons[0] if reasons else type(error).__name__
    return reason if len(reason) <= _LONGEST else reason[: _LONGEST - 1] + "…"


Function = Callable[..., Any]


@dataclass(frozen=True)
class Hook:
    """A place of a law where effects may add."""

    name: str  # what an effect calls it, e.g. "torque".
    # the numbers that a function for it returns, each with its unit in brackets
    returns: tuple[str, ...]

    @property
    def zero(self) -> float | tuple[float, ...]:
        """The value that the hook adds where no effect is."""
        return 0.0 if len(self.returns) == 1 else (0.0,) * len(self.returns)

    @property
    def type(self) -> Any:
        """The type that the hook's functions return, as numba's type."""
        count = len(self.returns)
        return types.float64 if count == 1 else types.UniTuple(types.float64, count)

    def __str__(self) -> str:
        count = len(self.returns)
        return f"{count} number{'s' * (count > 1)}, {', '.join(self.returns)}"


@dataclass(frozen=True)
class Element:
    """A kind of thing that effects act on."""

    name: str  # in words, e.g. "joint".
    # class of the named tuple that the hooks' functions see. Where an effect may have a state of
    # its own, it is the field `x`.
    state: Any
    hooks: tuple[Hook, ...]  # the places of its law
    # fields of `state` that are whole numbers; all others are doubles
    integers: tuple[str, ...] = ()

    @property
    def type(self) -> Any:
        """The type of the element's state, as numba's type."""
        fields = [types.int64 if f in self.integers else types.float64 for f in self.state._fields]
        return types.BaseTuple.from_types(fields, self.state)

    def hook(self, name: str) -> Hook:
        """Returns the hook of a name that is one of its own."""
        return next(hook for hook in self.hooks if hook.name == name)


@dataclass(frozen=True, kw_only=True)
class Term:
    """An effect in the law of an element: its functions, and where its numbers stand in a row."""

    effect: str  # its name
    functions: tuple[tuple[str, Function], ...]  # name of a hook and its njit function, in pairs
    names: tuple[str, ...]  # its parameters, sizes first
    sizes: int  # how many of them are sizes; where all sizes are zero, the effect is absent
    column: int  # where the first of its parameters stands in the row
    state: int = 0  # which of the element's states is its own, counted from 1; 0 where it has none

    def function(self, hook: str) -> Function | None:
        """Returns its function for a hook, None where it adds nothing there."""
        return dict(self.functions).get(hook)
