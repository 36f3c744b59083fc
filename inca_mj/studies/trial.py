"""A trial of the thesis with noise of its own: estimates against the truth."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from identification.errors import refuse_negative, unknown_name
from identification.sweep.estimates import ESTIMATES, estimate_findings
from identification.sweep.method import Column, Method, Seed
from identification.sweep.words import setting


@dataclass(frozen=True, kw_only=True)
class TrialSettings:
    """The settings of a trial; every field says what it is in its metadata.

    Raises:
        InputError: there is no such trial, or the seed is negative.
    """

    trial: int = setting("number of the trial, 1 to 4; 4 is the one with noise", 4)
    noise_seed: int | None = setting(
        "seed of the noise; from the seed of the task if not given", None
    )
    single: bool = setting(
        "one fit of the whole free run, as the thesis did, in place of a growing horizon", False
    )

    def __post_init__(self) -> None:
        if self.trial not in (1, 2, 3, 4):
            raise unknown_name("trial", str(self.trial), "1234")
        if self.noise_seed is not None:
            refuse_negative("noise_seed", self.noise_seed)


def run_once(settings: TrialSettings, seed: Seed) -> dict[str, Any]:
    """Run the trial from the starts of the thesis.

    Raises:
        InputError: the search ends at values with which the robot cannot start.
        DivergenceError: it ends at values that cannot be simulated.
    """
    from identification.estimation.estimation import Options
    from inca_mj.robot.parameters import parameter_set
    from inca_mj.thesis.trials import TRIALS, run_trial

    options = Options(horizons=(1.0,)) if settings.single else None
    number = seed.number() if settings.noise_seed is None else settings.noise_seed
    result = run_trial(TRIALS[settings.trial - 1], seed=number, options=options)
    estimate, true = result.fit.estimate, parameter_set("trial").values()
    return {
        "names": [*estimate.values], "estimated": [*map(float, estimate.values.values())],
        "std": [*map(float, result.fit.std)], "true": [float(true[n]) for n in estimate.values],
        "output_fit": float(result.output_fit_percent.mean()), "loss": float(result.loss),
        "converged": estimate.status == "converged",
    }  # fmt: skip


TRIAL = Method(
    about="runs a trial of the thesis with noise of its own",
    settings=TrialSettings,
    columns={
        **ESTIMATES,
        "output_fit": Column(float, "mean fit of the angles to the data without noise [%]"),
        "loss": Column(float, "loss function 3.5 of the thesis, for the same data"),
        "converged": Column(bool, "whether the search ended by itself"),
    },
    run=run_once,
    summary=estimate_findings,
)
