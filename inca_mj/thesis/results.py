"""Chapters 2.4 and 3 of the thesis, computed again, to stand beside its printed numbers.

Figure 2.16                  a run of the twin with Table 2.1
Figures 3.2, 3.3             the data of the trials
Tables 3.3-3.6, Figs 3.4-3.7 the four trials
Tables 3.7-3.8, Figs 3.8-3.13 the two steps of section 3.3 on a simulated robot, a stand-in for
                             the real one, whose log was never published
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from identification import Log
from identification.errors import refuse_negative, unknown_name
from identification.estimation.estimation import Options
from identification.estimation.fit import Fit
from inca_mj.robot.inputs import make_input
from inca_mj.robot.parameters import parameter_set
from inca_mj.thesis.trials import TrialResult, trial_data, trials
from inca_mj.twin.logs import UNJUDGED, run_to_log
from inca_mj.twin.run import Run, simulate
from inca_mj.twin.twin import Twin, build_twin
from inca_mj.workflows.comparison import Comparison, compare_twin
from inca_mj.workflows.identification import Identification, identify_as_thesis


@dataclass(frozen=True)
class FigureSettings:
    """The settings that a figure of the thesis needs."""

    input: str  # of `make_input`
    set: Literal["trial", "simulation"]  # parameter set
    duration: float  # [s]


FIGURES = {
    "2.16": FigureSettings("step", "simulation", 10.0),
    "3.2": FigureSettings("prbs", "trial", 5.0),
    "3.3": FigureSettings("prbs", "trial", 5.0),
}


def figure_settings(number: str) -> FigureSettings:
    """Returns the settings of a figure, or refuses a number of which no run gives a figure."""
    if number not in FIGURES:
        raise unknown_name("figure", number, FIGURES)
    return FIGURES[number]


STAND_IN = 10.0  # length of the log of section 3.3 [s]
ENCODER = 6e-4  # std of the angles of the stand-in [rad]


@dataclass(frozen=True, kw_only=True)
class ThesisResults:
    """The results that were computed again.

    Attributes:
        figure_2_16: the run of Figure 2.16.
        data: the data of the trials, without noise.
        trials: the four trials.
        stand_in: the log of the simulated robot in place of the real one.
        procedure: the two steps on it.
    """

    figure_2_16: Run
    data: Log
    trials: tuple[TrialResult, ...]
    stand_in: Log
    procedure: Identification

    def validation(self, fit: Fit) -> Comparison:
        """Returns the whole stand-in log against a step's model, as in Figures 3.11 and 3.13."""
        plant = fit.estimate.predictor.plant
        if not isinstance(plant, Twin):
            raise TypeError("the procedure was not made with a twin")
        fitted = plant.with_values(fit.estimate.values)
        return compare_twin(self.stand_in, fitted, trust=UNJUDGED)  # the fit has judged it


def stand_in_log(seed: int) -> Log:
    """Returns a log of a simulated robot with Table 3.2: 10 s of PRBS at 100 Hz, noisy encoders.

    The seed is that of the PRBS' phases and of the noise.
    """
    currents = make_input("prbs", STAND_IN, seed=seed)
    log = run_to_log(simulate(build_twin(parameter_set("trial")), currents), "stand-in")
    noise = ENCODER * np.random.default_rng(seed).standard_normal(log.outputs.shape)
    noise[0] = 0.0  # a log begins at zero angles
    half = STAND_IN / 2
    splits = {"estimation": (0.0, half), "validation": (half, STAND_IN + log.sampling_time)}
    return replace(log, outputs=log.outputs + noise, splits=splits)


def repeat_thesis(
    *,
    seed: int = 0,
    options: Options | None = None,
    progress: Callable[[str], None] | None = None,
) -> ThesisResults:
    """Compute the results of the thesis' chapters 2.4 and 3 again.

    Args:
        seed: of the stand-in's input and noise, and of the noise of trial 4.
        options: how to search; `Options(horizons=(1.0,))` is the thesis' single free-run fit.
        progress: is told what is computed, and one line per accepted step.

    Raises:
        InputError: the seed is negative.
        DivergenceError: a search ends at values that cannot be simulated.
    """
    refuse_negative("seed", seed)
    say = progress or (lambda line: None)
    shown = FIGURES["2.16"]
    say("Figure 2.16")
    figure = simulate(build_twin(parameter_set(shown.set)), make_input(shown.input, shown.duration))
    data = trial_data(build_twin(parameter_set("trial")))
    found = trials(seed=seed, options=options, progress=progress)
    say("the two steps of section 3.3")
    log = stand_in_log(seed)
    steps = identify_as_thesis(log, options=options, progress=progress)
    return ThesisResults(figure_2_16=figure, data=data, trials=found, stand_in=log, procedure=steps)
