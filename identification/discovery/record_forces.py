"""The force that one set of values has and another one lacks, along the records of a log."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import mujoco
import numpy as np

from identification.discovery.force_along import ForceAlong, Stretch, forces_along
from identification.kalman.trajectory import COARSE_POINTS, Trajectory, average_inputs, follow
from identification.model.numbers import with_numbers
from identification.model.predictor import Predictor
from identification.model.rollout import hold, substeps, without_sensors


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
