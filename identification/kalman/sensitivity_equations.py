"""Sensitivities of the outputs by the sensitivity equations, without a simulation for each column.

    δẋ = F δx + ∂f/∂θ_j,    δx(0) = ∂x₀/∂θ_j,    S_j = ∂h/∂x δx + ∂h/∂θ_j

F is the linearisation along the nominal trajectory, which all columns share. A column costs one
evaluation of the accelerations at each point of the trajectory, where a simulation costs four
in each of its steps.

The equations know a state only where the outputs feel it along the nominal trajectory. A candidate
effect that reads another one takes its nominal course, such as that of a motor's heat. One that
also changes that course, such as a creep with another time constant, is simulated.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace

import mujoco
import numpy as np

from identification.kalman.linear import Linearisation, tangent_index
from identification.kalman.response import respond
from identification.kalman.trajectory import average_inputs
from identification.linear.points import Change, Points
from identification.model.numbers import list_differences
from identification.model.predictor import Predictor, output_columns
from identification.model.protocol import Numbers, with_states
from identification.model.rollout import State, hold, substeps

Courses = Sequence[Callable[[np.ndarray], np.ndarray]]  # from times [s] to factors
ALWAYS: Courses = (np.ones_like,)
SHIFT = 1e-3  # of states that no output feels, to see whether a candidate reads them
FEW = 50  # points at which this is seen


def can_solve(predictor: Predictor, records: Sequence[Linearisation]) -> bool:
    """Whether the equations hold for a plant: all its states, and those of its sensors, are in x.

    Args:
        predictor: plant and log.
        records: the linearisation of each record.
    """
    read = [i for of in _indices(predictor) for i in of]
    return with_states(predictor.plant) is None and all(r.felt[read].all() for r in records)


def solve_sensitivities(
    predictor: Predictor,
    records: Sequence[Linearisation],
    values: np.ndarray,
    changed: np.ndarray,
    change: np.ndarray,
    courses: Sequence[Courses] = (),
) -> np.ndarray:
    """Computes the change of all outputs per unit of some changes of the parameters.

    Args:
        predictor: plant and log, with p parameters.
        records: the linearisation of each record at `values`.
        values: shape (p,), in the parameters' units.
        changed: values of the parameters after each of m changes, shape (m, p).
        change: the size of each change, shape (m,).
        courses: of each change the courses in time that multiply what it adds, one or more; none
            where each change counts throughout.

    Returns:
        Shape (N, ny, c), a column for each course; NaN in the columns of changes that the
        equations do not describe.

    Raises:
        DivergenceError: accelerations along the trajectory are not finite.
    """
    rows = np.vstack([values, changed])
    each = [
        _of_record(record, linear, rows[:, columns], change, courses or [ALWAYS] * len(change))
        for (record, columns), linear in zip(predictor.records(), records, strict=True)
    ]
    return np.concatenate(each)


def _of_record(
    predictor: Predictor, linear: Linearisation, rows: np.ndarray, change: np.ndarray,
    courses: Sequence[Courses],
) -> np.ndarray:  # fmt: skip
    """The sensitivities of one record; of columns that are zero in it nothing is computed."""
    is_moved = (rows[1:] != rows[0]).any(axis=1)
    moved = np.flatnonzero(is_moved)
    counts = np.array([len(of) for of in courses])
    out = np.zeros((*predictor.log.outputs.shape, counts.sum()))
    if moved.size:
        rows, change = rows[[0, *(1 + moved)]], change[moved]
        some = [courses[int(k)] for k in moved]
        start, numbers = predictor.settings(rows)
        g, known = _forcing(predictor, linear, rows, numbers, some)
        here = predictor.log.begun
        begun = np.array([float(course(np.array([here]))[0]) for of in some for course in of])
        which = np.repeat(np.arange(len(moved)), counts[moved])
        first = _first(linear, start, len(change))[which] * begun[:, None]
        size = change[which]
        g /= size[:, None, None]
        first /= size[:, None]
        y = _outputs(predictor, linear, rows[[0, *(1 + which)]], size, first, g)
        y[~known[which]] = np.nan
        out[..., np.repeat(is_moved, counts)] = np.moveaxis(y, 0, -1)
    return out


def _forcing(
    predictor: Predictor, linear: Linearisation, rows: np.ndarray, numbers: Numbers,
    courses: Sequence[Courses],
) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
    """How each change moves the rates.

    Returns:
        Means over the intervals, shape (c, L, nf), a row for each course, and whether that is all
        that each change does, shape (m,).
    """
    along, log, model = linear.along, predictor.log, predictor.plant.model
    felt = linear.felt[model.nv :]
    every = substeps(log.sampling_time, model.opt.timestep)
    sent = predictor.inputs(rows)(hold(log.inputs, every, log.hold))
    inputs = average_inputs(sent, along.steps, model.nu)
    differences = [*list_differences(numbers, 0, range(1, len(rows)))]

    def changes(**fields: np.ndarray) -> Iterator[Change]:
        return (Change(fields, entries) for entries in differences)

    def on_course() -> Iterator[Change]:
        for row, (own, of) in enumerate(zip(changes(), courses, strict=True), 1):
            if len(inputs) > 1 and not np.array_equal(inputs[row], inputs[0]):
                own = replace(own, fields={"ctrl": inputs[row]})
            times = None if of is ALWAYS else np.array([course(along.time) for course in of])
            yield replace(own, courses=times)

    g = np.array([*Points(along).each(on_course(), along.weighted)])[..., felt]
    if felt.all():
        return g, np.ones(len(courses), bool)
    some = along.some(FEW)
    away = changes(act=some.act + SHIFT * ~felt[model.nv :])
    return g, ~_read_what_they_change(Points(some), changes(), away, felt)


def _read_what_they_change(
    points: Points, changes: Iterable[Change], away: Iterable[Change], felt: np.ndarray
) -> np.ndarray:
    """Which models read activations that no output felt, and make them run otherwise.

    Args:
        points: some of the trajectory.
        changes: the models.
        away: the same with those activations shifted.
        felt: which rates the outputs feel.
    """
    nominally = points.rates()[:, ~felt]
    return np.array([
        not np.array_equal(runs[:, ~felt], nominally)
        and not np.array_equal(runs[:, felt], moved[:, felt])
        for runs, moved in zip(points.each(changes), points.each(away), strict=True)
    ])  # fmt: skip


def _first(linear: Linearisation, start: State, n: int) -> np.ndarray:
    """How n changes move the first state, shape (n, nx)."""
    model = linear.along.model
    first = [np.broadcast_to(x, (n + 1, np.shape(x)[-1])) for x in
             (start.qpos, start.qvel, start.act)]  # fmt: skip
    δ = np.zeros((n, 2 * model.nv + model.na))
    for row, qpos in zip(δ[:, : model.nv], first[0][1:], strict=True):
        mujoco.mj_differentiatePos(model, row, 1.0, first[0][0], qpos)
    δ[:, model.nv :] = np.hstack([x[1:] - x[0] for x in first[1:]])
    return δ[:, linear.felt]


def _outputs(
    predictor: Predictor,
    linear: Linearisation,
    rows: np.ndarray,
    change: np.ndarray,
    first: np.ndarray,
    g: np.ndarray,
) -> np.ndarray:
    """The change of what the sensors say, shape (m, N, ny)."""
    here = predictor.readings({field: each[None] for field, each in linear.along.states.items()})
    place = np.cumsum(linear.felt) - 1  # of an entry of the state among those that are felt
    wanted, where = np.unique(_indices(predictor), return_inverse=True)
    δx = respond(linear.A, linear.Γ, first, g, linear.along.intervals, place[wanted])
    y, q, v = (δx[..., own] for own in where.reshape(3, -1))
    nominal = predictor.said(rows[:1], here)
    out = np.empty_like(y)
    for k, row in enumerate(rows[1:, None]):
        if np.shares_memory(predictor.said(row, here), here):  # its sensors are perfect
            out[k] = y[k]
            continue
        there = here.copy()
        for reading, δ in zip(there, (y, q, v), strict=False):  # the time does not change
            reading += δ[k] * change[k]
        out[k] = (predictor.said(row, there) - nominal)[0] / change[k]
    return out


def _indices(predictor: Predictor) -> list[list[int]]:
    """Indices in the tangent state: of each sensor's reading, its joint's position and its rate."""
    model, sensors = predictor.plant.model, predictor.log.output_names
    own = [tangent_index(model, *at) for at in output_columns(model, sensors)]
    dofs = [int(model.jnt_dofadr[model.sensor(name).objid[0]]) for name in sensors]
    return [own, dofs, [model.nv + dof for dof in dofs]]
