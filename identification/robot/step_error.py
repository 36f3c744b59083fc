"""The error of a model's integration on a log, compared with the log's noise.

    d(t) = ŷ_Δ(t) - ŷ_Δ/2(t)         Δ the model's timestep, the first `SECONDS` of a free run
    e = rms d(t)                     or, where predictions are judged over a horizon H,
    e = rms d_w(H)                   of windows that begin at the motion that was measured

Half the step has 2⁻ᵖ of the error of an integrator of order p. So e is half of Euler's error, and
nearly all of RK4's. An error that is larger than the noise would be taken for an effect, unless the
model as it is written predicts the log much worse than that over the horizon: what is missing is
then larger than what the steps make.

A free run of a model that lacks something goes where the robot never was: it hits an end stop at
another speed and at another time, and the steps then differ by much that no window of the data
shows.

It is the error of one law. The time in which a joint with dry friction stops goes with the step,
and is held here; `identification.prediction.fits.std` tells what it does to a fit.
"""

from __future__ import annotations

import copy
from dataclasses import dataclass, replace

import numpy as np

from identification.errors import DivergenceError, InputError
from identification.logs.noise import noise_floor
from identification.model.predictor import Predictor
from identification.refusals.far_angles import far_sentence
from identification.robot.blame import blamed
from identification.robot.robot import Robot
from identification.windows.window_error import first_error, window_error

SECONDS = 2.0  # of a free run; a longer one of an unstable robot would diverge
WINDOWS = 40  # of a horizon, spread over the log
HALVINGS = 6  # of the timestep that are tried, to find one that is small enough
# Of the error of prediction; its square is less than a tenth of what is to be explained.
SMALL = 0.3
NONE = 1e-6  # of an output's motion: so small an error does not matter even without noise
INTEGRATORS = ("Euler", "RK4", "implicit", "implicitfast")  # as MuJoCo counts them
RK4 = INTEGRATORS.index("RK4")


@dataclass(frozen=True)
class StepError:
    """The integration error of one output."""

    output: str  # name of the output
    error: float  # e, in its unit
    noise: float  # std of its noise, in its unit


def refuse_coarse_steps(robot: Robot) -> None:
    """Refuse a model whose integration errs by more than the noise of the log."""
    if "steps" in robot.file.trust:
        return
    worst = _worst(robot)
    if _is_small(robot, worst):
        return
    said = blamed(robot, lambda other: _is_small(other, _worst(other)))
    path = robot.file.path
    if said is not None:
        raise InputError(f'{said}, or, if it is right, write trust = ["steps"] into {path}')
    if worst is None:  # the search will say why
        return
    far = far_sentence(robot.plant.model, robot.log, robot.file.columns)
    option, unit = robot.plant.model.opt, robot.log.units.get(worst.output, "")
    raise InputError(
        f"{robot.file.model} errs by {worst.error:.2g} {unit}".rstrip()
        + f" in {worst.output} with integrator {INTEGRATORS[int(option.integrator)]} and timestep"
        f" {option.timestep:g} s, more than the noise of log {robot.log.name!r},"
        f" {worst.noise:.2g} {unit}".rstrip()
        + f'; {_cure(robot)}, or write trust = ["steps"] into {path}'
        + (f". {far}" if far else "")
    )


def _worst(robot: Robot) -> StepError | None:
    """Returns the largest error of the steps; None where the model cannot be simulated."""
    try:
        return step_error(robot)
    except DivergenceError:
        return None


def _is_small(robot: Robot, worst: StepError | None) -> bool:
    if worst is None:
        return False
    return worst.error <= worst.noise or worst.error <= SMALL * _error_of_prediction(robot, worst)


def step_error(robot: Robot) -> StepError:
    """Returns the error of the output with the largest ratio of error to noise.

    Raises:
        DivergenceError: the model cannot be simulated.
    """
    log, pair = robot.log, (robot, _stepped(robot, 0.5))
    d = _of_windows(*pair) if robot.file.horizon is not None else None
    d = _of_free_run(*pair) if d is None else d
    e, noise = np.sqrt(np.mean(d**2, axis=0)), _noise(log.outputs)
    k = int(np.argmax(e / noise))
    return StepError(log.output_names[k], float(e[k]), float(noise[k]))


def _of_windows(coarse: Robot, fine: Robot) -> np.ndarray | None:
    """Returns d at the ends of windows, shape (W, ny); None where no window fits the log."""
    horizon = float(coarse.file.horizon or 0.0)
    try:
        each = [
            first_error(r.plant, r.log, horizon, WINDOWS, values=dict(r.log.values))
            for r in (coarse, fine)
        ]
    except DivergenceError:
        raise
    except InputError:
        return None
    return np.asarray((each[1] - each[0])[:, -1])


def _of_free_run(coarse: Robot, fine: Robot) -> np.ndarray:
    """Returns d at the samples of the beginning of a free run, shape (N, ny)."""
    log = coarse.log
    samples = max(2, 1 + int(min(SECONDS, log.duration) / log.sampling_time))
    each = (
        Predictor(r.plant, log, (), dict(log.values)).predict(np.empty((1, 0)), samples)[0]
        for r in (coarse, fine)
    )
    return np.asarray(np.subtract(*each))


def _error_of_prediction(robot: Robot, worst: StepError) -> float:
    """Returns an output's rms error over the horizon at the values as written; 0 in a free run."""
    horizon, log = robot.file.horizon, robot.log
    if horizon is None:
        return 0.0
    try:
        error = window_error(robot.plant, log, horizon, dict(log.values))
    except InputError:  # no window fits the log, or it diverges: the search will say why
        return 0.0
    return float(np.sqrt(np.mean(error[..., log.output_names.index(worst.output)] ** 2)))


def _noise(y: np.ndarray) -> np.ndarray:
    """Returns the noise std of each output; for an encoder that crosses few steps, of its steps."""
    steps = np.abs(np.diff(y, axis=0))
    least = np.min(np.where(steps > 0, steps, np.inf), axis=0)
    return np.maximum.reduce([noise_floor(y), least / 12**0.5, NONE * np.ptp(y, axis=0)])


def _cure(robot: Robot) -> str:
    """Returns advice: the largest step of RK4 with an error below the noise, and how to set it."""
    option = robot.plant.model.opt
    has = int(option.integrator) == RK4
    for halvings in range(int(has), HALVINGS + 1):
        finer = _stepped(robot, 0.5**halvings, RK4)
        try:
            found = step_error(finer)
        except DivergenceError:
            continue
        if found.error <= found.noise:
            wanted = [] if has else ['integrator="RK4"']
            wanted += [f'timestep="{finer.plant.model.opt.timestep:.10g}"'] if halvings else []
            return f"write {' and '.join(wanted)} into its <option>"
    return (
        f"no timestep of RK4 down to {0.5**HALVINGS * option.timestep:.2g} s would do: soften what"
        " is stiff in it"
    )


def _stepped(robot: Robot, factor: float, integrator: int | None = None) -> Robot:
    """Returns the robot with another timestep and, if given, another integrator."""
    model = copy.copy(robot.plant.bare.model)
    model.opt.timestep *= factor
    if integrator is not None:
        model.opt.integrator = integrator
    plant = replace(robot.plant, bare=replace(robot.plant.bare, model=model))
    return replace(robot, plant=plant)
