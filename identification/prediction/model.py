"""A model with some effects, fitted to the windows of several records and judged on others.

nominal model:     windows of a quarter, a half and the whole horizon; each fit begins where the
                   last one ended
with an effect:    the fit begins at its parent, with the size that the score gives or the part of
                   it that is best, and the states that then are best; size zero is its parent, so
                   that a child never explains less
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from identification.discovery.nominal_model import NominalModel
from identification.effects.effect import Candidate
from identification.errors import InputError
from identification.logs.noise import noise_floor
from identification.model.coordinates import coordinates
from identification.model.parameter import ParameterSet
from identification.model.predictor import Plant
from identification.prediction.fit import ROUGH, WindowFit, solve
from identification.prediction.problem import (
    MOST_STEPS,
    Problem,
    no_moves,
    problem,
    with_scale,
    with_unknowns,
)
from identification.prediction.records import Record
from identification.prediction.scores import WindowScore, inside
from identification.prediction.unknowns import Prior
from identification.prediction.unseen import Own, Unseen, predict

GROWTH = (0.25, 0.5, 1.0)  # of the horizon
FEWEST = 4  # samples of the shortest windows
ROUGH_STEPS = MOST_STEPS // 3  # of the fits that only find where the last one begins
SAME = 0.05  # relative change of the errors' scale below which it is settled
MOST_SCALES = 6  # fits at most until it is
SHARES = (1.0, 0.3, 0.05, 0.01)  # of the size that a score gives, to begin with
FINE = 1e-3  # relative fall of the criterion at which the refit of an effect ends
MOST_REFIT = 12  # its linearisations; an effect that takes more is not what is missing
SHAPE_STD = 1.0  # prior of a shape's coordinate about the value that scored best
SMALL = 1e-3  # of a probe: where the search for a size begins that must not be zero

Progress = Callable[[str], None]


@dataclass(frozen=True)
class WindowModel:
    """A model with some effects.

    Attributes:
        candidates: the effects, with their shapes as they began.
        fit: on the windows of the fitted records.
        unseen: its errors on the records that confirm.
        scale: rms error of each output under the nominal model, shape (ny,), in its unit.
    """

    candidates: tuple[Candidate, ...]
    fit: WindowFit
    unseen: Unseen
    scale: np.ndarray

    @property
    def plant(self) -> Plant:
        """The plant with its own values."""
        return self.fit.problem.parts[0].predictor.plant

    @property
    def values(self) -> dict[str, float]:
        """Values of all parameters that are not the plant's own and hold for all records."""
        fixed = {n: v for c in self.candidates for n, v in (*c.fixed.items(), *c.whole.items())}
        return {**fixed, **self.fit.shared}

    @property
    def std(self) -> dict[str, float]:
        """Std of the free values by blocks of windows, by name, in their units."""
        return dict(zip(self.fit.problem.names, self.fit.std.tolist(), strict=True))


def fit_nominal(
    nominal_model: NominalModel, records: Sequence[Record], progress: Progress | None = None
) -> WindowModel:
    """Fit a model without effects, over windows that grow to its horizon.

    The scale of the errors, against which priors count, is that of the fit itself: fits are
    repeated until it is settled.

    Args:
        nominal_model: the model; its plant's own values are where the search begins, and the
            priors' means.
        records: to fit and to confirm.
        progress: is told one line per linearisation.

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
    for factor in GROWTH:
        length = factor * horizon
        if any(length < FEWEST * r.log.sampling_time for r in fitted) and factor < 1:
            continue
        task = problem(plant, fitted, shared, own, length, values, scale, ROUGH_STEPS)
        q = task.prior.mean if found is None else found.q
        found = solve(task, q, task.settled(q, no_moves(task)), tolerance=ROUGH, progress=progress)
        _refuse_idle(found)
        values, scale = found.shared, _rms(found)
    if found is None:
        raise InputError(f"windows of {horizon:g} s fit no record; choose another horizon")
    task, q = problem(plant, fitted, shared, own, horizon, values, scale), found.q
    moves = task.settled(q, no_moves(task))
    for _ in range(MOST_SCALES):
        task, old = with_scale(task, scale), scale
        found = solve(task, q, moves, progress=progress)
        q, moves = found.q, found.moves
        scale = _rms(found)
        if np.all(np.abs(np.log(scale / old)) < SAME):
            break
    confirm = [r for r in records if r.role == "confirm"]
    return WindowModel((), found, predict_fitted(plant, confirm, horizon, old, found, {}), old)


def with_effect(
    parent: WindowModel, score: WindowScore, horizon: float, confirm: Sequence[Record]
) -> WindowModel | None:
    """The model with one effect more, refitted; None where it explains no more than its parent.

    Args:
        parent: the model without it.
        score: of the effect on the parent: where its size begins.
        horizon: [s].
        confirm: records that no fit may see.

    Raises:
        InputError: its start cannot be simulated, whatever the size.
    """
    c, fit, plant = score.candidate, parent.fit, parent.plant
    old = fit.problem.unknowns
    sizes = _free(plant, c, [n for n in c.free if n not in old.local.names])
    shapes = _free(plant, c, [n for n in _shapes(c) if n not in old.local.names])
    shared, own = old.shared.plus(shapes), old.own
    shared, own = (shared, own.plus(sizes)) if c.effect.own else (shared.plus(sizes), own)
    free = (*shared.names, *own.names)
    fixed = {n: v for n, v in (*c.fixed.items(), *c.whole.items()) if n not in free}
    task = with_unknowns(fit.problem, shared, own, fixed)
    begun = []
    for share in SHARES:
        q = _begin(task, parent, score, share)
        try:  # the states have made up for what was missing
            moves = task.settled(q, fit.moves)
            cost = task.cost(q, moves)
        except InputError:
            continue
        begun.append((cost, q, moves))
        if cost < fit.cost or not c.free:
            break
    if not begun:
        raise InputError(f"{c.effect.name}, {c.where} cannot be simulated at any size")
    _, q, moves = min(begun, key=lambda b: b[0])
    found = solve(task, q, moves, tolerance=FINE, most=MOST_REFIT)
    if found.cost >= fit.cost:
        return None
    values = {n: v for o in parent.candidates for n, v in (*o.fixed.items(), *o.whole.items())}
    seen = predict_fitted(
        plant, confirm, horizon, parent.scale, found, {**values, **fixed}, parent.unseen
    )
    return WindowModel((*parent.candidates, c), found, seen, parent.scale)


def refitted(
    model: WindowModel,
    candidates: Sequence[Candidate],
    nominal_model: NominalModel,
    confirm: Sequence[Record],
) -> WindowModel | None:
    """A model with fewer effects, refitted from where it is; None where it cannot be simulated.

    Args:
        model: with more effects.
        candidates: those that it keeps.
        nominal_model: its other free parameters, and the horizon.
        confirm: records that no fit may see.
    """
    fit, old = model.fit, model.fit.problem.unknowns
    keep = {*nominal_model.names, *(n for c in candidates for n in (*c.free, *_shapes(c)))}
    values = {n: v for c in candidates for n, v in (*c.fixed.items(), *c.whole.items())}
    absent = {
        n: 0.0 for c in model.candidates for n in c.sizes if n not in values and n not in keep
    }
    fixed = {**absent, **values}
    task = with_unknowns(fit.problem, old.shared.only([*keep]), old.own.only([*keep]), fixed)
    q = np.array([fit.q[fit.problem.names.index(n)] for n in task.names])
    horizon = float(nominal_model.horizon or 0.0)
    try:
        found = solve(task, q, fit.moves)
        seen = predict_fitted(
            model.plant, confirm, horizon, model.scale, found, fixed, model.unseen
        )
    except InputError:
        return None
    return WindowModel(tuple(candidates), found, seen, model.scale)


def _priors(nominal_model: NominalModel) -> tuple[Prior, Prior]:
    """What is known of the free parameters of a nominal model: shared ones, and own ones."""
    plant, names, own = nominal_model.plant, nominal_model.names, nominal_model.own
    values = plant.parameters.values()
    first = np.array([values[n] for n in names])
    space = coordinates(plant.parameters, names, first)
    prior = Prior(space, space.encode(first), 1 / np.asarray(nominal_model.std, float))
    return prior.only([n for n in names if n not in own]), prior.only(own)


def _free(plant: Plant, c: Candidate, names: Sequence[str]) -> Prior:
    """Parameters of an effect: of sizes nothing is known, shapes are near the grid's value."""
    if not names:
        return Prior()
    values = {**plant.parameters.values(), **c.fixed}
    start = [_away(plant.parameters, n, 0.0) if n in c.sizes else values[n] for n in names]
    first = inside(plant.parameters, names, np.array(start))
    space = coordinates(plant.parameters, names, first, linear=c.sizes)
    weight = np.array([0.0 if n in c.sizes else 1 / SHAPE_STD for n in names])
    return Prior(space, space.encode(first), weight)


def _begin(task: Problem, parent: WindowModel, score: WindowScore, share: float) -> np.ndarray:
    """Where a child's q begins: at its parent, with a share of the sizes that the score gives."""
    c, unknowns = score.candidate, task.unknowns
    q = np.array(task.prior.mean)
    old = dict(zip(parent.fit.problem.names, parent.fit.q, strict=True))
    sizes = score.size.reshape(-1, len(c.sizes)) * np.ones((len(unknowns.records), 1))
    parameters = parent.plant.parameters
    for k in range(len(unknowns.records)):
        for name, value in zip(c.sizes, sizes[k], strict=True):
            if name in unknowns.local.names:
                at = unknowns.columns(k)[unknowns.local.names.index(name)]
                q[at] = _away(parameters, name, share * value) / task.prior.space.scale[at]
    for k, name in enumerate(task.names):
        q[k] = old.get(name, q[k])
    return np.asarray(task.prior.space.inside(q))


def predict_fitted(
    plant: Plant, confirm: Sequence[Record], horizon: float, scale: np.ndarray, found: WindowFit,
    fixed: Mapping[str, float], near: Unseen | None = None,
) -> Unseen:  # fmt: skip
    """Errors on unseen records; of parameters that each has for itself, its own halves tell.

    Args:
        plant: the model.
        confirm: records that no fit has seen.
        horizon: [s].
        scale: s of each output, shape (ny,), in its unit.
        found: the fit of other records.
        fixed: values that are neither the plant's own nor fitted.
        near: errors of a model nearby, at whose states the windows' search begins.

    Raises:
        InputError: no window of the horizon fits a record.
        DivergenceError: the model cannot be simulated.
    """
    unknowns, values = found.problem.unknowns, {**fixed, **found.shared}
    m = len(unknowns.own.names)
    start = unknowns.own.mean
    if m:
        start = found.q[len(unknowns.shared.names) :].reshape(-1, m).mean(axis=0)
    own = Own(unknowns.own, start)
    return predict(plant, confirm, horizon, scale, values, near, own)


def _shapes(c: Candidate) -> list[str]:
    """The plant's parameters of an effect's free shapes."""
    return [c.effect.parameter(s.name, c.where) for s in c.effect.shapes if s.free]


def _away(parameters: ParameterSet, name: str, value: float) -> float:
    """A size that is not zero."""
    record = parameters[name]
    least = SMALL * record.scale
    return value if abs(value) > least else least * (1 if record.upper > 0 else -1)


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


def _rms(found: WindowFit) -> np.ndarray:
    """Rms error of each output over the windows, no less than the sensors' noise, (ny,)."""
    logs = [p.predictor.log for p in found.problem.parts]
    noise = np.mean([noise_floor(log.outputs) ** 2 for log in logs], axis=0)
    square = np.mean(np.concatenate([np.mean(e**2, axis=1) for e in found.errors]), axis=0)
    return np.sqrt(np.maximum(square, noise) + 1e-300)


def _scale_of_change(records: Sequence[Record]) -> np.ndarray:
    """Rms change of each output between samples: a scale before any model is known, (ny,)."""
    return np.sqrt(
        np.mean([np.mean(np.diff(r.log.outputs, axis=0) ** 2, axis=0) for r in records], axis=0)
    )
