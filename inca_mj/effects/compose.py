"""The sum of what all effects add, compiled into one function per hook.

    total(s, row) = Σ_e  hook_e(s, p_e)          over the effects whose sizes are not all zero

Each effect is a link of a chain of njit functions, so LLVM sees straight code and no table.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from numba import njit

from identification.native.memory import load_constant, load_double, store_double
from inca_mj.effects.hooks import Drive, DriveEffect
from inca_mj.effects.layout import Layout, Place

Function = Callable[..., Any]


@njit
def _load1(row):  # type: ignore[no-untyped-def]
    return (load_constant(row),)


@njit
def _load2(row):  # type: ignore[no-untyped-def]
    return load_constant(row), load_constant(row + 8)


@njit
def _load3(row):  # type: ignore[no-untyped-def]
    return load_constant(row), load_constant(row + 8), load_constant(row + 16)


@njit
def _load4(row):  # type: ignore[no-untyped-def]
    return (
        load_constant(row), load_constant(row + 8),
        load_constant(row + 16), load_constant(row + 24),
    )  # fmt: skip


_LOADERS = {1: _load1, 2: _load2, 3: _load3, 4: _load4}


@njit
def _absent(p, sizes):  # type: ignore[no-untyped-def]
    for k in range(sizes):  # noqa: SIM110
        if p[k] != 0.0:
            return False
    return True


@njit
def with_state(s, x):  # type: ignore[no-untyped-def]
    """The same drive, seen by the owner of the state x."""
    return Drive(
        s.time, s.phi, s.omega, s.i, x, s.rx, s.ry, s.rz, s.d, s.d_0, s.strain, s.strain_rate,
        s.T, s.F_s, s.R, s.R_s, s.k_s, s.b_c, s.beta, s.K_t, s.lambda_,
    )  # fmt: skip


@njit
def _one(rest, new):  # type: ignore[no-untyped-def]
    return rest + new


@njit
def _three(rest, new):  # type: ignore[no-untyped-def]
    return rest[0] + new[0], rest[1] + new[1], rest[2] + new[2]


@njit
def _four(rest, new):  # type: ignore[no-untyped-def]
    return rest[0] + new[0], rest[1] + new[1], rest[2] + new[2], rest[3] + new[3]


@njit
def _six(rest, new):  # type: ignore[no-untyped-def]
    return (
        rest[0] + new[0], rest[1] + new[1], rest[2] + new[2],
        rest[3] + new[3], rest[4] + new[4], rest[5] + new[5],
    )  # fmt: skip


_ADDERS = {1: _one, 3: _three, 4: _four, 6: _six}


def _link(rest: Function, hook: Function, place: Place, add: Function) -> Function:
    """One more effect on a chain of (s, row, act) functions: row and act are addresses."""
    effect = place.effect
    load, sizes = _LOADERS[len(effect.names)], len(effect.effect.sizes)
    at, state = 8 * place.column, 8 * place.state
    if state:

        @njit
        def with_own_state(s, row, act):  # type: ignore[no-untyped-def]
            before = rest(s, row, act)
            p = load(row + at)
            if _absent(p, sizes):
                return before
            return add(before, hook(with_state(s, load_double(act + state)), p))

        return with_own_state

    @njit
    def stateless(s, row, act):  # type: ignore[no-untyped-def]
        before = rest(s, row, act)
        p = load(row + at)
        if _absent(p, sizes):
            return before
        return add(before, hook(s, p))

    return stateless


def total(layout: Layout, hook: str, parts: int) -> Function:
    """The compiled sum of a hook over a set of effects: (s, row, act) -> number or `parts` of them.

    Args:
        layout: the effects and where their parameters are.
        hook: a hook of `DriveEffect`.
        parts: how many numbers the hook returns.
    """
    zero: Any = 0.0 if parts == 1 else (0.0,) * parts

    @njit
    def nothing(s, row, act):  # type: ignore[no-untyped-def]
        return zero

    chain: Function = nothing
    for place in layout:
        function = getattr(place.effect, hook)
        if function is not None and place.column >= 0:
            chain = _link(chain, function, place, _ADDERS[parts])
    return chain


def rates(layout: Layout) -> Function:
    """The compiled rates of the effects' own states: (s, row, act, out) writes to out + 8 state."""

    @njit
    def nothing(s, row, act, out):  # type: ignore[no-untyped-def]
        return None

    def link(rest: Function, effect: DriveEffect, at: int, state: int) -> Function:
        rate, load = effect.rate, _LOADERS[len(effect.names)]

        @njit
        def more(s, row, act, out):  # type: ignore[no-untyped-def]
            rest(s, row, act, out)
            x = load_double(act + state)
            store_double(out + state, rate(with_state(s, x), load(row + at)))

        return more

    chain: Function = nothing
    for place in layout:
        if place.state:
            chain = link(chain, place.effect, 8 * place.column, 8 * place.state)
    return chain
