"""A model with some effects, fitted to the windows of several records and judged on others.

nominal model:     windows of a quarter, a half and the whole horizon; each fit begins where the
                   last one ended
with an effect:    the fit begins at its parent, with the size that the score gives or the part of
                   it that is best; size zero is its parent, so that a child never explains less
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from identification.discovery.nominal_model import NominalModel
from identification.effects.effect import Candidate
from identification.errors import InputError
from identification.logs.noise import noise_floor
from identification.model.coordinates import Coordinates, coordinates
from identification.model.parameter import ParameterSet
from identification.model.predictor import Plant
from identification.prediction.fit import WindowFit, solve
from identification.prediction.problem import moves_from, no_moves, problem, with_space
from identification.prediction.records import Record
from identification.prediction.scores import WindowScore, inside
from identification.prediction.unseen import Unseen, predict

GROWTH = (0.25, 0.5, 1.0)  # of the horizon
ROUGH = 1e-2  # relative fall of the criterion that ends a fit which another follows
FEWEST = 4  # samples of the shortest windows
SHARES = (1.0, 0.5, 0.2, 0.05, 0.01)  # of the size that a score gives, to begin with
SHAPE_STD = 1.0  # prior of a shape's coordinate about the value that scored best
SMALL = 1e-3  # of a probe: where the search for a size begins that must not be zero

Progress = Callable[[str], None]


@dataclass(frozen=True, kw_only=True)
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
    def values(self) -> dict[str, float]:
        """Values of all parameters that are not the plant's own, by name."""
        fixed = {n: v for c in self.candidates for n, v in (*c.fixed.items(), *c.whole.items())}
        return {**fixed, **self.fit.values}

    @property
    def std(self) -> dict[str, float]:
        """Std of the free values by blocks of windows, by name, in their units."""
        return dict(zip(self.fit.problem.names, self.fit.std.tolist(), strict=True))


def fit_nominal(
    plant: Plant,
    names: Sequence[str],
    std: np.ndarray,
    horizon: float,
    records: Sequence[Record],
    progress: Progress | None = None,
) -> WindowModel:
    """Fit a model without effects, over windows that grow to the horizon.

    Args:
        plant: the model; its own values are where the search begins, and the priors' means.
        names: the free parameters.
        std: prior std of each, relative where it is logarithmic, shape (p,).
        horizon: [s].
        records: to fit and to confirm.
        progress: is told one line per linearisation.

    Raises:
        InputError: windows do not fit a record, or a start lies on a bound.
        DivergenceError: the start cannot be simulated.
    """
    fitted = [r for r in records if r.role == "fit"]
    own = plant.parameters.values()
    first = np.array([own[n] for n in names])
    space = coordinates(plant.parameters, names, first)
    q = mean = space.encode(first)
    weight = 1 / np.asarray(std, float)
    scale = _scale_of_change(fitted)
    values: dict[str, float] = dict(zip(names, first, strict=True))
    found: WindowFit | None = None
    for factor in GROWTH:
        length = factor * horizon
        if any(length < FEWEST * r.log.sampling_time for r in fitted) and factor < 1:
            continue
        task = problem(plant, fitted, space, length, values, mean, weight, scale)
        found = solve(task, q, no_moves(task), tolerance=ROUGH, progress=progress)
        _refuse_idle(found)
        q, values = found.q, found.values
        scale = _rms(found)
    if found is None:
        raise InputError(f"windows of {horizon:g} s fit no record; choose another horizon")
    task = problem(plant, fitted, space, horizon, values, mean, weight, scale)
    found = solve(task, q, moves_from(task, found.states), progress=progress)
    confirm = [r for r in records if r.role == "confirm"]
    return WindowModel(
        candidates=(), fit=found, unseen=predict(plant, confirm, horizon, scale, found.values),
        scale=scale,
    )  # fmt: skip


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
    c, fit = score.candidate, parent.fit
    plant = fit.problem.parts[0].predictor.plant
    free = [*c.free, *_shapes(c)]
    names = (*fit.problem.names, *(n for n in free if n not in fit.problem.names))
    fixed = {n: v for n, v in (*c.fixed.items(), *c.whole.items()) if n not in names}
    sizes = dict(zip(c.sizes, score.size, strict=True))
    own = {**plant.parameters.values(), **fit.values, **c.fixed}
    begun = []
    for share in SHARES:
        start = {**own, **{n: _away(plant.parameters, n, share * sizes[n]) for n in c.free}}
        first = inside(plant.parameters, names, np.array([start[n] for n in names]))
        space = coordinates(plant.parameters, names, first, linear=c.sizes)
        more = len(names) - len(fit.q)
        prior = np.array([0.0 if n in c.sizes else 1 / SHAPE_STD for n in names[len(fit.q) :]])
        q = space.encode(first)
        q[: len(fit.q)] = fit.q
        mean = np.concatenate([fit.problem.mean, q[len(fit.q) :]]) if more else fit.problem.mean
        weight = np.concatenate([fit.problem.weight, prior])
        task = with_space(fit.problem, _bounded(space, fit), fixed, mean, weight)
        try:
            cost = task.cost(q, fit.moves)
        except InputError:
            continue
        begun.append((cost, task, q))
        if cost < fit.cost or not c.free:
            break
    if not begun:
        raise InputError(f"{c.effect.name}, {c.where} cannot be simulated at any size")
    _, task, q = min(begun, key=lambda b: b[0])
    found = solve(task, q, fit.moves)
    if found.cost >= fit.cost:
        return None
    values = {n: v for o in parent.candidates for n, v in (*o.fixed.items(), *o.whole.items())}
    values |= {**fixed, **found.values}
    seen = predict(plant, confirm, horizon, parent.scale, values, parent.unseen)
    return WindowModel(
        candidates=(*parent.candidates, c), fit=found, unseen=seen, scale=parent.scale
    )


def refitted(
    model: WindowModel,
    candidates: Sequence[Candidate],
    nominal_model: NominalModel,
    horizon: float,
    confirm: Sequence[Record],
) -> WindowModel | None:
    """A model with fewer effects, refitted from where it is; None where it cannot be simulated.

    Args:
        model: with more effects.
        candidates: those that it keeps.
        nominal_model: its other free parameters.
        horizon: [s].
        confirm: records that no fit may see.
    """
    fit, keep = model.fit, [*nominal_model.names]
    for c in candidates:
        keep += [n for n in (*c.free, *_shapes(c)) if n not in keep]
    at = [fit.problem.names.index(n) for n in keep]
    old = fit.problem.space
    put = {f: getattr(old, f)[at] for f in ("logarithmic", "lower", "upper", "scale")}
    values = {n: v for c in candidates for n, v in (*c.fixed.items(), *c.whole.items())}
    absent = {
        n: 0.0 for c in model.candidates for n in c.sizes if n not in values and n not in keep
    }
    fixed = {**absent, **values}
    task = with_space(
        fit.problem, Coordinates(tuple(keep), **put), fixed, fit.problem.mean[at],
        fit.problem.weight[at],
    )  # fmt: skip
    plant = fit.problem.parts[0].predictor.plant
    try:
        found = solve(task, fit.q[at], fit.moves)
        own = {**fixed, **found.values}
        seen = predict(plant, confirm, horizon, model.scale, own, model.unseen)
    except InputError:
        return None
    return WindowModel(candidates=tuple(candidates), fit=found, unseen=seen, scale=model.scale)


def _shapes(c: Candidate) -> list[str]:
    """The plant's parameters of an effect's free shapes."""
    return [c.effect.parameter(s.name, c.where) for s in c.effect.shapes if s.free]


def _bounded(space: Coordinates, fit: WindowFit) -> Coordinates:
    """Coordinates that keep those of the parent, bounds included."""
    p, old = len(fit.q), fit.problem.space
    put = {
        field: np.concatenate([getattr(old, field), getattr(space, field)[p:]])
        for field in ("logarithmic", "lower", "upper", "scale")
    }
    return Coordinates(space.names, **put)


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
