"""The effects of inputs: what becomes of a signal, step by step, on its way to the model.

    m_k = (1/h) ∫ u' dt,    D_k = (1/h²) ∫ (t - t_mid) u' dt          over step k of length h
    u_k = m_k - D_k + D_(k-1)                                         what the model is given

An effect changes the input u into u', which may move within a step: its hook `input` returns mean
and moment of u' over the step. The mean keeps the impulse of the step; passing D on to the next
step keeps its moment too, so that what is lost is of third order in h. An effect may have a state
x of its own: `start` says where it begins, `next` what it is after the step.
"""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Sequence
from functools import cache
from typing import Any

from numba import types

from identification.native.cache import compile_once
from identification.native.compose import is_absent
from identification.native.element import Element, Function, Hook, Term, refuse_unfit_functions
from identification.native.memory import internal, load_double, loader, store_double

# What an effect sees of an input at step k.
#   k; time of the record in the middle of the step [s]; step h [s]
#   u: the input, held over the step; x: the effect's own state
#   signal: address of the input of all steps, which `past` and `shifted` read; steps: their number
Input: Any = namedtuple("Input", "k time step u x signal steps")

INPUT = Element(
    "input",
    Input,
    (
        Hook("input", ("mean of the input over the step", "its moment, zero where it is held")),
        Hook("start", ("own state before the first step",)),
        Hook("next", ("own state after the step",)),
    ),
    integers=("k", "signal", "steps"),
)

_SIGNATURE = types.void(types.int64, types.int64, types.float64, types.float64, types.int64)


@internal
def past(s, n, before):
    """Returns the input n steps ago; before step 0 it was `before` times the first input."""
    n = min(n, s.k + 1.0)  # a delay may be longer than any whole number
    if n > s.k:
        return before * load_double(s.signal)
    return load_double(s.signal + 8 * (s.k - int(n)))


@internal
def shifted(s, n):
    """Returns the input n steps ago, or ahead if n < 0; its first and last values last for ever."""
    at = min(max(s.k - n, 0.0), s.steps - 1.0)  # n may be larger than any whole number
    return load_double(s.signal + 8 * int(at))


@internal
def _zero(s, p):
    return 0.0


def _link(rest: Function, term: Term, place: int) -> Function:
    """Returns a chain with one more effect: it reads signal `place` and writes the next one."""
    change = term.function("input")
    start, after = term.function("start") or _zero, term.function("next") or _zero
    load, at, sizes = loader(len(term.names)), 8 * term.column, term.sizes

    @internal
    def changed(signals, steps, step, begun, row):
        rest(signals, steps, step, begun, row)
        signal = signals + 8 * steps * place
        out, p = signal + 8 * steps, load(row + at)
        if is_absent(p, sizes):
            for k in range(steps):
                store_double(out + 8 * k, load_double(signal + 8 * k))
            return
        u = load_double(signal)
        x = float(
            start(Input(k=0, time=begun, step=step, u=u, x=0.0, signal=signal, steps=steps), p)
        )
        last = 0.0
        for k in range(steps):
            u = load_double(signal + 8 * k)
            t = begun + step * (k + 0.5)
            s = Input(k=k, time=t, step=step, u=u, x=x, signal=signal, steps=steps)
            mean, moment = change(s, p)
            store_double(out + 8 * k, mean - moment + last)
            x, last = float(after(s, p)), float(moment)

    return changed


@cache
def input_filter(terms: Sequence[Term]) -> Any:
    """Returns the compiled effects of an input.

    Returns:
        (signals, steps, step, begun, row): a ctypes function. `signals` is the address of an array
        of shape (effects + 1, steps), the first row being the input; what each effect makes of the
        row above it is written to the next, so that the last row is what the model is given.
        `step` is their length [s], `begun` the time of the first of them in the
        record [s], `row` the address of the effects' parameters.
    """

    @internal
    def nothing(signals, steps, step, begun, row):
        return None

    chain: Function = nothing
    for place, term in enumerate(terms):
        chain = _link(chain, term, place)

    def inputs(signals, steps, step, begun, row):
        chain(signals, steps, step, begun, row)

    try:
        return compile_once(inputs, _SIGNATURE)
    except Exception:
        refuse_unfit_functions(INPUT, terms)
        raise
