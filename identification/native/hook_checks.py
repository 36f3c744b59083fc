"""Checks of the functions of effects, which say in one sentence what numba says on a page."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from numba import types
from numba.core.registry import cpu_target

from identification.errors import InputError
from identification.native.element import Element, Function, Hook, Term

_LONGEST = 160  # of numba's words in a message


def refuse_unfit_functions(element: Element, terms: Iterable[Term]) -> None:
    """Refuse a function that cannot be compiled for its hook or returns something else.

    Args:
        element: what the effects act on.
        terms: the effects.

    Raises:
        InputError: there is such a function; the first is named.
    """
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
    said = [line for line in lines if line and not line.startswith("Failed in")]
    reason = said[0] if said else type(error).__name__
    return reason if len(reason) <= _LONGEST else reason[: _LONGEST - 1] + "…"
