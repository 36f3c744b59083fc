"""Estimates of parameters: a trial of the thesis, and what an input says before any fit.

A trial has noise of its own; its estimates are compared with the truth. Information of an input is
the std that it promises for robots that differ, and whether the limits are kept.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf
from typing import Any

import numpy as np

from identification.errors import refuse_negative, refuse_number, unknown_name
from identification.report.page.page import Section, Table
from identification.sweep.log_methods import ESTIMATES, estimate_findings
from identification.sweep.method import Column, Findings, Method, Record, Seed
from identification.sweep.settings import LOGARITHMIC, setting
from identification.sweep.statistics import said, wilson


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


DESIGNED = "designed"
VARIED = ("lambda", "b", "J", "b_v", "b_c", "K_t")


@dataclass(frozen=True, kw_only=True)
class ExcitationSettings:
    """An input, and the robots that it meets; every field says what it is in its metadata.

    Raises:
        InputError: there is no such input, or a number is out of its range.
    """

    input: str = setting('"designed" by a search, or a standard input of `inca excite`')
    duration: float = setting("length of the experiment, 0.2 s or more [s]", 5.0)
    noise: float = setting("std of the noise on each angle, above 0 [rad]", 6.7e-4)
    spread: float = setting(
        "parameters differ from the nominal ones by up to this share, 0 or more and below 1", 0.1
    )
    budget: int = setting("evaluations of the search for a designed input, 1 or more", 20)

    def __post_init__(self) -> None:
        from inca_mj.workflows.recipes import standard_inputs

        known = [DESIGNED, *(name for name, _ in standard_inputs(2))]
        if self.input not in known:
            raise unknown_name("input", self.input, known)
        refuse_number("duration", self.duration, 0.2 <= self.duration < inf, "0.2 s or more")
        refuse_number("noise", self.noise, 0 < self.noise < inf, "a number above 0 [rad]")
        refuse_number("spread", self.spread, 0 <= self.spread < 1, "0 or more and below 1")
        refuse_number("budget", self.budget, self.budget >= 1, "1 or more")


def excitation(settings: ExcitationSettings, seed: Seed) -> dict[str, Any]:
    """Draw a robot and compute the information that the input gives of its parameters.

    Raises:
        InputError: no input that was tried keeps the limits, or nothing shows in the angles.
        DivergenceError: the robot cannot be simulated under the input.
    """
    from inca_mj.robot.parameters import parameter_set
    from inca_mj.twin.run import simulate
    from inca_mj.twin.twin import build_twin
    from inca_mj.workflows.excitation import Bench, excite
    from inca_mj.workflows.identification import UNKNOWN
    from inca_mj.workflows.limits import Limits
    from inca_mj.workflows.recipes import SAMPLING, standard_inputs

    factors = 1 + settings.spread * seed.generator().uniform(-1, 1, len(VARIED))
    nominal = parameter_set("trial").values()
    values = {n: f * nominal[n] for n, f in zip(VARIED, factors.tolist(), strict=True)}
    robot, limits = build_twin(visual=False).with_values(values), Limits()
    if settings.input == DESIGNED:
        tried = excite(
            robot, settings.duration, noise=settings.noise, free=UNKNOWN, limits=limits,
            budget=settings.budget, seed=seed.number(),
        ).best  # fmt: skip
    else:
        currents = dict(standard_inputs(round(settings.duration / SAMPLING) + 1))[settings.input]
        bench = Bench(robot, settings.noise, UNKNOWN, limits)
        tried = bench.attempt(settings.input, simulate(robot, currents, SAMPLING))
    found = tried.found
    return {
        "names": [*found.names[: found.asked]], "std": [*map(float, found.std)],
        "worst_std": float(found.e_value**-0.5), "allowed": bool(tried.allowed),
    }  # fmt: skip


def excitation_findings(records: Sequence[Record]) -> Findings:
    """Returns the std of each parameter by input: geometric means over the robots."""
    inputs = list(dict.fromkeys(r["set.input"] for r in records))
    names = list(dict.fromkeys(n for r in records for n in r["names"]))
    found, rows = {}, []
    for each in inputs:
        chosen = [r for r in records if r["set.input"] == each]
        std = {
            n: _mean([r["std"][r["names"].index(n)] for r in chosen if n in r["names"]])
            for n in names
        }
        worst = _mean([r["worst_std"] for r in chosen])
        kept = wilson(sum(r["allowed"] for r in chosen), len(chosen))
        found[each] = {"std": std, "worst_std": worst, "allowed": kept}
        rows.append((each, len(chosen), worst, *std.values(), said(kept)))
    head = ("input", "robots", "worst direction", *names, "keeps the limits")
    text = "Relative std of estimates, from the Fisher information; geometric means over robots."
    table = Table(head, tuple(rows))
    return Findings({"inputs": found}, [Section("std by input", text, _figures(found), table)])


def _mean(values: Sequence[float]) -> float | None:
    finite = [v for v in values if np.isfinite(v) and v > 0]
    return float(np.exp(np.mean(np.log(finite)))) if finite else None


def _figures(found: dict[str, Any]) -> tuple[tuple[str, Any], ...]:
    import matplotlib
    from matplotlib.figure import Figure

    from identification.report.page.style import SERIES, STYLE

    names = list(next(iter(found.values()))["std"])
    with matplotlib.rc_context(STYLE):
        figure = Figure((7.2, 3.8), layout="constrained")
        ax = figure.subplots()
        for k, (each, row) in enumerate(found.items()):
            at = [i + 0.7 * (k / max(1, len(found) - 1) - 0.5) for i in range(len(names))]
            ax.plot(at, [row["std"][n] or np.nan for n in names], "o", ms=4, label=each,
                    color=SERIES[k % len(SERIES)])  # fmt: skip
        ax.set_yscale("log")
        ax.set_xticks(range(len(names)), names)
        ax.set(ylabel="relative std" + LOGARITHMIC)
        figure.legend(loc="outside right upper", fontsize=7)
    return (("Relative std of each parameter by input", figure),)


EXCITATION = Method(
    about="computes what an input says of the parameters of a robot drawn by chance",
    settings=ExcitationSettings,
    columns={
        "names": Column(list[str], "parameters"),
        "std": Column(list[float], "std of their estimates, relative"),
        "worst_std": Column(float, "std along the worst determined direction, relative"),
        "allowed": Column(bool, "whether currents, tensions and pose stay within the limits"),
    },
    run=excitation,
    summary=excitation_findings,
)
