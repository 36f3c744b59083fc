"""The trials of the thesis (see `inca_mj.workflows.thesis`), with the estimator of this project."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from identification.chances import normal_level
from identification.errors import refuse_negative, unknown_name
from identification.estimation.estimation import Options, estimate
from identification.estimation.fit import Fit, assess
from identification.estimation.metrics import fit_percent, loss
from identification.progress import counted
from identification.quantities import finite_or_none
from inca_mj.robot.parameters import parameter_set
from inca_mj.twin.twin import build_twin
from inca_mj.workflows.thesis import NOISE, TRIALS, Trial, trial_data, with_noise


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
                {
                    "name": str(c),
                    "value": value,
                    "std": float(std) if np.isfinite(std) else None,
                    "true": c.value(true),
                }
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
    """Run a trial from the thesis' starts.

    Args:
        trial: the trial.
        seed: seed of the noise.
        options: how to search; `Options(horizons=(1.0,))` is the thesis' single free-run fit.
        progress: is told one line per accepted step.
    """
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
