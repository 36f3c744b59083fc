"""Forward dynamics of several models at many points, in compiled code.

    for each point:   positions of the base;   for each case: velocities, forces, accelerations

A case is a model and its states at the points. Most cases move no position, and no number on which
anything depends that follows from positions alone. They share the kinematics of the base, its
inertias and their factors, which are more than half of an evaluation.
"""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
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
from identification.native.library import mj_forwardSkip, mj_fwdPosition
from identification.native.memory import load_double, load_word, store_double

STATE = ("time", "qpos", "qvel", "act", "ctrl")  # a row of states, in this order
M = offsets("mjModel", "nq nv na nu")
D = offsets("mjData", "time qpos qvel act ctrl qacc_warmstart")
_NONE, _POSITION = int(mujoco.mjtStage.mjSTAGE_NONE), int(mujoco.mjtStage.mjSTAGE_POS)

# base model; states of the base; models of the cases; states of the cases; number of cases; whether
# they share positions; data; number of points; results; number of results; output; distance of the
# outputs of two cases
_SIGNATURE = types.void(*[types.int64] * 12)


@dataclass(frozen=True)
class Case:
    """A model at its states.

    Attributes:
        model: of the sizes of the base.
        states: rows of `STATE`, shape (points, 1 + nq + nv + na + nu), contiguous.
    """

    model: mujoco.MjModel
    states: np.ndarray


def evaluate(
    base: Case, cases: Sequence[Case], results: Sequence[str], *, shares: bool, threads: int
) -> np.ndarray:
    """Evaluate each case at each point, as `mj_forward` does.

    Args:
        base: whose positions the cases share.
        cases: n of them.
        results: fields of mjData that hold doubles, r of them in all.
        shares: whether they share them; else each computes its own.
        threads: of the processor.

    Returns:
        Shape (n, points, r).
    """
    run, points = _compiled(), len(base.states)
    parts = max(1, min(threads, points))
    data = [mujoco.MjData(base.model) for _ in range(parts)]
    table = [(structs.word("mjData", f), np.size(getattr(data[0], f))) for f in results]
    structs.require(results)
    out = np.empty((len(cases), points, sum(size for _, size in table)))
    models = np.array([case.model._address for case in cases], np.int64)
    wanted = np.array(table, np.int64)

    def part(k: int) -> None:
        first, end = k * points // parts, (k + 1) * points // parts
        states = np.array([case.states[first:].ctypes.data for case in cases], np.int64)
        run(
            base.model._address, base.states[first:].ctypes.data, models.ctypes.data,
            states.ctypes.data, len(cases), int(shares), data[k]._address, end - first,
            wanted.ctypes.data, len(table), out[:, first:].ctypes.data, out.strides[0],
        )  # fmt: skip

    if parts == 1:
        part(0)
    else:
        with ThreadPoolExecutor(parts) as pool:
            list(pool.map(part, range(parts)))
    return out


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
    for i in range(word(m, M.nv)):
        store_double(word(d, D.qacc_warmstart) + 8 * i, 0.0)


def _forward(  # type: ignore[no-untyped-def]
    base, base_states, models, states, n, shares, d, points, results, kinds, out, apart
):
    row = 8 * (1 + word(base, M.nq) + word(base, M.nv) + word(base, M.na) + word(base, M.nu))
    width = 0
    for k in range(kinds):
        width += 8 * load_word(results + 8 * (2 * k + 1))
    for p in range(points):
        if shares:
            _load(base, d, base_states + row * p)
            mj_fwdPosition((base, d))
        for j in range(n):
            m = load_word(models + 8 * j)
            _load(m, d, load_word(states + 8 * j) + row * p)
            mj_forwardSkip((m, d, _POSITION if shares else _NONE, 0))
            to = out + apart * j + width * p
            for k in range(kinds):
                size = load_word(results + 8 * (2 * k + 1))
                _copy(to, load_word(d + 8 * load_word(results + 16 * k)), size)
                to += 8 * size
