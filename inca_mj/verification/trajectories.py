"""Ten seconds of both models from one state under one input, and how the error falls with the step.

    step    2 A in motor 1, none in the others                   (thesis Figure 2.16)
    prbs    the thesis' identification input                     (section 3.2.1)
    drop    the platform is let go with slack cables, falls and is caught
    spin    the platform turns at its start; the taut cables stop it within some milliseconds

Steps of the twin divide the 10 ms between samples, on which currents change: what is left of
the order of RK4 is the models' doing, and the integrator's.

    e(h) ≈ c₄ h⁴ + c₂ h²

RK4 gives the first term while the motion is smooth. The second is MuJoCo's: its RK4 turns the
quaternion of a free joint by the average of the stages' angular velocities, which is right for
vectors; for rotations that do not commute it leaves an error of h² (the commutators of a
Magnus expansion are missing). A kink, where a cable turns slack or taut within a step, costs
RK4 its order too. So the order is measured twice: over all steps, and where c₄ h⁴ leads.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import nnls

from identification.errors import DivergenceError, unknown_name
from identification.model.parameter import ParameterSet
from inca_mj.reference import ReferenceRun, rest
from inca_mj.reference import layout as at
from inca_mj.robot.geometry import DRIVES, Geometry
from inca_mj.robot.inputs import prbs, step
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import build_twin
from inca_mj.verification.derivatives import to_mujoco

SAMPLING_TIME = 0.01  # [s]
ROUND_OFF = 1e-10  # errors below are the reference's tolerance, not the twin's step
CASES = ("step", "prbs", "drop", "spin")

_SLACK = np.linspace(1.01, 1.03, DRIVES)  # d₀/d of the drop: uneven, so that the catch tumbles
_SPIN = (5.0, -3.0, 15.0)  # [rad/s]; fast enough to turn, slow enough to keep all cables taut

ERRORS = ("max_angle_error", "max_position_error", "max_tension_error")  # [rad], [m], [N]
Steps = Sequence[float] | np.ndarray
Errors = Sequence[float | None] | np.ndarray
Row = dict[str, Any]  # case, step [s], and the errors; None where a run diverged


@dataclass(frozen=True)
class Case:
    """A start and currents for both models."""

    name: str  # one of `CASES`
    start: np.ndarray  # state of the reference, shape (36,)
    time: np.ndarray  # sample times, shape (N,) [s]
    currents: np.ndarray  # held from sample to sample, shape (N, 8) [A]


def make_case(name: str, parameters: ParameterSet, geometry: Geometry, duration: float) -> Case:
    """Returns a case by name.

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


def compare_runs(
    case: Case,
    reference: Callable[[], ReferenceRun],
    parameters: ParameterSet,
    geometry: Geometry,
    timestep: float,
) -> tuple[Row, str]:
    """Returns the largest differences of the twin at a step [s] from the reference.

    The reference's run is asked for only when the twin's is there. The errors of the row are None
    when a model diverged, and a sentence then says so.
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


def slope(steps: Steps, errors: Errors) -> float | None:
    """Returns the slope of log error against log step; None when fewer than two steps show it."""
    h, e = _resolved(steps, errors)
    return float(np.polyfit(np.log(h), np.log(e), 1)[0]) if len(h) > 1 else None


def crossing(steps: Steps, errors: Errors) -> float:
    """Returns the step h = √(c₂/c₄) below which the h² term leads; 0 when it cannot be seen."""
    h, e = _resolved(steps, errors)
    if len(h) < 3:
        return 0.0
    unit = h.max()
    columns = np.column_stack([(h / unit) ** 4, (h / unit) ** 2])
    columns *= (e.max() / e)[:, None]  # relative errors, of numbers near 1
    (c_4, c_2), _ = nnls(columns, np.ones(len(h)))
    return float(unit * np.sqrt(c_2 / c_4)) if c_4 > 0 else np.inf


def leading_slope(steps: Steps, errors: Errors) -> float | None:
    """Returns the slope over the steps where RK4's own error leads.

    That is where c₄ h⁴ is twice c₂ h² or more, less the longest step while two others are left:
    it is the nearest to RK4's limit of stability, |λ| h = 2.8 (2 ms have 1.6 and 1.9 in the
    thesis' two parameter sets). None when fewer than three steps show the terms apart.
    """
    h, e = _resolved(steps, errors)
    if len(h) < 3:
        return None
    leads = h >= np.sqrt(2) * crossing(steps, errors)
    if leads.sum() > 2:
        leads &= h < h.max()
    return slope(h[leads], e[leads])


def _resolved(steps: Steps, errors: Errors) -> tuple[np.ndarray, np.ndarray]:
    shown = [(h, e) for h, e in zip(steps, errors, strict=True) if e is not None and e > ROUND_OFF]
    h, e = np.array(shown).reshape(-1, 2).T
    return h, e
