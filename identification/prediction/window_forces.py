"""The force that one set of values has and another one lacks, along the windows of a record.

Each window is simulated from its own state with the first set of values, and the inputs that reach
it are cut out of those of the whole record: what an effect does to an input may last longer than
the time since the window began.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from identification.discovery.force_along import Stretch
from identification.kalman.trajectory import COARSE_POINTS, average_inputs, divided
from identification.model.coordinates import NOTHING
from identification.model.protocol import with_numbers
from identification.model.rollout import hold, rollout, substeps, without_sensors
from identification.windows.held import NO_VALUES
from identification.windows.shooting import Shooting


@dataclass(frozen=True)
class HeldWindows:
    """The windows of one record at one set of values.

    Attributes:
        part: the windows, of a predictor with no free parameters.
        moves: of their states, shape (W, nx).
    """

    part: Shooting
    moves: np.ndarray

    @property
    def outputs(self) -> np.ndarray:
        """The predicted outputs, shape (W, L, ny)."""
        return self.part.outputs(NO_VALUES, [self.moves])[0]

    @property
    def every(self) -> int:
        """Steps of the simulation in a sample."""
        predictor = self.part.predictor
        return substeps(predictor.log.sampling_time, predictor.plant.model.opt.timestep)

    @property
    def reaching(self) -> np.ndarray:
        """Inputs that reach the model at each step, shape (W, steps, nu)."""
        inputs, each, kind = self.part.held_inputs(NO_VALUES)
        return hold(inputs, self.every, kind) if each == 1 else inputs[:, :-1]


def with_values(part: Shooting, moves: np.ndarray, values: Mapping[str, float]) -> HeldWindows:
    """Returns the windows of a record with all values given.

    Args:
        part: the windows.
        moves: of their states, shape (W, nx).
        values: of the parameters that differ from the plant's own, by name.
    """
    predictor = replace(part.predictor, names=(), fixed=values)
    return HeldWindows(replace(part, predictor=predictor, space=NOTHING), moves)


def stretches_of(base: HeldWindows, sets: Sequence[HeldWindows]) -> list[Stretch]:
    """Returns each window as a stretch, simulated with the first of some sets of values.

    Args:
        base: with θ₀.
        sets: each with a θ; the windows and the moves are the same.

    Raises:
        DivergenceError: a window cannot be simulated.
    """
    law = sets[0]
    predictor, every = law.part.predictor, law.every
    plant, step = predictor.plant.model, predictor.plant.model.opt.timestep
    models, reaching = [], []
    for each in (base, *sets):
        numbers = each.part.predictor.settings(NO_VALUES)[1]
        models.append(with_numbers(without_sensors(plant), numbers, 0))
        reaching.append(each.reaching)
    held, W = reaching[1], len(law.moves)
    run = rollout(
        plant, predictor.begun(NO_VALUES, law.part.states(law.moves)),
        np.concatenate([held, held[:, -1:]], axis=1), step,
        numbers=[(slot, np.repeat(column, W)) for slot, column in predictor.settings(NO_VALUES)[1]],
        record=("qpos", "qvel", "act") if plant.na else ("qpos", "qvel"), time=law.part.times,
    )  # fmt: skip
    out = []
    for w, begun in enumerate(law.part.times.tolist()):
        states = {field: x[w] for field, x in run.items()}
        along = divided(models[1], states, held[w], every, begun, COARSE_POINTS)
        reached = [
            (model, average_inputs(inputs[w], along.steps, plant.nu)[0])
            for model, inputs in zip(models, reaching, strict=True)
        ]
        out.append(Stretch(predictor, along, reached))
    return out
