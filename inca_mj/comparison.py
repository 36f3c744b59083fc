"""A log against the twin's prediction of it: fit % and rms per motor angle."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil
from typing import Any

import numpy as np

from identification import Log, fit_percent, rms
from identification.parameter import ParameterSet
from inca_mj.geometry import INCA, Geometry
from inca_mj.mjcf import TIMESTEP
from inca_mj.run import Run, simulate
from inca_mj.twin import build_twin


@dataclass(frozen=True)
class Comparison:
    """What was measured, and what the twin makes of the same currents.

    Attributes:
        log: the measured log.
        run: the twin's run under the log's currents, on the same samples.
        fit_percent: 100 (1 - ‖ŷ - y‖/‖y - ȳ‖) per angle (thesis 3.4), shape (8,) [%].
        rms: of the difference per angle, shape (8,) [rad].
    """

    log: Log
    run: Run
    fit_percent: np.ndarray
    rms: np.ndarray

    def to_json(self) -> dict[str, Any]:
        """The numbers as plain values."""
        return {
            "fit_percent": [float(f) if np.isfinite(f) else None for f in self.fit_percent],
            "rms": self.rms.tolist(),
            "samples": len(self.log),
            "seconds_simulated": self.log.duration,
        }


def compare(
    log: Log, parameters: ParameterSet | None = None, geometry: Geometry = INCA
) -> Comparison:
    """Predict a log's angles from its currents alone, from the twin's start.

    Raises:
        InputError: the start has no pretension.
        DivergenceError: the simulation left the finite numbers.
    """
    robot = build_twin(parameters, geometry, timestep=timestep_for(log.sampling_time))
    run = simulate(robot, log.inputs, log.sampling_time, hold_kind=log.hold)
    predicted = run.motor_angle
    return Comparison(
        log, run, fit_percent(log.outputs, predicted), rms(log.outputs - predicted)
    )  # fmt: skip


def timestep_for(sampling_time: float) -> float:
    """The largest step that divides the sampling time and is no more than `TIMESTEP` [s]."""
    return sampling_time / ceil(sampling_time / TIMESTEP - 1e-9)
