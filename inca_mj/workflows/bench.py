"""Inputs are tried on the twin: they are simulated, compared with the limits, and assessed."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from identification.errors import DivergenceError
from identification.estimation.experiment import Experiment
from identification.estimation.information import Information
from inca_mj.robot.inputs import multisine, prbs, step
from inca_mj.twin.logs import ANGLES
from inca_mj.twin.run import Run, simulate
from inca_mj.twin.twin import Twin
from inca_mj.workflows.limits import Extent, Limits, extent
from inca_mj.workflows.recipes import Recipe
from inca_mj.workflows.sensitivity import robot_information

SAMPLING = 0.01  # of the robot [s]
SCALES = (1.0, 0.7, 0.5, 0.35, 0.2)  # tried on a swing that breaks a limit


@dataclass(frozen=True)
class Tried:
    """An input, its simulation, and the information that it gives.

    Attributes:
        name: in words.
        run: the simulated run.
        extent: how far currents, tensions and pose went.
        found: information on the parameters, where the start pose is unknown.
        allowed: whether it keeps the limits.
    """

    name: str
    run: Run
    extent: Extent
    found: Information
    allowed: bool


@dataclass(frozen=True)
class Bench:
    """The twin, the noise, the parameters and the limits with which inputs are tried.

    Attributes:
        robot: the twin at its nominal values.
        sigma: std of the noise on each angle [rad].
        names: the parameters of interest; the start pose is unknown too.
        limits: what an input may do.
    """

    robot: Twin
    sigma: float
    names: tuple[str, ...]
    limits: Limits

    def attempt(self, name: str, run: Run, resolved: bool = False) -> Tried:
        """Returns the information that a run gives, from 2 p simulations.

        Args:
            name: in words.
            run: the simulated run.
            resolved: whether the errors of the sensitivities are estimated; this takes twice as
                many simulations.
        """
        sampling = float(run.time[1] - run.time[0])
        trial = Experiment(
            plant=self.robot,
            inputs=run.currents,
            sampling_time=sampling,
            outputs=ANGLES,
            sigma=self.sigma,
        )
        far = extent(run)
        found = robot_information(trial, self.names, resolved)
        return Tried(name, run, far, found, far.within(self.limits))

    def fitted(self, recipe: Recipe, n: int) -> tuple[Recipe, Run] | None:
        """Returns the recipe with the largest tried swing that keeps the limits, and its run."""
        for scale in SCALES:
            smaller = replace(recipe, scale=scale)
            try:
                run = simulate(self.robot, smaller.currents(n, SAMPLING, self.limits), SAMPLING)
            except DivergenceError:
                continue
            if extent(run).within(self.limits):
                return smaller, run
        return None


def standard_inputs(n: int) -> list[tuple[str, np.ndarray]]:
    """Returns inputs that people try, the thesis' PRBS first: names and currents (n, 8) [A]."""
    levels = [(0.5, 1.0, 0.25), (0.5, 1.0, 0.1), (0.5, 1.0, 0.05), (0.25, 1.25, 0.1), (0, 2, 0.1)]
    return [
        *(
            (f"PRBS {a:g}-{b:g} A, {bit:g} s", prbs(n, SAMPLING, low=a, high=b, bit_time=bit))
            for a, b, bit in levels
        ),
        ("multisine 0.5-1 A, to 5 Hz", multisine(n, SAMPLING)),
        ("multisine 0-2 A, 0.1-40 Hz",
         multisine(n, SAMPLING, mean=1.0, amplitude=1.0, band=(0.1, 40.0))),
        ("step 2 A in motor 1", step(n)),
    ]  # fmt: skip
