"""Forward dynamics of several changes of a model at many points, in compiled code.

    for each point:   all of the base;   for each case: what its change does not leave as it was

Most changes move no position and no velocity, and no number on which anything depends that follows
from these alone. They share the kinematics of the base, its inertias and their factors, and the
bias forces, which are most of an evaluation: what is left of it are forces and accelerations.

Those that concern single actuators of a law take the shares of these alone
(`identification.native.share`).

    rates       r_j(p)                                    a case at a point
    increments  Σ_p w_p c(p) (r_j(p) - r_0(p)) over an interval    how far it is from the base

c is a course in time that multiplies the change: what begins late needs no evaluation of its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import mujoco
import numpy as np
from numba import types

from identification.native import structs
from identification.native.access import offsets, word
from identification.native.cache import compile_once
from identification.native.decorators import internal
from identification.native.library import mj_forwardSkip, mj_passive
from identification.native.mass import solve
from identification.native.memory import load_double, load_word, store_double
from identification.native.share import add_share
from identification.pool import run_parts

STATE = ("time", "qpos", "qvel", "act", "ctrl")  # a row of states, in this order
M = offsets("mjModel", "nq nv na nu")
D = offsets("mjData", "time qpos qvel act ctrl qacc_warmstart qacc act_dot qfrc_passive")
_NONE, _POSITION, _VELOCITY = (
    int(stage)
    for stage in (mujoco.mjtStage.mjSTAGE_NONE, mujoco.mjtStage.mjSTAGE_POS,
                  mujoco.mjtStage.mjSTAGE_VEL)
)  # fmt: skip
_SHARES = _VELOCITY + 1  # all is there but the shares of some actuators
RATES = ("qacc", "act_dot")
SHARED = {"nothing": _NONE, "positions": _POSITION, "velocities": _VELOCITY}

# base model; states of the base; table of the cases (place in the output, model, states, stage,
# first of its numbers, end of them, courses, their number, first of its actuators, end of them);
# number of cases; addresses of the numbers; their values; actuators of the cases; actuators of any
# case; their number; room for the shares of the base; data; number of points; table of the
# results; their number; interval of each point; weight of each point; output of the base; output
# of the cases; distance of two outputs; distance of two courses, where increments are asked for,
# else zero
_SIGNATURE = types.void(*[types.int64] * 20)


@dataclass(frozen=True)
class Case:
    """A change of the base.

    Attributes:
        states: rows of `STATE`, shape (points, 1 + nq + nv + na + nu), contiguous; those of the
            base when None.
        numbers: entries of the model that differ, where the base's model serves: the array, the
            index in it, and the value.
        model: another one of the same sizes; that of the base when None.
        shares: a key of `SHARED`: what it leaves as it is in the base.
        courses: factors of the increments at the points, k courses that give an output each, shape
            (k, points), contiguous; one course of ones when None.
        actuators: those whose shares are all that differs; none where more does, or where other
            results than `RATES` are asked for.
    """

    states: np.ndarray | None = None
    numbers: Sequence[tuple[str, tuple[int, ...], float]] = ()
    model: mujoco.MjModel | None = None
    shares: str = "velocities"
    courses: np.ndarray | None = None
    actuators: Sequence[int] = ()


@dataclass(frozen=True)
class Intervals:
    """Intervals over which increments are averaged.

    Attributes:
        begins: first point of each interval, shape (L,).
        weight: share of each point in its interval, shape (points,).
    """

    begins: np.ndarray
    weight: np.ndarray


@dataclass(frozen=True)
class Base:
    """A model and its states at points, with a copy of the model for each thread.

    Attributes:
        models: the model, and copies of it into which numbers of cases are written.
        states: rows of `STATE`, shape (points, 1 + nq + nv + na + nu), contiguous.
    """

    models: tuple[mujoco.MjModel, ...]
    states: np.ndarray


def evaluate(
    base: Base, cases: Sequence[Case], results: Sequence[str], intervals: Intervals | None = None
) -> np.ndarray:
    """Evaluate each case at each point, as `mj_forward` does.

    Args:
        base: what the cases change.
        cases: n of them.
        results: fields of mjData that hold doubles, r of them in all.
        intervals: L intervals, where averages of the increments are asked for.

    Returns:
        Shape (n, points, r); or (Σ k, L, r), how far each case is from the base, averaged with each
        of its courses.
    """
    run, points = _compiled(), len(base.states)
    where = np.arange(points)
    weight = always = np.ones(points)
    if intervals is not None:
        where = np.searchsorted(intervals.begins, where, side="right") - 1
        weight = np.ascontiguousarray(intervals.weight, float)
    cuts = _parts(where, len(base.models))
    data = [mujoco.MjData(model) for model in base.models[: max(1, len(cuts) - 1)]]
    table = [(structs.word("mjData", f), np.size(getattr(data[0], f))) for f in results]
    structs.require(results)
    r = sum(size for _, size in table)
    courses = [always[None] if case.courses is None else case.courses for case in cases]
    rows_of = np.cumsum([0, *map(len, courses)])
    out = np.zeros((rows_of[-1], points if intervals is None else len(intervals.begins), r))
    wanted = np.array(table, np.int64)
    ends = np.cumsum([0, *(len(case.numbers) for case in cases)])
    values = np.array([value for case in cases for *_, value in case.numbers], float)

    # A case that moves positions leaves nothing in mjData that others could share: it comes last.
    stages = [_SHARES if case.actuators else SHARED[case.shares] for case in cases]
    order = sorted(range(len(cases)), key=lambda j: -stages[j])
    actuators = np.array([i for case in cases for i in case.actuators], np.int64)
    some, firsts = np.unique(actuators), np.cumsum([0, *(len(case.actuators) for case in cases)])

    def part(k: int) -> None:
        first, end, model = int(cuts[k]), int(cuts[k + 1]), base.models[k]
        rows = np.array([
            (
                rows_of[j], (cases[j].model or model)._address,
                (base.states if (x := cases[j].states) is None else x)[first:].ctypes.data,
                stages[j], *ends[j : j + 2], courses[j][:, first:].ctypes.data, len(courses[j]),
                *firsts[j : j + 2],
            )
            for j in order
        ], np.int64)  # fmt: skip
        places = np.array(
            [_address(model, *entry[:2]) for case in cases for entry in case.numbers], np.int64
        )
        own, mine, room = np.empty(r), values.copy(), np.empty((model.nactuator, model.nv))
        run(
            model._address, base.states[first:].ctypes.data, rows.ctypes.data, len(cases),
            places.ctypes.data, mine.ctypes.data, actuators.ctypes.data, some.ctypes.data,
            len(some), room.ctypes.data, data[k]._address, end - first,
            wanted.ctypes.data, len(table), where[first:].ctypes.data, weight[first:].ctypes.data,
            own.ctypes.data, out.ctypes.data, out.strides[0], 8 * points * (intervals is not None),
        )  # fmt: skip

    run_parts(part, range(len(cuts) - 1))
    return out


def _parts(where: np.ndarray, most: int) -> np.ndarray:
    """Returns the first points of the threads' parts, and their end: no interval is divided."""
    points = len(where)
    if not points:
        return np.zeros(1, int)
    wanted = np.linspace(0, points, max(1, min(most, points)) + 1).astype(int)[:-1]
    return np.append(np.unique(np.searchsorted(where, where[wanted])), points)


def _address(model: mujoco.MjModel, field: str, index: tuple[int, ...]) -> int:
    """Returns the address of one entry of a model."""
    array = getattr(model, field)
    return int(array.ctypes.data + np.dot(index, array.strides))


@cache
def _compiled() -> Any:
    structs.require((*M._fields, *D._fields))
    return compile_once(_forward, _SIGNATURE)


@internal
def _copy(to, at, n):  # type: ignore[no-untyped-def]
    """Copy n doubles, and return the address behind the last one that was read."""
    for i in range(n):
        store_double(to + 8 * i, load_double(at + 8 * i))
    return at + 8 * n


@internal
def _load(m, d, row):  # type: ignore[no-untyped-def]
    """Put a row of states into mjData; a solver of constraints begins without a guess."""
    row = _copy(d + 8 * D.time, row, 1)
    row = _copy(word(d, D.qpos), row, word(m, M.nq))
    row = _copy(word(d, D.qvel), row, word(m, M.nv))
    row = _copy(word(d, D.act), row, word(m, M.na))
    _copy(word(d, D.ctrl), row, word(m, M.nu))
    _forget(m, d)


@internal
def _forget(m, d):  # type: ignore[no-untyped-def]
    """Take the first guess of the accelerations away."""
    for i in range(word(m, M.nv)):
        store_double(word(d, D.qacc_warmstart) + 8 * i, 0.0)


@internal
def _exchange(places, values, n):  # type: ignore[no-untyped-def]
    """Exchange entries of a model with some values."""
    for i in range(n):
        at, value = load_word(places + 8 * i), values + 8 * i
        before = load_double(at)
        store_double(at, load_double(value))
        store_double(value, before)


@internal
def _collect(d, results, kinds, own, to, weight, is_relative):  # type: ignore[no-untyped-def]
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
def _clear(x, n):  # type: ignore[no-untyped-def]
    """Set n doubles to zero."""
    for i in range(n):
        store_double(x + 8 * i, 0.0)


@internal
def _add(x, y, factor, n):  # type: ignore[no-untyped-def]
    """Adds factor · y to x in place, n doubles each."""
    for i in range(n):
        store_double(x + 8 * i, load_double(x + 8 * i) + factor * load_double(y + 8 * i))


@internal
def _keep_shares(m, d, some, n, room):  # type: ignore[no-untyped-def]
    """Put the forces of some actuators, as the base has them, into a row of the room each."""
    nv, f = word(m, M.nv), word(d, D.qfrc_passive)
    for k in range(n):
        i = load_word(some + 8 * k)
        _clear(f, nv)
        add_share(m, d, i)
        _copy(room + 8 * nv * i, f, nv)


@internal
def _exchange_shares(m, d, own, actuators, n, room):  # type: ignore[no-untyped-def]
    """Put the rates of the base into mjData, with the shares of some actuators as they are now."""
    nv, f = word(m, M.nv), word(d, D.qfrc_passive)
    _copy(word(d, D.act_dot), own + 8 * nv, word(m, M.na))
    _clear(f, nv)
    for k in range(n):
        i = load_word(actuators + 8 * k)
        add_share(m, d, i)
        _add(f, room + 8 * nv * i, -1.0, nv)
    solve(m, d, f)
    _copy(word(d, D.qacc), own, nv)
    _add(word(d, D.qacc), f, 1.0, nv)


def _forward(  # type: ignore[no-untyped-def]
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
        _load(base, d, base_states + row * p)
        mj_forwardSkip((base, d, _NONE, 0))
        _collect(d, results, kinds, own, own, 0.0, False)
        _keep_shares(base, d, some, count, room)
        for j in range(n):
            case = cases + 80 * j
            m, stage = load_word(case + 8), load_word(case + 24)
            first, end = load_word(case + 32), load_word(case + 40)
            _exchange(places + 8 * first, values + 8 * first, end - first)
            _load(m, d, load_word(case + 16) + row * p)
            if stage == _SHARES:
                alone, last = load_word(case + 64), load_word(case + 72)
                _exchange_shares(m, d, own, actuators + 8 * alone, last - alone, room)
            else:
                if stage == _VELOCITY:
                    mj_passive((m, d))
                mj_forwardSkip((m, d, stage, 0))
            _exchange(places + 8 * first, values + 8 * first, end - first)
            to = out + apart * load_word(case) + width * load_word(where + 8 * p)
            factor = load_word(case + 48) + 8 * p
            for c in range(load_word(case + 56)):
                w = load_double(weight + 8 * p) * load_double(factor + course * c)
                _collect(d, results, kinds, own, to + apart * c, w, course > 0)
