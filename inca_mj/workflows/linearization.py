"""Words of the command line for linear models: points of a grid, and a log's operating points."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification.errors import InputError, unknown_name
from identification.logs.log import Log
from identification.model.parameter import ParameterSet
from inca_mj.linear.linearization import LinearModel, linearize_along
from inca_mj.robot.geometry import Geometry
from inca_mj.twin.logs import POSE
from inca_mj.twin.mjcf import TIMESTEP
from inca_mj.twin.twin import build_twin
from inca_mj.workflows.comparison import start_of, timestep_for

MOST = 200  # points of one axis


def grid_axes(words: Sequence[str]) -> dict[str, np.ndarray]:
    """The axes of a grid from words such as `x=-0.4:0.4:5`.

    Args:
        words: each NAME=LOW:HIGH:POINTS; lengths in m, angles in rad.

    Raises:
        InputError: a word is malformed, names no scheduling variable, or names one twice.
    """
    axes: dict[str, np.ndarray] = {}
    for word in words:
        name, equals, rest = word.partition("=")
        parts = rest.split(":")
        try:
            low, high, points = float(parts[0]), float(parts[1]), int(parts[2])
            if not equals or len(parts) != 3:
                raise ValueError
        except (ValueError, IndexError):
            raise InputError(
                f"{word!r} is not NAME=LOW:HIGH:POINTS; write e.g. --grid x=-0.4:0.4:5"
            ) from None
        if name not in POSE:
            raise unknown_name("scheduling variable", name, POSE)
        if name in axes:
            raise InputError(f"--grid gives {name} twice; give it once")
        if not 2 <= points <= MOST:
            raise InputError(f"--grid gives {points} points of {name}; give 2 to {MOST}")
        axes[name] = np.linspace(low, high, points)
    return axes


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
