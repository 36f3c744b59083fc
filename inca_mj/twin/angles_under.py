"""The twin's angles under several sequences of currents, all simulated in one rollout."""

from __future__ import annotations

import numpy as np

from identification import Log, Predictor
from identification.model.rollout import hold, rollout, substeps
from inca_mj.twin.twin import Twin


def angles_under(plant: Twin, log: Log, currents: np.ndarray) -> np.ndarray:
    """Returns the twin's angles from its start, shape (m, n, k) [rad]; NaN where not finite.

    Args:
        plant: the twin.
        log: n samples of k angles; its own currents are not used.
        currents: m sequences, shape (m, n, 8) [A].
    """
    predictor, none = Predictor(plant, log, (), {}), np.zeros((len(currents), 0))
    start, numbers = predictor.settings(none)
    timestep = plant.model.opt.timestep
    every = substeps(log.sampling_time, timestep)
    reach = predictor.inputs(none[:1])  # effects of the twin may change what the motors get
    held = [reach(each).reshape(each.shape) for each in hold(currents, every, log.hold)]
    last = [each[-1:] for each in held]  # rollout takes an input more than it makes steps
    states = rollout(
        plant.model,
        start,
        np.concatenate([held, last], axis=1),
        timestep,
        numbers=numbers,
        record=predictor.recorded,
        time=log.begun,
        keeps_diverged=True,
    )
    return predictor.outputs(none, {name: part[:, ::every] for name, part in states.items()})
