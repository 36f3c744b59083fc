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

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

import mujoco
import numpy as np

from identification.kalman.linear import Linearisation, tangent_index
from identification.kalman.trajectory import average_inputs
from identification.linear.points import Change, Points
from identification.model.numbers import each_with_numbers
from identification.model.predictor import Predictor, output_columns
from identification.model.protocol import with_states
from identification.model.rollout import hold, substeps

SHIFT = 1e-3  # of states that no output feels, to see whether a candidate reads them
_NO_TIME = ((0, 1), (0, 0), (0, 0), (0, 0))  # the time of a reading does not change
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
) -> np.ndarray:
    """The change of all outputs per unit of some changes of the parameters.

    Args:
        predictor: plant and log, with p parameters.
        records: the linearisation of each record at `values`.
        values: shape (p,), in the parameters' units.
        changed: values of the parameters after each of m changes, shape (m, p).
        change: the size of each change, shape (m,).

    Returns:
        Shape (N, ny, m); NaN in the columns of changes that the equations do not describe.

    Raises:
        DivergenceError: accelerations along the trajectory are not finite.
    """
    rows = np.vstack([values, changed])
    each = [
        _of_record(record, linear, rows[:, columns], change)
        for (record, columns), linear in zip(predictor.records(), records, strict=True)
    ]
    return np.concatenate(each)


def _of_record(
    predictor: Predictor, linear: Linearisation, rows: np.ndarray, change: np.ndarray
) -> np.ndarray:
    """The sensitivities of one record; of columns that are zero in it nothing is computed."""
    out = np.zeros((*predictor.log.outputs.shape, len(change)))
    moved = np.flatnonzero((rows[1:] != rows[0]).any(axis=1))
    if moved.size:
        rows, change = rows[[0, *(1 + moved)]], change[moved]
        g, known = _forcing(predictor, linear, rows, change)
        x = _respond(linear, _first(predictor, linear, rows, change), g)
        out[..., moved] = _outputs(predictor, linear, rows, change, x)
        out[..., moved[~known]] = np.nan
    return out


def _forcing(
    predictor: Predictor, linear: Linearisation, rows: np.ndarray, change: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """∂f/∂θ of each change, shape (L, nx, m), and whether that is all of it, shape (m,)."""
    along, log, model = linear.along, predictor.log, predictor.plant.model
    felt = linear.felt[model.nv :]
    every = substeps(log.sampling_time, model.opt.timestep)
    numbers = predictor.settings(rows)[1]
    sent = predictor.inputs(rows)(hold(log.inputs, every, log.hold))
    inputs = average_inputs(sent, along.steps, model.nu)
    others = range(1, 1 + len(change))

    def changes(**fields: np.ndarray) -> Iterator[Change]:
        models = each_with_numbers(along.model, numbers, 0, others)
        return (Change(fields, *own) for own in models)

    def with_inputs() -> Iterator[Change]:
        for row, own in zip(others, changes(), strict=True):
            is_moved = len(inputs) > 1 and not np.array_equal(inputs[row], inputs[0])
            yield replace(own, fields={"ctrl": inputs[row]}) if is_moved else own

    points = Points(along)
    f = points.rates()[:, felt]
    g = np.empty((len(linear.A), f.shape[1], len(change)))
    for j, (moved, size) in enumerate(zip(points.each(with_inputs()), change, strict=True)):
        g[..., j] = along.average((moved[:, felt] - f) / size)
    if felt.all():
        return g, np.ones(len(change), bool)
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


def _first(
    predictor: Predictor, linear: Linearisation, rows: np.ndarray, change: np.ndarray
) -> np.ndarray:
    """∂x₀/∂θ of each change, shape (nx, m)."""
    start = predictor.settings(rows)[0]
    model = linear.along.model
    n = len(change)
    first = [np.broadcast_to(x, (n + 1, np.shape(x)[-1])) for x in
             (start.qpos, start.qvel, start.act)]  # fmt: skip
    δ = np.zeros((n, 2 * model.nv + model.na))
    for row, qpos in zip(δ[:, : model.nv], first[0][1:], strict=True):
        mujoco.mj_differentiatePos(model, row, 1.0, first[0][0], qpos)
    δ[:, model.nv :] = np.hstack([x[1:] - x[0] for x in first[1:]])
    return (δ / change[:, None]).T[linear.felt]


def _respond(linear: Linearisation, first: np.ndarray, g: np.ndarray) -> np.ndarray:
    """δx at the samples, shape (N, nx, m), of velocities and activations that are forced by g."""
    parts, forced = linear.along.intervals, linear.Γ @ g
    x = np.empty((len(forced) // parts + 1, *first.shape))
    x[0] = now = first
    for k, (A, b) in enumerate(zip(linear.A, forced, strict=True)):
        now = A @ now + b
        if (k + 1) % parts == 0:
            x[(k + 1) // parts] = now
    return x


def _outputs(
    predictor: Predictor,
    linear: Linearisation,
    rows: np.ndarray,
    change: np.ndarray,
    x: np.ndarray,
) -> np.ndarray:
    """The change of what the sensors say, shape (N, ny, m)."""
    here = predictor.readings({field: each[None] for field, each in linear.along.states.items()})
    δx = np.zeros((*x.shape[::2], len(linear.felt)))
    δx[..., linear.felt] = np.moveaxis(x, 1, 2)
    δ = np.stack([np.stack([δx[..., i] for i in of], axis=-1) for of in _indices(predictor)])
    there = here + np.pad(np.swapaxes(δ, 1, 2), _NO_TIME) * change[:, None, None]
    said = predictor.said(rows[1:], there) - predictor.said(rows[:1], here)
    return np.moveaxis(said / change[:, None, None], 0, -1)


def _indices(predictor: Predictor) -> list[list[int]]:
    """Indices in the tangent state: of each sensor's reading, its joint's position and its rate."""
    model, sensors = predictor.plant.model, predictor.log.output_names
    own = [tangent_index(model, *at) for at in output_columns(model, sensors)]
    dofs = [int(model.jnt_dofadr[model.sensor(name).objid[0]]) for name in sensors]
    return [own, dofs, [model.nv + dof for dof in dofs]]
