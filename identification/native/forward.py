"""Forward dynamics of several changes of a model at many points, in compiled code.

    for each point:   all of the base;   for each case: what its change does not leave as it was

Most changes move no position and no velocity, and no number on which anything depends that follows
from these alone. They share the kinematics of the base, its inertias and their factors, and the
bias forces, which are most of an evaluation: what is left of it are forces and accelerations.

A change of what single actuators of a law read takes the shares of these alone
(`identification.native.installer`).

    rates       r_j(p)                                    a case at a point
    increments  Σ_p w_p c(p) (r_j(p) - r_0(p)) over an interval    how far it is from the base

c is a course in time that multiplies the change: what begins late needs no evaluation of its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

from identification.native import structs
from identification.native.forward_loop import NONE, POSITION, SHARES, VELOCITY, compiled_loop
from identification.runtime.pool import run_parts

STATE = ("time", "qpos", "qvel", "act", "ctrl")  # a row of states, in this order
RATES = ("qacc", "act_dot")
KEPT = {"nothing": NONE, "positions": POSITION, "velocities": VELOCITY}


@dataclass(frozen=True)
class Case:
    """A change of the base."""

    # rows of `STATE`, shape (points, 1 + nq + nv + na + nu), contiguous; those of the base when
    # None
    states: np.ndarray | None = None
    # entries of the model that differ, where the base's model serves: the array, the index in it,
    # and the value
    numbers: Sequence[tuple[str, tuple[int, ...], float]] = ()
    model: mujoco.MjModel | None = None  # another one of the same sizes; that of the base when None
    keeps: str = "velocities"  # a key of `KEPT`: what of the base it leaves as it is
    # factors of the increments at the points, k courses that give an output each, shape (k,
    # points), contiguous; one course of ones when None
    courses: np.ndarray | None = None
    # those whose shares are all that differs; none where more does, or where other results than
    # `RATES` are asked for
    actuators: Sequence[int] = ()


@dataclass(frozen=True)
class Intervals:
    """Intervals over which increments are averaged."""

    begins: np.ndarray  # first point of each interval, shape (L,)
    weight: np.ndarray  # share of each point in its interval, shape (points,)


@dataclass(frozen=True)
class Base:
    """A model and its states at points, with a copy of the model for each thread."""

    # the model, and copies of it into which numbers of cases are written
    models: tuple[mujoco.MjModel, ...]
    states: np.ndarray  # rows of `STATE`, shape (points, 1 + nq + nv + na + nu), contiguous


def evaluate(
    base: Base, cases: Sequence[Case], results: Sequence[str], intervals: Intervals | None = None
) -> np.ndarray:
    """Evaluate each case at each point, as `mj_forward` does.

    Returns:
        Shape (n, points, r); or (Σ k, L, r), how far each case is from the base, averaged with each
        of its courses.
    """
    run, points = compiled_loop(), len(base.states)
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
    stages = [SHARES if case.actuators else KEPT[case.keeps] for case in cases]
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
