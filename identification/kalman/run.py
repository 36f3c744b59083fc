"""A simulation of a plant at one value set, from which outputs and trajectories are taken.

A search simulates a step to see whether it is a good one, and then linearises along the same
trajectory.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from identification.kalman.trajectory import COARSE_POINTS, Trajectory, follow_records
from identification.model.predictor import Predictor
from identification.model.protocol import with_states


@dataclass(frozen=True, eq=False)
class Run:
    """A simulation of all records of a log, made when something of it is first asked for.

    Attributes:
        predictor: plant and log, with p parameters.
        values: shape (p,), in the parameters' units.

    Raises:
        DivergenceError: the simulation left the finite numbers; as for all that is asked.
        InputError: the robot cannot rest at its start.
    """

    predictor: Predictor
    values: np.ndarray

    @cached_property
    def along(self) -> tuple[Trajectory, ...]:
        """The trajectory of each record."""
        (each,) = follow_records(self.predictor, self.values, COARSE_POINTS)
        return tuple(each)

    @cached_property
    def outputs(self) -> np.ndarray:
        """The outputs of all records, shape (N, ny).

        A plant whose sensors see states that no model file has is simulated once more for them: a
        trajectory lacks these.
        """
        if with_states(self.predictor.plant) is not None:
            return self.predictor.predict(self.values)[0]
        each = zip(self.predictor.records(), self.along, strict=True)
        return np.concatenate([
            record.outputs(
                self.values[None, columns], {field: x[None] for field, x in along.states.items()}
            )[0]
            for (record, columns), along in each
        ])  # fmt: skip
