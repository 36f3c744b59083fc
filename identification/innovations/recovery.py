"""The recovered force of an effect that was named for a free run, along the records of its log.

It is the force that the values with the effect have and those without it lack; see
`identification.discovery.forces.recovered_force`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import mujoco
import numpy as np

from identification.discovery.effect_results import Rival
from identification.discovery.forces.force_along import ForceAlong, Stretch, forces_along
from identification.discovery.forces.recovered_force import (
    RecoveredForce,
    Shown,
    compare_force,
    law_steps,
    moved_by,
    show_forces,
    show_readings,
)
from identification.effects.effect import Candidate
from identification.kalman.noise_model import build_whitener
from identification.kalman.refit import Refit
from identification.kalman.trajectory import COARSE_POINTS, Trajectory, average_inputs, follow
from identification.model.predictor import Predictor
from identification.model.protocol import with_numbers
from identification.model.rollout import hold, substeps, without_sensors
from identification.runtime.pool import one_blas_thread


def recover_force(
    fit: Refit,
    candidate: Candidate,
    rivals: Sequence[Rival] = (),
) -> RecoveredForce | None:
    """Returns the force of an effect, recovered from the fitted samples.

    Args:
        fit: with the effect.
        candidate: the effect.
        rivals: what else was fitted in its place.

    Returns:
        None where the effect makes no force, or forces that are no function of one quantity of
        each joint, as that of a cable on a platform.

    Raises:
        DivergenceError: the model cannot be simulated.
    """
    values = fit.point.values
    base = {**values, **dict.fromkeys(candidate.sizes, 0.0)}
    rivals = [r for r in rivals if r.values]
    point, space = fit.point, fit.point.space
    slope = space.slope(point.q)
    steps = law_steps(candidate, dict(zip(space.names, fit.std * slope, strict=True)))
    moved = [{**values, name: values[name] + step} for name, step in steps.items()]
    sets = [values, *moved, *({**r.values, **_absent(base, r.values)} for r in rivals)]
    with one_blas_thread():
        find = _of_readings if "reading" in candidate.effect.hooks else _of_forces
        shown = find(fit, candidate, values, base, sets)
        if shown is None or shown.is_mixed:
            return None
        c, std = _solve(fit, fit.point.log.outputs - shown.predicted, shown.response)
    covariance = fit.problem.covariance
    moved_so = moved_by(steps, space.names, covariance, slope)
    return compare_force(candidate, shown, c, std, moved_so, [r.candidate for r in rivals])


def _of_forces(
    fit: Refit, candidate: Candidate, values: Mapping[str, float], base: Mapping[str, float],
    sets: Sequence[Mapping[str, float]],
) -> Shown | None:  # fmt: skip
    """Returns forces on joints; None where the law has none, or not on joints of one kind."""
    along = force_of_records(fit.point.predictor, values, base, sets)
    if along is None:
        return None
    return show_forces(candidate, values, along)


def _of_readings(
    fit: Refit, candidate: Candidate, values: Mapping[str, float], base: Mapping[str, float],
    sets: Sequence[Mapping[str, float]],
) -> Shown | None:  # fmt: skip
    """Returns errors of sensors: their readings minus those of perfect sensors."""
    predictor = fit.point.predictor
    own, *others = (
        replace(predictor, names=tuple(v), fixed={}).predict(np.array([[*v.values()]]))[0]
        for v in (base, *sets)
    )
    log = predictor.log
    rate = np.gradient(own, log.sampling_time, axis=0)
    return show_readings(log, own, rate, log.time, others)


def force_of_records(
    predictor: Predictor, values: Mapping[str, float], base: Mapping[str, float],
    sets: Sequence[Mapping[str, float]],
) -> ForceAlong | None:  # fmt: skip
    """Returns the forces of sets of values beyond those of a base, along a predicted trajectory.

    Args:
        predictor: plant and log.
        values: whose trajectory it is, by name, in their units.
        base: θ₀, likewise.
        sets: each a θ; the first says on which degrees of freedom they act.

    Returns:
        None where the first set has no force, or one on what is no hinge and no slide, or on joints
        of both kinds.

    Raises:
        DivergenceError: the model cannot be simulated.
    """
    whole = _with(predictor, values)
    chosen = (base, *sets)
    each = [_with(predictor, of).records() for of in chosen]
    stretches = []
    for k, (record, columns) in enumerate(whole.records()):
        along = follow(record, _row(values)[0, columns], COARSE_POINTS)
        reached = [
            _reached(own[k][0], _row(of)[:, own[k][1]], along)
            for own, of in zip(each, chosen, strict=True)
        ]
        stretches.append(Stretch(record, along, reached))
    return forces_along(stretches, whole.predict(_row(values))[0])


def _with(predictor: Predictor, values: Mapping[str, float]) -> Predictor:
    return replace(predictor, names=tuple(values), fixed={})


def _row(values: Mapping[str, float]) -> np.ndarray:
    return np.array([[*values.values()]])


def _reached(
    predictor: Predictor, row: np.ndarray, along: Trajectory
) -> tuple[mujoco.MjModel, np.ndarray]:
    """Returns the model of a value set (1, p), and the inputs that reach it along a trajectory."""
    log, plant = predictor.log, predictor.plant.model
    model = with_numbers(without_sensors(plant), predictor.settings(row)[1], 0)
    held = hold(log.inputs, substeps(log.sampling_time, along.timestep), log.hold)
    return model, average_inputs(predictor.inputs(row)(held), along.steps, model.nu)[0]


def _absent(values: Mapping[str, float], others: Mapping[str, float]) -> dict[str, float]:
    """Returns the parameters of a base that other values do not name, with their values."""
    return {name: value for name, value in values.items() if name not in others}


def _solve(fit: Refit, e: np.ndarray, S: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns the likeliest forces at the nodes, and their std, shape (m,) each."""
    point, level = fit.point, fit.level
    filter_ = build_whitener(point.linear, level.noise, point.log.sampling_time)
    E, F = filter_(e).ravel(), filter_(S).reshape(e.size, -1)
    covariance = np.linalg.pinv(F.T @ F, rcond=1e-12, hermitian=True)
    felt = np.diag(F.T @ F) > 0
    std = np.where(felt, level.sigma * np.sqrt(np.diag(covariance)), np.inf)
    return covariance @ (F.T @ E), std
