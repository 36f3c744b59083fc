"""The compiled loop of `identification.native.forward`: over points, and at each over cases."""

from __future__ import annotations

from functools import cache
from typing import Any

import mujoco
from numba import types

from identification.native import structs
from identification.native.cache import compile_once
from identification.native.installer import add_share
from identification.native.library import mj_forwardSkip, mj_passive, solve
from identification.native.memory import (
    internal,
    load_double,
    load_word,
    offsets,
    store_double,
    word,
)

M = offsets("mjModel", "nq nv na nu")
D = offsets("mjData", "time qpos qvel act ctrl qacc_warmstart qacc act_dot qfrc_passive")
NONE, POSITION, VELOCITY = (
    int(stage)
    for stage in (mujoco.mjtStage.mjSTAGE_NONE, mujoco.mjtStage.mjSTAGE_POS,
                  mujoco.mjtStage.mjSTAGE_VEL)
)  # fmt: skip
SHARES = VELOCITY + 1  # all is there but the shares of some actuators

# base model; states of the base; table of the cases (place in the output, model, states, stage,
# first of its numbers, end of them, courses, their number, first of its actuators, end of them);
# number of cases; addresses of the numbers; their values; actuators of the cases; actuators of any
# case; their number; room for the shares of the base; data; number of points; table of the
# results; their number; interval of each point; weight of each point; output of the base; output
# of the cases; distance of two outputs; distance of two courses, where increments are asked for,
# else zero
SIGNATURE = types.void(*[types.int64] * 20)


@cache
def compiled_loop() -> Any:
    """Returns the loop over points and cases, compiled; its arguments are those of `SIGNATURE`."""
    structs.require((*M._fields, *D._fields))
    return compile_once(_forward, SIGNATURE)


@internal
def _copy(to, at, n):
    """Copy n doubles, and return the address behind the last one that was read."""
    for i in range(n):
        store_double(to + 8 * i, load_double(at + 8 * i))
    return at + 8 * n


@internal
def load_state(m, d, row):
    """Put a row of states into mjData; a solver of constraints begins without a guess."""
    row = _copy(d + 8 * D.time, row, 1)
    row = _copy(word(d, D.qpos), row, word(m, M.nq))
    row = _copy(word(d, D.qvel), row, word(m, M.nv))
    row = _copy(word(d, D.act), row, word(m, M.na))
    _copy(word(d, D.ctrl), row, word(m, M.nu))
    _forget(m, d)


@internal
def _forget(m, d):
    """Take the first guess of the accelerations away."""
    for i in range(word(m, M.nv)):
        store_double(word(d, D.qacc_warmstart) + 8 * i, 0.0)


@internal
def _exchange(places, values, n):
    """Exchange entries of a model with some values."""
    for i in range(n):
        at, value = load_word(places + 8 * i), values + 8 * i
        before = load_double(at)
        store_double(at, load_double(value))
        store_double(value, before)


@internal
def _collect(d, results, kinds, own, to, weight, is_relative):
    """Add the results, or how far they are from the base's, to an output."""
    i = 0
    for k in range(kinds):
        at = load_word(d + 8 * load_word(results + 16 * k))
        for j in range(load_word(results + 8 * (2 * k + 1))):
            x = load_double(at + 8 * j)
            if is_relative:
                x = load_double(to + 8 * i) + weight * (x - load_double(own + 8 * i))
            store_double(to + 8 * i, x)
            i += 1


@internal
def clear(x, n):
    """Set n doubles to zero."""
    for i in range(n):
        store_double(x + 8 * i, 0.0)


@internal
def _add(x, y, factor, n):
    """Adds factor · y to x in place, n doubles each."""
    for i in range(n):
        store_double(x + 8 * i, load_double(x + 8 * i) + factor * load_double(y + 8 * i))


@internal
def _keep_shares(m, d, some, n, room):
    """Put the forces of some actuators, as the base has them, into a row of the room each."""
    nv, f = word(m, M.nv), word(d, D.qfrc_passive)
    for k in range(n):
        i = load_word(some + 8 * k)
        clear(f, nv)
        add_share(m, d, i)
        _copy(room + 8 * nv * i, f, nv)


@internal
def _exchange_shares(m, d, own, actuators, n, room):
    """Put the rates of the base into mjData, with the shares of some actuators as they are now."""
    nv, f = word(m, M.nv), word(d, D.qfrc_passive)
    _copy(word(d, D.act_dot), own + 8 * nv, word(m, M.na))
    clear(f, nv)
    for k in range(n):
        i = load_word(actuators + 8 * k)
        add_share(m, d, i)
        _add(f, room + 8 * nv * i, -1.0, nv)
    solve(m, d, f)
    _copy(word(d, D.qacc), own, nv)
    _add(word(d, D.qacc), f, 1.0, nv)


def _forward(
    base,
    base_states,
    cases,
    n,
    places,
    values,
    actuators,
    some,
    count,
    room,
    d,
    points,
    results,
    kinds,
    where,
    weight,
    own,
    out,
    apart,
    course,
):
    row = 8 * (1 + word(base, M.nq) + word(base, M.nv) + word(base, M.na) + word(base, M.nu))
    width = 0
    for k in range(kinds):
        width += 8 * load_word(results + 8 * (2 * k + 1))
    for p in range(points):
        load_state(base, d, base_states + row * p)
        mj_forwardSkip((base, d, NONE, 0))
        _collect(d, results, kinds, own, own, 0.0, False)
        _keep_shares(base, d, some, count, room)
        for j in range(n):
            case = cases + 80 * j
            m, stage = load_word(case + 8), load_word(case + 24)
            first, end = load_word(case + 32), load_word(case + 40)
            _exchange(places + 8 * first, values + 8 * first, end - first)
            load_state(m, d, load_word(case + 16) + row * p)
            if stage == SHARES:
                alone, last = load_word(case + 64), load_word(case + 72)
                _exchange_shares(m, d, own, actuators + 8 * alone, last - alone, room)
            else:
                if stage == VELOCITY:
                    mj_passive((m, d))
                mj_forwardSkip((m, d, stage, 0))
            _exchange(places + 8 * first, values + 8 * first, end - first)
            to = out + apart * load_word(case) + width * load_word(where + 8 * p)
            factor = load_word(case + 48) + 8 * p
            for c in range(load_word(case + 56)):
                w = load_double(weight + 8 * p) * load_double(factor + course * c)
                _collect(d, results, kinds, own, to + apart * c, w, course > 0)
