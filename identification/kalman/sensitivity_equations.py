"""Sensitivities of the outputs by the sensitivity equations, without a simulation for each column.

    δẋ = F δx + ∂f/∂θ_j,    δx(0) = ∂x₀/∂θ_j,    S_j = ∂h/∂x δx + ∂h/∂θ_j

F is the linearisation along the nominal trajectory, which all columns share. A column costs one
evaluation of the accelerations at each point of the trajectory, where a simulation costs four
in each of its steps. One that changes inputs alone costs none: its ∂f/∂θ_j is ∂f/∂u ∂u/∂θ_j.

The equations know a state only where the outputs feel it along the nominal trajectory. A candidate
effect that reads another one takes its nominal course, such as that of a motor's heat. One that
also changes that course, such as a creep with another time constant, is simulated.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import islice

import mujoco
import numpy as np

from identification.kalman.linear import Linearisation, tangent_index
from identification.kalman.response import respond
from identification.kalman.trajectory import average_inputs
from identification.linear.points import Change, Points
from identification.model.predictor import Predictor, output_columns
from identification.model.protocol import Entries, Numbers, list_differences, with_states
from identification.model.rollout import State, hold, substeps

Courses = Sequence[Callable[[np.ndarray], np.ndarray]]  # from times [s] to factors
ALWAYS: Courses = (np.ones_like,)
UNFELT_SHIFT = 1e-3  # of states that no output feels, to see whether a candidate reads them
PROBED_POINTS = 50  # at which this is seen
RATE_ROUNDING = 1e-12  # of the largest rate


def can_solve(predictor: Predictor, records: Sequence[Linearisation]) -> bool:
    """Returns whether the equations hold for a plant: all states, also of its sensors, are in x."""
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
    """Computes the change of all outputs per unit of m changes of the parameters: (N, ny, c).

    There is a column for each course, NaN for changes that the equations do not describe.

    Args:
        predictor: plant and log, with p parameters.
        records: the linearisation of each record at `values`.
        values: shape (p,), in the parameters' units.
        changed: values of the parameters after each change, shape (m, p).
        change: the size of each change, shape (m,).
        courses: of each change the courses in time that multiply what it adds, one or more; none
            where each change counts throughout.

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
    """Returns the sensitivities of one record; columns that are zero in it are not computed."""
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
        factors = np.array([float(course(np.array([here]))[0]) for of in some for course in of])
        which = np.repeat(np.arange(len(moved)), counts[moved])
        first = _first(linear, start, len(change))[which] * factors[:, None]
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
    """Returns how each change moves the rates, and whether that is all that it does, shape (m,).

    The first are means over the intervals, shape (c, L, nf), a row for each course.
    """
    along, log, model = linear.along, predictor.log, predictor.plant.model
    every = substeps(log.sampling_time, model.opt.timestep)
    sent = predictor.inputs(rows)(hold(log.inputs, every, log.hold))
    inputs = average_inputs(sent, along.steps, model.nu)
    if len(inputs) == 1:  # they are the same in all rows
        inputs = np.broadcast_to(inputs, (len(rows), *inputs.shape[1:]))
    entries = [*list_differences(numbers, 0, range(1, len(rows)))]
    always = np.ones((1, len(along.time)))
    factors = [
        always if of is ALWAYS else np.array([course(along.time) for course in of])
        for of in courses
    ]
    moving = [k for k, entry in enumerate(entries) if entry]
    changes = (_change(entries[k], inputs[1 + k], inputs[0], factors[k]) for k in moving)
    found = Points(along).each(changes, along.weighted)
    g = []
    for k, of in enumerate(factors):
        if entries[k]:
            g += [increment[:, linear.felt[model.nv :]] for increment in islice(found, len(of))]
        else:  # what moves no number of the model acts through its inputs, or on readings alone
            g += [*_by_inputs(linear, inputs[1 + k] - inputs[0], of)]
    known = np.ones(len(courses), bool)
    known[moving] = ~_reads_what_it_changes(linear, [entries[k] for k in moving])
    return np.array(g), known


def _change(entries: Entries, inputs: np.ndarray, nominal: np.ndarray, of: np.ndarray) -> Change:
    """Returns a change: the numbers of a model that differ, and the inputs if they do."""
    fields = {} if np.array_equal(inputs, nominal) else {"ctrl": inputs}
    return Change(fields, entries, of)


def _by_inputs(linear: Linearisation, δu: np.ndarray, courses: np.ndarray) -> np.ndarray:
    """Returns how a change of the inputs (M, nu) moves the rates, by course (k, M): (k, L, nf)."""
    along = linear.along
    if not δu.any():
        return np.zeros((len(courses), len(along.begins), linear.Γ.shape[2]))
    upwards, downwards = linear.of_inputs
    moved = np.einsum("pfu,pu->pf", upwards, np.maximum(δu, 0))
    moved += np.einsum("pfu,pu->pf", downwards, np.minimum(δu, 0))
    return np.array([along.average(moved * course[:, None]) for course in courses])


def _reads_what_it_changes(linear: Linearisation, changes: Sequence[Entries]) -> np.ndarray:
    """Returns which changes move activations that no output felt, and read them."""
    felt = linear.felt[linear.along.model.nv :]
    if felt.all() or not changes:
        return np.zeros(len(changes), bool)
    some = linear.along.some(PROBED_POINTS)
    points, away = Points(some), {"act": some.act + UNFELT_SHIFT * ~felt[some.model.nv :]}
    nominally = points.rates()[:, ~felt]
    pairs = zip(
        points.each(Change({}, own) for own in changes),
        points.each(Change(away, own) for own in changes),
        strict=True,
    )
    return np.array(
        [
            _differ(runs[:, ~felt], nominally) and _differ(runs[:, felt], moved[:, felt])
            for runs, moved in pairs
        ]
    )


def _differ(some: np.ndarray, others: np.ndarray) -> bool:
    """Returns whether rates differ by more than rounding, which depends on the order of sums."""
    return bool((np.abs(some - others) > RATE_ROUNDING * np.abs(others).max(axis=0)).any())


def _first(linear: Linearisation, start: State, n: int) -> np.ndarray:
    """Returns how n changes move the first state, shape (n, nx)."""
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
    """Returns the change of the sensors' readings, shape (m, N, ny)."""
    here = predictor.readings({field: each[None] for field, each in linear.along.states.items()})
    place = np.cumsum(linear.felt) - 1  # of an entry of the state among those that are felt
    wanted, where = np.unique(_indices(predictor), return_inverse=True)
    δx = respond(linear.A, linear.Γ, first, g, linear.along.intervals, place[wanted])
    y, q, v = (δx[..., columns] for columns in where.reshape(3, -1))
    if _are_perfect(predictor, rows, here):
        return y
    nominal = predictor.said(rows[:1], here)
    out = np.empty_like(y)
    for k, row in enumerate(rows[1:, None]):
        if _are_perfect(predictor, row, here):
            out[k] = y[k]
            continue
        changed = here.copy()
        for reading, δ in zip(changed, (y, q, v), strict=False):  # the time does not change
            reading += δ[k] * change[k]
        out[k] = (predictor.said(row, changed) - nominal)[0] / change[k]
    return out


def _are_perfect(predictor: Predictor, rows: np.ndarray, here: np.ndarray) -> bool:
    """Returns whether the sensors of all value sets are perfect: plants then return `here`."""
    each = np.broadcast_to(here, (len(here), len(rows), *here.shape[2:]))
    return np.may_share_memory(predictor.said(rows, each), here)


def _indices(predictor: Predictor) -> list[list[int]]:
    """Returns tangent-state indices of each sensor's reading, and its joint's position and rate."""
    model, sensors = predictor.plant.model, predictor.log.output_names
    read = [tangent_index(model, *at) for at in output_columns(model, sensors)]
    dofs = [int(model.jnt_dofadr[model.sensor(name).objid[0]]) for name in sensors]
    return [read, dofs, [model.nv + dof for dof in dofs]]
