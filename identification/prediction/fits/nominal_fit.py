"""The fit of a model without effects, over windows of several records.

Windows of a quarter, a half and the whole horizon; each fit begins where the last one ended. The
errors count in units of their own rms s, so that fits are repeated until it is settled. Where the
model is right, all weights lead to the same values but for their std, and s hardly changes. Where
something is missing, weights may run away: each fit follows one output more closely at the price of
another one, whose weight then falls further. So the first fit stays where an output would be given
up in a later one:

    s_jk > 1.25 s_j1        s_jk: rms error of output j in fit k
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from identification.discovery.nominal_model import NominalModel
from identification.errors import InputError
from identification.estimation.priors import Priors
from identification.estimation.search import ROUGH_TOLERANCE
from identification.model.coordinates import coordinates
from identification.prediction.fits.model import WindowModel, predict_fitted, rms_error
from identification.runtime.progress import Progress
from identification.windows.fit import WindowFit, solve
from identification.windows.problem import (
    ROUGH_STEPS,
    no_moves,
    problem,
    with_longer_steps,
    with_scale,
)
from identification.windows.records import Record
from identification.windows.unknowns import Unknowns
from identification.windows.unseen import Unseen

HORIZON_GROWTH = (0.25, 0.5, 1.0)  # of the horizon
MIN_WINDOW_SAMPLES = 4  # of the shortest windows
SETTLED_CHANGE = 0.05  # relative change of the errors' scale below which it is settled
MAX_SCALE_FITS = 6  # until it is settled
# Of an output's error over that of the first fit, beyond which weights run away. In 72 worlds of
# small robots from which something was missing (`benchmarks/robot_worlds.py`) one had more.
MAX_RISE = 1.25


def fit_nominal(
    nominal_model: NominalModel, records: Sequence[Record], progress: Progress | None = None
) -> WindowModel:
    """Fit a model without effects to some records, and predict the others; see `fit_alone`."""
    found, scale = fit_alone(nominal_model, records, progress)
    return predicted(found, scale, records, float(nominal_model.horizon or 0.0))


def predicted(
    found: WindowFit, scale: np.ndarray, records: Sequence[Record], horizon: float
) -> WindowModel:
    """Returns the model of a fit without effects, with its errors on the records that confirm.

    Args:
        found: the fit.
        scale: s of each output, shape (ny,), in its unit.
        records: to fit and to confirm.
        horizon: [s].
    """
    confirm = [r for r in records if r.role == "confirm"]
    plant = found.problem.plant
    seen = predict_fitted(plant, confirm, horizon, scale, found, {})
    return WindowModel((), found, seen, scale)


def fit_alone(
    nominal_model: NominalModel, records: Sequence[Record], progress: Progress | None = None
) -> tuple[WindowFit, np.ndarray]:
    """Fit a model without effects, over windows that grow to its horizon.

    The scale of the errors, against which priors count, is that of the fit itself: fits are
    repeated until it is settled.

    Args:
        nominal_model: the model; its plant's own values are where the search begins, and the
            priors' means where it says no other.
        records: of which those to fit are fitted.
        progress: is told one line per linearisation.

    Returns:
        The fit, and s of each output, shape (ny,), in its unit.

    Raises:
        InputError: there is no horizon, windows do not fit a record, or a start lies on a bound.
        DivergenceError: the start cannot be simulated.
    """
    plant, horizon = nominal_model.plant, nominal_model.horizon
    if horizon is None:
        raise InputError("windows need a horizon; give one in seconds")
    shared, own = _priors(nominal_model)
    fitted = [r for r in records if r.role == "fit"]
    scale = _scale_of_change(fitted)
    values: dict[str, float] = {}
    found: WindowFit | None = None
    for factor in HORIZON_GROWTH:
        length = factor * horizon
        if any(length < MIN_WINDOW_SAMPLES * r.log.sampling_time for r in fitted) and factor < 1:
            continue
        task = problem(plant, fitted, shared, own, length, values, scale, ROUGH_STEPS)
        q = begin(nominal_model, task.unknowns) if found is None else found.q
        moves, _ = task.settled(q, no_moves(task))
        if factor == 1.0:
            task = with_longer_steps(task, q, moves, is_for_slopes=True)
        found = solve(
            task, q, moves, tolerance=ROUGH_TOLERANCE, progress=_of(length, horizon, 0, progress)
        )
        _refuse_idle(found)
        values, scale = found.shared, rms_error(found)
    if found is None:
        raise InputError(f"windows of {horizon:g} s fit no record; choose another horizon")
    task, q = problem(plant, fitted, shared, own, horizon, values, scale), found.q
    moves, _ = task.settled(q, no_moves(task))
    task = with_longer_steps(task, q, moves)
    first: tuple[WindowFit, np.ndarray, np.ndarray] | None = None
    for k in range(MAX_SCALE_FITS):
        task, old = with_scale(task, scale), scale
        found = solve(task, q, moves, progress=_of(horizon, horizon, k + 1, progress))
        q, moves, scale = found.q, found.moves, rms_error(found)
        first = first or (found, old, scale)
        if np.any(scale > MAX_RISE * first[2]):
            return first[:2]
        if np.all(np.abs(np.log(scale / old)) < SETTLED_CHANGE):
            break
    return found, old


def _of(length: float, horizon: float, scale: int, progress: Progress | None) -> Progress | None:
    """Returns a progress that says how far a fit is, and its error over the horizon.

    Errors over windows of other lengths do not compare with it, and are not told.

    Args:
        length: of the windows [s].
        horizon: that of the fit [s].
        scale: which fit over the horizon it is; 0 for the first.
        progress: is told.
    """
    if progress is None:
        return None
    tell, which = progress, f", fit {scale + 1}" if scale else ""
    if length < horizon:
        grow = f"windows of {length:.3g} s, which grow to {horizon:.3g} s"
        return lambda line: tell(f"{grow}: {line.rpartition(', ')[2]}")
    return lambda line: tell(f"windows of {length:.3g} s{which}: {line}")


def as_begun(nominal_model: NominalModel, fitted: WindowModel, unseen: Unseen) -> WindowModel:
    """Returns the model at the values with which its fit began, on the windows of the fit.

    Args:
        nominal_model: says these values.
        fitted: the model after the fit.
        unseen: errors of these values on the records that confirm.
    """
    task = fitted.fit.problem
    q = begin(nominal_model, task.unknowns)
    moves, r = task.settled(q, fitted.fit.moves, is_thorough=True)
    fit = replace(
        fitted.fit, q=q, moves=moves, tangents=task.tangents(q, moves, r), cost=task.cost_of(q, r),
        steps=0,
    )  # fmt: skip
    return replace(fitted, fit=fit, unseen=unseen)


def begin(nominal_model: NominalModel, unknowns: Unknowns) -> np.ndarray:
    """Returns the start of the search, (p,), in coordinates: the plant's values, or a record's own.

    Args:
        nominal_model: says both.
        unknowns: the free parameters, those of each record too.
    """
    values, of = nominal_model.plant.parameters.values(), nominal_model.own_values
    first = [values[n] for n in unknowns.shared.names]
    for r in unknowns.records:  # a part of a log, NAME [PART], begins where the log does
        own = {**of.get(r.partition(" [")[0], {}), **of.get(r, {})}
        first += [own.get(n, values[n]) for n in unknowns.own.names]
    return np.asarray(unknowns.all.space.encode(np.array(first)))


def _priors(nominal_model: NominalModel) -> tuple[Priors, Priors]:
    """Returns the priors of a nominal model's free parameters: shared ones, and own ones."""
    plant, names, own = nominal_model.plant, nominal_model.names, nominal_model.own
    values = plant.parameters.values()
    first = np.array([values[n] for n in names])
    space = coordinates(plant.parameters, names, first, linear=nominal_model.linear)
    mean = np.array([nominal_model.mean.get(n, values[n]) for n in names])
    prior = Priors(space, space.encode(mean), 1 / np.asarray(nominal_model.std, float))
    return prior.only([n for n in names if n not in own]), prior.only(own)


def _refuse_idle(found: WindowFit) -> None:
    """Refuse parameters that no output of any window feels.

    Raises:
        InputError: there is one.
    """
    felt = sum(np.sum(t.S**2, axis=(0, 1)) for t in found.tangents)
    idle = [n for n, square in zip(found.problem.names, np.atleast_1d(felt), strict=True)
            if square == 0]  # fmt: skip
    if idle:
        raise InputError(
            f"{', '.join(idle)} ha{'s' if len(idle) == 1 else 've'} no effect on any window of the"
            " records, where each window begins at a state of its own; leave it fixed, or check"
            " where it goes in the model"
        )


def _scale_of_change(records: Sequence[Record]) -> np.ndarray:
    """Returns the rms change of each output between samples, (ny,): a scale before any fit."""
    return np.sqrt(
        np.mean([np.mean(np.diff(r.log.outputs, axis=0) ** 2, axis=0) for r in records], axis=0)
    )
