"""The sum of what all effects add, compiled into one function per hook.

    total(s, row) = Σ_e  hook_e(s, p_e)          over the effects whose sizes are not all zero

Each effect is a link of a chain of njit functions, so that the compiler sees straight code and no
table. The order of the sum is that of the effects.
"""

from __future__ import annotations

from collections.abc import Sequence

from identification.native.decorators import internal
from identification.native.element import Element, Function, Term
from identification.native.memory import load_double, store_double
from identification.native.tuples import added, loader, replacer


@internal
def is_absent(p, sizes):  # type: ignore[no-untyped-def]
    """Whether the first numbers of a tuple, which are the sizes, are all zero."""
    for k in range(sizes):  # noqa: SIM110
        if p[k] != 0.0:
            return False
    return True


def total(element: Element, terms: Sequence[Term], hook: str) -> Function:
    """The compiled sum of a hook over a set of effects.

    Args:
        element: what the effects act on.
        terms: the effects.
        hook: name of the hook.

    Returns:
        (s, row, states) -> one number or a tuple of them: s is the element's state, row the
        address of the effects' parameters, states the address of the states of their own.
    """
    zero = element.hook(hook).zero

    @internal
    def nothing(s, row, states):  # type: ignore[no-untyped-def]
        return zero

    chain: Function = nothing
    for term in terms:
        function = term.function(hook)
        if function is not None:
            chain = _link(chain, function, term, element)
    return chain


def _link(rest: Function, function: Function, term: Term, element: Element) -> Function:
    """One more effect on a chain of (s, row, states) functions."""
    load, at, sizes = loader(len(term.names)), 8 * term.column, term.sizes
    if term.state:
        own, with_own = 8 * term.state, replacer(element.state, "x")

        @internal
        def with_state(s, row, states):  # type: ignore[no-untyped-def]
            before = rest(s, row, states)
            p = load(row + at)
            if is_absent(p, sizes):
                return before
            return added(before, function(with_own(s, (load_double(states + own),)), p))

        return with_state

    @internal
    def stateless(s, row, states):  # type: ignore[no-untyped-def]
        before = rest(s, row, states)
        p = load(row + at)
        if is_absent(p, sizes):
            return before
        return added(before, function(s, p))

    return stateless


def rates(element: Element, terms: Sequence[Term], hook: str = "rate") -> Function:
    """The compiled rates of the effects' own states.

    Args:
        element: what the effects act on.
        terms: the effects.
        hook: name of the hook that returns ẋ.

    Returns:
        (s, row, states, out): writes the rate of the state at `states + 8 k` to `out + 8 k`.
    """

    @internal
    def nothing(s, row, states, out):  # type: ignore[no-untyped-def]
        return None

    def link(rest: Function, function: Function, term: Term) -> Function:
        load, at, own = loader(len(term.names)), 8 * term.column, 8 * term.state
        with_own = replacer(element.state, "x")

        @internal
        def more(s, row, states, out):  # type: ignore[no-untyped-def]
            rest(s, row, states, out)
            x = load_double(states + own)
            store_double(out + own, function(with_own(s, (x,)), load(row + at)))

        return more

    chain: Function = nothing
    for term in terms:
        function = term.function(hook)
        if term.state and function is not None:
            chain = link(chain, function, term)
    return chain
