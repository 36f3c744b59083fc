"""The twin linearised along a log."""

from __future__ import annotations

from collections.abc import Sequence

from identification.logs.log import Log
from identification.model.parameter import ParameterSet
from inca_mj.linear.linearization import LinearModel, linearize_along
from inca_mj.robot.geometry import Geometry
from inca_mj.robot.parameters import TIMESTEP
from inca_mj.twin.twin import build_twin
from inca_mj.workflows.comparison import start_of, timestep_for


def linearize_log(
    log: Log,
    times: Sequence[float],
    parameters: ParameterSet,
    geometry: Geometry,
    timestep: float = TIMESTEP,
) -> tuple[LinearModel, ...]:
    """Linearise the twin along its free run under a log, from the log's pose where it has one.

    Args:
        log: what was measured.
        times: of the log [s].
        parameters: the twin's values.
        geometry: anchors of the cables.
        timestep: largest step of the integrator [s].

    Raises:
        InputError: a time is outside the log, a cable is slack there, or the start has no
            pretension.
        DivergenceError: the simulation left the finite numbers.
    """
    step = timestep_for(log.sampling_time, timestep)
    robot = build_twin(start_of(log, parameters), geometry, timestep=step)
    return linearize_along(robot, log, times)
