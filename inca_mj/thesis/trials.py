"""The four identification trials of the thesis, on data of its own model (Tables 3.3 to 3.6).

The data are five seconds of PRBS at 100 Hz, simulated with Table 3.2. Trial 1 estimates everything,
from starting values that are 25 % off. Trial 2 estimates only the parameters that no data sheet
gives, from the same starting values. Trial 3 does the same from values that are 5 % off. Trial 4
adds a random error of up to ±5 % of each sample to the outputs. The estimator is this project's.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from identification import Log
from identification.chances import normal_level
from identification.errors import refuse_negative, unknown_name
from identification.estimation.estimation import Options, estimate
from identification.estimation.fit import Fit, assess
from identification.estimation.metrics import fit_percent, loss
from identification.quantities import finite_or_none
from identification.runtime.progress import counted
from inca_mj.robot.inputs import make_input
from inca_mj.robot.parameters import parameter_set
from inca_mj.thesis.prints import FITS, printed
from inca_mj.twin.logs import run_to_log
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import Twin, build_twin

DURATION = 5.0  # of the data [s]
NOISE = 0.05  # largest error of a sample, relative to it


@dataclass(frozen=True)
class Trial:
    """A trial: its starting values, its noise, and what the thesis found."""

    number: int  # 1 to 4
    start: Mapping[str, float]  # starting values of the free parameters
    noisy: bool  # whether the outputs carry noise
    thesis: Mapping[str, float]  # the thesis' estimates
    thesis_fit: float  # the thesis' mean output fit [%]


def _trial(n: int) -> Trial:
    """Returns a trial as its table and its figure print it."""
    start, found = (printed(f"3.{n + 2}", column) for column in ("initial", "estimated"))
    return Trial(n, start, n == 4, found, FITS[f"3.{n + 3}"].mean)


TRIALS = tuple(map(_trial, (1, 2, 3, 4)))


def trial_data(robot: Twin) -> Log:
    """Returns the data of the trials, without noise: 5 s of the thesis' PRBS."""
    return run_to_log(simulate(robot, make_input("prbs", DURATION)), "trial data")


def with_noise(log: Log, seed: int) -> Log:
    """Returns a log with outputs times 1 + e, e uniform in ±5 % (thesis, footnote of 3.2.3)."""
    error = np.random.default_rng(seed).uniform(-NOISE, NOISE, log.outputs.shape)
    return replace(log, outputs=log.outputs * (1 + error))


@dataclass(frozen=True)
class TrialResult:
    """The result of a trial.

    Attributes:
        trial: the trial.
        fit: what the estimator found.
        output_fit_percent: fit of the outputs to the data without noise, shape (8,) [%].
        loss: loss function 3.5 of the thesis, for the same data.
    """

    trial: Trial
    fit: Fit
    output_fit_percent: np.ndarray
    loss: float

    def to_json(self) -> dict[str, Any]:
        """Returns the numbers as plain values."""
        true = parameter_set("trial").values()
        values = self.fit.estimate.values
        return {
            "trial": self.trial.number,
            "parameters": {
                name: {
                    "true": true[name],
                    "initial": self.trial.start[name],
                    "estimated": value,
                    "std": finite_or_none(std),
                    "thesis": self.trial.thesis[name],
                    "fit_percent": 100 * (1 - abs(value - true[name]) / abs(true[name]))
                    if true[name]
                    else None,
                }
                for (name, value), std in zip(values.items(), self.fit.std, strict=True)
            },
            "combinations": [
                {"name": str(c), "value": value, "std": finite_or_none(std), "true": c.value(true)}
                for c, value, std in self.fit.combinations
            ],
            "output_fit_percent": self.output_fit_percent.tolist(),
            "thesis_output_fit_percent": self.trial.thesis_fit,
            "loss": self.loss,
            "seconds": self.fit.estimate.seconds,
        }


def run_trial(
    trial: Trial,
    *,
    seed: int = 0,
    options: Options | None = None,
    progress: Callable[[str], None] | None = None,
) -> TrialResult:
    """Run a trial from the thesis' starts, with noise of a seed; see `trials`."""
    options = options or Options()
    if trial.noisy:
        options = replace(options, relative_noise=NOISE / np.sqrt(3))  # std of the uniform error
    robot = build_twin(parameter_set("trial"))
    clean = trial_data(robot)
    data = with_noise(clean, seed) if trial.noisy else clean
    fit = assess(estimate(robot, data, tuple(trial.start), trial.start, options, progress))
    predicted = data.outputs - fit.residual
    return TrialResult(
        trial, fit, fit_percent(clean.outputs, predicted), loss(clean.outputs - predicted)
    )


def trials(
    numbers: Sequence[int] = (1, 2, 3, 4),
    *,
    seed: int = 0,
    options: Options | None = None,
    progress: Callable[[str], None] | None = None,
) -> tuple[TrialResult, ...]:
    """Run trials of the thesis from its starting values.

    Args:
        numbers: numbers of the trials, 1 to 4.
        seed: seed of the noise of trial 4.
        options: how to search; `Options(horizons=(1.0,))` is the thesis' single free-run fit.
        progress: is told which trial is run, and one line per accepted step.

    Raises:
        InputError: there is no trial of a number, or the seed is negative.
    """
    refuse_negative("seed", seed)
    for number in numbers:
        if number not in range(1, len(TRIALS) + 1):
            raise unknown_name("trial", str(number), map(str, range(1, len(TRIALS) + 1)))
    say = progress or (lambda line: None)
    results = []
    for number in counted(numbers, "trials", len(numbers)):
        say(f"trial {number}")
        results.append(run_trial(TRIALS[number - 1], seed=seed, options=options, progress=progress))
    return tuple(results)


def monte_carlo(seeds: int, progress: Callable[[str], None] | None = None) -> dict[str, Any]:
    """Runs trial 4 with many noise realisations, which the thesis proposed and did not do.

    Args:
        seeds: number of realisations.
        progress: is told a line per seed.

    Returns:
        By parameter: relative bias and std of the estimates, the mean of the std that the fits
        gave, and the share of seeds whose 95 % interval contains the true value.

    Raises:
        InputError: the number is negative, or a search ends at values with which the robot cannot
            start.
        DivergenceError: a search ends at values that cannot be simulated.
    """
    refuse_negative("number of seeds", seeds)
    true = parameter_set("trial").values()
    trial = TRIALS[3]
    names = tuple(trial.start)
    found, claimed = np.empty((seeds, len(names))), np.empty((seeds, len(names)))
    for seed in counted(range(seeds), "seeds", seeds):
        fit = run_trial(trial, seed=1000 + seed).fit
        found[seed], claimed[seed] = list(fit.estimate.values.values()), fit.std
        if progress is not None:
            progress(f"seed {seed + 1} of {seeds}")
    truth = np.array([true[name] for name in names])
    error = found - truth
    covered = np.abs(error) <= normal_level(0.025) * claimed
    return {
        "seeds": seeds,
        "parameters": {
            name: {
                "bias": float(error[:, j].mean() / truth[j]),
                "std": float(error[:, j].std(ddof=1) / truth[j]),
                "claimed_std": float(claimed[:, j].mean() / truth[j]),
                "coverage": float(covered[:, j].mean()),
            }
            for j, name in enumerate(names)
        },
        "coverage": float(covered.mean()),
    }
