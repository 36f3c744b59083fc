"""Ten seconds of both models from one state under one input.

    step    2 A in motor 1, none in the others                   (thesis Figure 2.16)
    prbs    the thesis' identification input                     (section 3.2.1)
    drop    the platform is let go with slack cables, falls and is caught
    spin    the platform turns at its start; the taut cables stop it within some milliseconds

Steps of the twin divide the 10 ms between samples, on which currents change: what is left of
the order of RK4 is the models' doing, and the integrator's.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from identification.errors import DivergenceError, unknown_name
from identification.model.parameter import ParameterSet
from inca_mj.reference import ReferenceRun, rest, simulate_reference
from inca_mj.reference import layout as at
from inca_mj.robot.geometry import DRIVES, Geometry
from inca_mj.robot.inputs import prbs, step
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import build_twin
from inca_mj.verification.states import to_mujoco

SAMPLING_TIME = 0.01  # [s]
CASES = ("step", "prbs", "drop", "spin")

_SLACK = np.linspace(1.01, 1.03, DRIVES)  # d₀/d of the drop: uneven, so that the catch tumbles
_SPIN = (5.0, -3.0, 15.0)  # [rad/s]; fast enough to turn, slow enough to keep all cables taut

ERRORS = ("max_angle_error", "max_position_error", "max_tension_error")  # [rad], [m], [N]
Row = dict[str, Any]  # case, step [s], and the errors; None where a run diverged


@dataclass(frozen=True)
class Case:
    """A start and currents for both models.

    Attributes:
        name: one of `CASES`.
        start: state of the reference, shape (36,).
        time: sample times, shape (N,) [s].
        currents: held from sample to sample, shape (N, 8) [A].
    """

    name: str
    start: np.ndarray
    time: np.ndarray
    currents: np.ndarray


def make_case(name: str, parameters: ParameterSet, geometry: Geometry, duration: float) -> Case:
    """Returns a case by name.

    Args:
        name: one of `CASES`.
        parameters: whose rest the case starts from.
        geometry: anchors of the cables.
        duration: [s].

    Raises:
        InputError: the case is unknown, or no rest exists.
    """
    if name not in CASES:
        raise unknown_name("case", name, CASES)
    n = round(duration / SAMPLING_TIME) + 1
    start, currents = rest(parameters, geometry).state.copy(), np.zeros((n, DRIVES))
    if name == "step":
        currents = step(n)
    elif name == "prbs":
        currents = prbs(n, SAMPLING_TIME)
    elif name == "drop":
        start[at.NO_LOAD] = rest(parameters, geometry).length * _SLACK
    else:
        start[at.RATES] = _SPIN
    return Case(name, start, np.arange(n) * SAMPLING_TIME, currents)


def run_reference(case: Case, parameters: ParameterSet, geometry: Geometry) -> ReferenceRun:
    """Returns a run of the reference, by its adaptive method.

    Raises:
        DivergenceError: its pitch came to 90°, where Euler angles are singular.
    """
    return simulate_reference(parameters, geometry, case.time, case.currents, start=case.start)


def compare_runs(
    case: Case,
    reference: Callable[[], ReferenceRun],
    parameters: ParameterSet,
    geometry: Geometry,
    timestep: float,
) -> tuple[Row, str]:
    """Returns the largest differences of the twin at one step from the reference.

    Args:
        case: start and currents.
        reference: gives the reference's run; asked for it only when the twin's is there.
        parameters: values of both models.
        geometry: anchors of the cables.
        timestep: of the twin [s]; divides 10 ms.

    Returns:
        The row, its errors None when a model diverged, and then a sentence that says so.
    """
    row: Row = {"case": case.name, "step": timestep, **dict.fromkeys(ERRORS)}
    robot = build_twin(parameters, geometry, timestep=timestep)
    try:
        run = simulate(robot, case.currents, SAMPLING_TIME, start=to_mujoco(case.start))
        exact = reference()
    except DivergenceError as error:
        return row, f"{case.name} at {1e3 * timestep:g} ms: {error}"
    differences = (
        run.motor_angle - exact.angles,
        run.position - exact.position,
        run.tension - exact.tension,
    )
    return row | dict(zip(ERRORS, (float(np.abs(x).max()) for x in differences), strict=True)), ""
