"""A model with one effect more, or with fewer, refitted from where it is.

Size zero is the parent, so that a child never explains less.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from identification.discovery.attempts import attempt, refuse_infinite
from identification.discovery.nominal_model import NominalModel
from identification.discovery.options import DiscoveryOptions
from identification.discovery.passes import uses
from identification.effects.effect import Candidate
from identification.effects.plant.jointed import JointPlant
from identification.model.predictor import Plant
from identification.model.protocol import FINER
from identification.prediction.fits.model import WindowModel, held_values, predict_fitted, rms_error
from identification.prediction.fits.nominal_fit import MAX_SCALE_FITS, SETTLED_CHANGE
from identification.prediction.scoring.first_fit import (
    MAX_LINEARISATIONS,
    REFIT_TOLERANCE,
    Begun,
    shapes_of,
)
from identification.windows.coarse import steps_of
from identification.windows.fit import solve
from identification.windows.problem import (
    Problem,
    with_longer_steps,
    with_own_steps,
    with_scale,
    with_unknowns,
)
from identification.windows.records import Record
from identification.windows.unseen import HORIZON

# Of logarithms: outputs whose errors have fallen by factors that differ by less keep their weights.
UNLIKE_FALLS = 0.5


def with_effect(
    parent: WindowModel, begun: Begun, horizon: float, confirm: Sequence[Record]
) -> WindowModel | None:
    """Returns the model refitted with one effect more; None where it explains no more.

    Of unseen records it predicts the horizon alone (see `identification.windows.unseen`).

    Args:
        parent: the model without it.
        begun: the effect fitted to some of the windows.
        horizon: [s].
        confirm: records that no fit may see.

    Raises:
        InputError: it cannot be simulated on all windows.
    """
    fit = begun.parent.fit
    moves, r = begun.task.settled(begun.q, fit.moves, fit.tangents, is_thorough=True)
    found = solve(
        begun.task, begun.q, moves, tolerance=REFIT_TOLERANCE, most=MAX_LINEARISATIONS, known=r
    )
    if not found.cost < parent.fit.cost:
        return None
    fixed, plant = {**parent.held, **begun.fixed}, begun.parent.plant
    seen = predict_fitted(plant, confirm, horizon, parent.scale, found, fixed, parent.unseen,
                          lengths=HORIZON)  # fmt: skip
    return WindowModel((*parent.candidates, begun.candidate), found, seen, parent.scale)


def at_values_of(parent: WindowModel, child: WindowModel) -> WindowModel:
    """Returns a model at the values that it has in another one, without a fit of these.

    Its windows begin at the states that are best there. Where an effect is missing, a fit moves
    other values to make up for it, and what a score says about these is far from the truth. Those
    of a model in which something acts as the effect does are near it.

    Args:
        parent: the model, which says what is fitted.
        child: the same model with effects more.

    Raises:
        DivergenceError: the parent cannot be simulated there.
    """
    task, at = parent.fit.problem, dict(zip(child.fit.problem.names, child.fit.q, strict=True))
    q = np.array([at[name] for name in task.names])
    pairs = zip(child.fit.moves, parent.fit.moves, strict=True)
    begun = [new[:, : old.shape[1]] for new, old in pairs]  # states of joints stand last
    moves, r = task.settled(q, begun, parent.fit.tangents)
    return replace(parent, fit=solve(task, q, moves, most=1, known=r))


def with_fitting_steps(
    model: WindowModel, horizon: float, confirm: Sequence[Record]
) -> WindowModel:
    """Returns the model refitted with steps of simulations that its own error allows.

    Steps that err by little beside what a parent leaves may err by much beside what its child does.
    A model whose steps are short enough stays as it is.

    Args:
        model: with effects that its steps were not chosen for.
        horizon: [s].
        confirm: records that no fit may see.

    Raises:
        DivergenceError: it cannot be simulated with other steps.
    """
    if _steps(model.plant) <= 1:
        return model
    fit = model.fit
    task = with_longer_steps(fit.problem, fit.q, fit.moves)
    if _steps(task.plant) >= _steps(model.plant):
        return model
    return _refitted(model, task, horizon, confirm)


def with_finer_steps(
    model: WindowModel, horizon: float, confirm: Sequence[Record]
) -> WindowModel | None:
    """Returns the model refitted with finer steps: the user's own, or else a quarter of these.

    Args:
        model: fitted.
        horizon: [s].
        confirm: records that no fit may see.

    Returns:
        None where its steps are as fine already, or cannot be changed.

    Raises:
        DivergenceError: it cannot be simulated with these steps.
    """
    problem, plant = model.fit.problem, model.plant
    taken, models = steps_of(plant)  # where joints have states, no longer ones are taken
    if not isinstance(plant, JointPlant) or taken < models:
        return None
    own = replace(plant, steps=1 if taken > models else 1 / FINER, slope_steps=1)
    parts = (replace(p, predictor=replace(p.predictor, plant=own)) for p in problem.parts)
    return _refitted(model, replace(problem, parts=tuple(parts)), horizon, confirm)


def as_last_fit(
    model: WindowModel, horizon: float, confirm: Sequence[Record], is_weighed: bool = True
) -> WindowModel:
    """Returns the model refitted as the last fit of a search.

    It takes the steps of the user's model. Longer ones err by a share of what is left, and in the
    same direction in every window: beside the std of many windows that is much.

    Args:
        model: fitted.
        horizon: [s].
        confirm: records that no fit may see.
        is_weighed: whether outputs and priors weigh by its own errors (`with_own_weights`).

    Raises:
        DivergenceError: it cannot be simulated with the steps of the user's model.
    """
    task = with_own_steps(model.fit.problem)
    return _weighed(model, task, horizon, confirm, MAX_SCALE_FITS if is_weighed else 0)


def with_own_weights(model: WindowModel, horizon: float, confirm: Sequence[Record]) -> WindowModel:
    """Returns the model refitted with outputs and priors that weigh by its own errors.

    Errors count in the scale of the nominal model's, so that models can be compared. Where an
    effect has taken most of them away, priors would outweigh the data, pull values to their means,
    and make the std of all values too large; and an output whose error has fallen to its noise
    would tell less than it can. A model whose outputs' errors have fallen alike stays as it is: its
    priors weigh in the last fit.

    Args:
        model: with an effect more than when its outputs were weighed.
        horizon: [s].
        confirm: records that no fit may see.

    Raises:
        DivergenceError: it cannot be simulated.
    """
    fallen = rms_error(model.fit) * np.diag(model.fit.problem.parts[0].whitener)
    if not np.ptp(np.log(np.minimum(1.0, fallen))) > UNLIKE_FALLS:
        return model
    return _weighed(model, model.fit.problem, horizon, confirm, 1)


def weighed(
    model: WindowModel, horizon: float, confirm: Sequence[Record], options: DiscoveryOptions
) -> WindowModel:
    """Returns the model with its own weights where options ask for them and it can be simulated.

    Two effects that act alike would else differ by what the old weights hardly ask of an output.

    Args:
        model: with an effect more than when its outputs were weighed.
        horizon: [s].
        confirm: records that no fit may see.
        options: the pass `own_weights`.
    """
    if not uses(options, "own_weights"):
        return model
    return attempt(None, partial(with_own_weights, model, horizon, confirm)) or model


def _weighed(
    model: WindowModel, task: Problem, horizon: float, confirm: Sequence[Record], most: int
) -> WindowModel:
    """Returns the model refitted to a task, whose weights follow its errors in `most` fits."""
    for k in range(max(1, most)):
        old = 1 / np.diag(task.parts[0].whitener)
        scale = np.minimum(rms_error(model.fit), old)
        if k < most and np.any(scale < (1 - SETTLED_CHANGE) * old):
            task = with_scale(task, scale)
        if task is model.fit.problem:
            break
        model = _refitted(model, task, horizon, confirm)
        task = model.fit.problem
    return model


def _refitted(
    model: WindowModel, task: Problem, horizon: float, confirm: Sequence[Record]
) -> WindowModel:
    """Returns the model refitted from where it is, with the simulations of another task."""
    found = solve(
        task, model.fit.q, model.fit.moves, tolerance=REFIT_TOLERANCE, most=MAX_LINEARISATIONS
    )
    seen = predict_fitted(
        task.plant, confirm, horizon, model.scale, found, model.held, model.unseen
    )  # fmt: skip
    return replace(model, fit=found, unseen=seen)


def _steps(plant: Plant) -> float:
    """Returns how many steps of the user's model are one step of a simulation."""
    return plant.steps if isinstance(plant, JointPlant) else 1


def refitted(
    model: WindowModel,
    candidates: Sequence[Candidate],
    nominal_model: NominalModel,
    confirm: Sequence[Record],
) -> WindowModel | None:
    """Returns a model with fewer effects, refitted; None where it cannot be simulated.

    Args:
        model: with more effects.
        candidates: those that it keeps.
        nominal_model: its other free parameters, and the horizon.
        confirm: records that no fit may see.
    """
    fit, old = model.fit, model.fit.problem.unknowns
    keep = {*nominal_model.names, *(n for c in candidates for n in (*c.free, *shapes_of(c)))}
    values = held_values(candidates)
    absent = {
        n: 0.0 for c in model.candidates for n in c.sizes if n not in values and n not in keep
    }
    fixed = {**absent, **values}
    task = with_unknowns(fit.problem, old.shared.only([*keep]), old.own.only([*keep]), fixed)
    q = np.array([fit.q[fit.problem.names.index(n)] for n in task.names])
    horizon = float(nominal_model.horizon or 0.0)

    def evaluate() -> WindowModel:
        found = solve(task, q, fit.moves)
        seen = predict_fitted(
            model.plant, confirm, horizon, model.scale, found, fixed, model.unseen
        )
        refuse_infinite(found.cost, *seen.at_horizon)
        return WindowModel(tuple(candidates), found, seen, model.scale)

    return attempt(None, evaluate)
