"""inca identify LOG: estimate the twin's parameters from a log."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import tyro

import inca_mj as inca
from identification.commands.common import Output, conclude, draw_report, flat, parameter_table
from identification.commands.stopping import STOPPED
from identification.errors import InputError
from inca_mj.commands.common import Robot, Trust, do_not_draw

if TYPE_CHECKING:
    from identification.estimation.fit import Fit
    from identification.estimation.profiles import Profile


@dataclass(frozen=True, kw_only=True)
class Identify:
    """Estimate parameters and start pose on the first half of a log, confirm on the second.

    Examples:
        inca identify examples/log.csv --out out/identify
        inca identify examples/log.csv --free lambda b J K_t --profile K_t
    """

    log: Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="LOG")]
    """Log to learn from; its TOML may name the splits estimation and validation."""
    free: Annotated[tuple[str, ...] | None, tyro.conf.arg(metavar="NAME")] = None
    """Parameters to estimate in one step; the two-step procedure when none is named."""
    procedure: Literal["usual", "thesis"] = "usual"
    """Two steps: usual, or with exactly what the thesis' Tables 3.7 and 3.8 free and fix."""
    criterion: Literal["trace", "det"] = "trace"
    """Least squares, or maximum likelihood with the noise covariance estimated."""
    method: Literal["trf", "lm", "dogbox"] = "trf"
    """Search method of scipy.optimize.least_squares."""
    loss: Literal["linear", "soft_l1", "huber", "cauchy", "arctan"] = "linear"
    """Robust loss against outliers."""
    horizons: tuple[float, ...] = (0.05, 0.2, 0.5, 1.0)
    """Growing fractions of the data; 1.0 alone is a single free-run fit, as in the thesis."""
    starts: int = 1
    """How many starts each search may try, until one ends near the noise floor."""
    seed: int = 0
    """Of the starts after the first."""
    windows: Annotated[float | None, tyro.conf.arg(metavar="SECONDS")] = None
    """Length [s] of windows that each begin anywhere; one free run when not given."""
    innovations: bool = False
    """Also estimate an unlogged error of the currents, by a Kalman predictor."""
    profile: Annotated[tuple[str, ...], tyro.conf.arg(metavar="NAME")] = ()
    """Estimated parameters to profile: refit the others at 9 values of each."""
    trust: Trust = ()
    """Checks of the log that you overrule: sensors, units, wiring."""
    robot: Robot = Robot()
    output: Output = Output()

    def run(self) -> int:
        """Identify, say, keep."""
        do_not_draw()
        from identification.estimation.profiles import profile
        from inca_mj.report.identification import identification_json, profile_sentence

        result = self._identify()
        profiles = [profile(result.fit_of(name), name) for name in self.profile]
        best = identification_json(result, profiles, self.seed)
        steps = [
            f"step {k} of {len(result.fits)}\n{summary(result, fit)}\n"
            for k, fit in enumerate(result.fits, 1)
        ]
        lines = [*steps, *map(profile_sentence, profiles)]
        if len(result.fits) > 1:
            lines.append(f"step {result.best + 1} predicts unseen data best.")
        if result.stopped:  # whoever stopped it does not wait for a model and figures
            conclude(self, best, "\n".join(lines))
            return STOPPED
        shown = cache(partial(compared, result, self.robot))
        conclude(
            self, best, "\n".join(lines),
            keep=lambda out: shown().run.twin.save(out / "model.xml"),
            draw=lambda out: draw(result, profiles, shown(), out),
        )  # fmt: skip
        return 0

    def _identify(self) -> inca.Identification:
        """Returns the identification that the options ask for, or refuses a contradiction."""
        from identification.estimation.estimation import Options
        from inca_mj.workflows.identification import (
            MECHANICS,
            POSE,
            STEP_1,
            identify,
            identify_as_thesis,
        )

        options = Options(
            method=self.method, criterion=self.criterion, loss=self.loss, horizons=self.horizons
        )
        free, known = self.free or (), (*MECHANICS, *POSE)
        given = {"--windows": self.windows is not None, "--innovations": self.innovations}
        alone = [name for name, is_given in given.items() if is_given]
        is_thesis = self.procedure == "thesis"
        for is_wrong, sentence in (
            (self.free == (),
             f"--free names no parameter; name some of {', '.join(known)}, or leave it out for the"
             " two steps"),
            (alone and (options != Options() or self.starts != 1 or self.profile),
             f"{''.join(alone[:1])} is a search of its own; leave out --criterion, --method,"
             " --loss, --horizons, --starts and --profile"),
            (len(alone) > 1, "--windows and --innovations are two searches; choose one"),
            (is_thesis and (free or alone or self.starts != 1),
             "--procedure thesis says what is free and where it begins; leave out --free,"
             " --windows, --innovations and --starts"),
        ):  # fmt: skip
            if is_wrong:
                raise InputError(sentence)
        trust = flat(self.trust)
        log = inca.read_inca_log(self.log, trust)
        parameters, place = self.robot.parameters(), self.robot.place()
        common: Any = {
            "free": free, "progress": self.output.tell, "timestep": self.robot.step, "trust": trust
        }  # fmt: skip
        if self.windows is not None:
            return inca.identify_windows(log, self.windows, parameters, place, **common)
        if self.innovations:
            return inca.identify_innovations(log, parameters, place, **common)
        estimated = free or (tuple(STEP_1) if is_thesis else known)
        for name in self.profile:
            if name not in estimated:
                raise InputError(
                    f"{name!r} is not estimated; profile one of {', '.join(estimated)}"
                )
        if is_thesis:
            del common["free"]
            return identify_as_thesis(log, parameters, place, options=options, **common)
        return identify(
            log, parameters, place, options=options, starts=self.starts, seed=self.seed, **common
        )


def summary(result: inca.Identification, fit: Fit) -> str:
    """Returns a fit as a text table and its verdict."""
    from identification.estimation.metrics import mean_fit
    from identification.report.fit.verdict import fit_verdict
    from inca_mj.report.identification import identification_verdict, rows

    seconds = fit.estimate.seconds + (result.windows.seconds if result.windows else 0.0)
    return (
        parameter_table(rows(result, fit))
        + f"\nfit {mean_fit(fit.fit_percent)}, {seconds:.1f} s\n"
        + "\n".join(identification_verdict(result) if fit is result.fit else fit_verdict(fit))
    )


def compared(result: inca.Identification, robot: Robot) -> inca.Comparison:
    """Returns the log beside a run of the identified model."""
    from inca_mj.twin.logs import UNJUDGED

    plant = result.fit.estimate.predictor.plant
    final = plant.parameters.with_values(result.values, "fitted to the log")
    place, step = robot.place(), robot.step
    return inca.compare(result.log, final, place, timestep=step, trust=UNJUDGED)  # judged before it


def draw(
    result: inca.Identification, profiles: Sequence[Profile], shown: inca.Comparison, out: Path
) -> None:
    """Write figures and the one-file report into a folder."""
    from identification.report.fit.headline import fit_headline
    from inca_mj.report.identification import fit_section, identification_verdict, profile_section
    from inca_mj.report.information import information_section
    from inca_mj.report.sections import compare_section
    from inca_mj.twin.section import model_section

    about = (
        f"What {result.log.name} says of the parameters at their estimate, for white noise of the"
        " size of the noise floor."
    )
    sections = [
        *(fit_section(result, fit, f"Step {k}") for k, fit in enumerate(result.fits, 1)),
        *(profile_section(result.fit_of(known.name), known) for known in profiles),
        information_section(result.fit.information, about),
        compare_section(shown),
        model_section(shown.run.twin),
    ]
    title, verdict = f"{result.log.name}: identified", identification_verdict(result)
    units = {p.name: p.unit for p in result.fit.estimate.predictor.plant.parameters}
    head = fit_headline(result.fit, units)
    draw_report(out, title, verdict, sections, data=[result.log.name], headline=head)
