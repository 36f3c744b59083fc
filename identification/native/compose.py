"""The sum of what all effects add, compiled into one function per hook.

    total(s, row) = Σ_e  hook_e(s, p_e)          over the effects whose sizes are not all zero

Each effect is an njit function that adds its own to what is added already. Two neighbours make one
such function, two of these the next, and so on: the compiler sees straight code and no table, and
enters no more functions inside functions than a tree is high. The order of the sum is that of the
effects.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from identification.native.element import Element, Function, Term
from identification.native.memory import (
    added,
    internal,
    load_double,
    loader,
    replacer,
    store_double,
)


@internal
def is_absent(p, sizes):
    """Returns whether the first numbers of a tuple, which are the sizes, are all zero."""
    for k in range(sizes):  # noqa: SIM110
        if p[k] != 0.0:
            return False
    return True


def total(element: Element, terms: Sequence[Term], hook: str) -> Function:
    """Returns the compiled sum of a hook over a set of effects.

    Returns:
        (s, row, states) -> one number or a tuple of them: s is the element's state, row the
        address of the effects' parameters, states the address of the states of their own.
    """
    zero = element.hook(hook).zero
    leaves = [
        _leaf(function, term, element)
        for term in terms
        if (function := term.function(hook)) is not None
    ]
    if not leaves:

        @internal
        def nothing(s, row, states):
            return zero

        return nothing
    add = _joined(leaves, _one_after_another)

    @internal
    def summed(s, row, states):
        return add(zero, s, row, states)

    return summed


def _joined(parts: Sequence[Function], join: Callable[[Function, Function], Function]) -> Function:
    """Returns one function of many, which run in their order: a balanced tree of pairs."""
    if len(parts) == 1:
        return parts[0]
    middle = len(parts) // 2
    return join(_joined(parts[:middle], join), _joined(parts[middle:], join))


def _one_after_another(first: Function, second: Function) -> Function:
    """Returns two functions (before, s, row, states) -> after as one."""

    @internal
    def both(before, s, row, states):
        return second(first(before, s, row, states), s, row, states)

    return both


def _leaf(function: Function, term: Term, element: Element) -> Function:
    """Returns an effect as a function (before, s, row, states) -> before with its own added."""
    load, at, sizes = loader(len(term.names)), 8 * term.column, term.sizes
    if term.state:
        own, with_own = 8 * term.state, replacer(element.state, "x")

        @internal
        def with_state(before, s, row, states):
            p = load(row + at)
            if is_absent(p, sizes):
                return before
            return added(before, function(with_own(s, (load_double(states + own),)), p))

        return with_state

    @internal
    def stateless(before, s, row, states):
        p = load(row + at)
        if is_absent(p, sizes):
            return before
        return added(before, function(s, p))

    return stateless


def rates(element: Element, terms: Sequence[Term], hook: str = "rate") -> Function:
    """Returns the compiled rates of the effects' own states.

    Returns:
        (s, row, states, out): writes the rate of the state at `states + 8 k` to `out + 8 k`.
    """

    leaves = [
        _rate(function, term, element)
        for term in terms
        if term.state and (function := term.function(hook)) is not None
    ]
    if not leaves:

        @internal
        def nothing(s, row, states, out):
            return None

        return nothing
    return _joined(leaves, _both_rates)


def _both_rates(first: Function, second: Function) -> Function:
    """Returns two functions (s, row, states, out) as one."""

    @internal
    def both(s, row, states, out):
        first(s, row, states, out)
        second(s, row, states, out)

    return both


def _rate(function: Function, term: Term, element: Element) -> Function:
    """Returns the rate of one effect's state as a function (s, row, states, out)."""
    load, at, own = loader(len(term.names)), 8 * term.column, 8 * term.state
    with_own = replacer(element.state, "x")

    @internal
    def rate(s, row, states, out):
        x = load_double(states + own)
        store_double(out + own, function(with_own(s, (x,)), load(row + at)))

    return rate
