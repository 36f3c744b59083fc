"""Design an input that determines the worst determined parameters best, within limits.

    u* = argmax_u  λ_min F(u)      (E-optimal)      so that the simulated run keeps the limits

D-optimality (det F) can be improved by directions that are well determined already; E-optimality
looks at the worst direction. The search begins with random recipes and then changes the best ones;
its seed makes it repeatable. The swing of a recipe that breaks a limit is reduced until it keeps
the limit. The information is local: it holds for a robot near the values for which it was computed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from identification.errors import DivergenceError, InputError, refuse_negative
from identification.estimation.experiment import Experiment
from identification.estimation.information import Information, determinable
from identification.experiment.search import search
from identification.runtime.progress import counted
from inca_mj.robot.parameters import UNKNOWN
from inca_mj.twin.logs import ANGLES
from inca_mj.twin.run import Run, simulate
from inca_mj.twin.twin import Twin, build_twin
from inca_mj.workflows.limits import Extent, Limits, extent
from inca_mj.workflows.recipes import SAMPLING, Recipe, changed, draw, standard_inputs
from inca_mj.workflows.sensitivity import DURATION, NOISE, robot_information

SCALES = (1.0, 0.7, 0.5, 0.35, 0.2)  # tried on a swing that breaks a limit
MOVES = ((0.3, 0.1), (0.1, 0.1), (0.1, 0.3), (0.03, 0.5))  # size of a change, share of numbers

Progress = Callable[[str], None]


@dataclass(frozen=True)
class Tried:
    """An input, its simulation, and the information that it gives."""

    name: str  # in words
    run: Run  # the simulated run
    extent: Extent  # how far currents, tensions and pose went
    found: Information  # information on the parameters, where the start pose is unknown
    allowed: bool  # whether it keeps the limits


@dataclass(frozen=True, kw_only=True)
class Design:
    """A designed input beside the thesis' PRBS and other standard inputs.

    Attributes:
        best: the designed input.
        prbs: the thesis' PRBS of the same length.
        standard: inputs that people try, the thesis' PRBS first.
        held: parameters that were held fixed because the PRBS cannot tell them from others.
        limits: the limits that were kept.
        settings: settings of the designed input; empty when no better one than a standard input
            was found.
        evaluations: how often the information was computed.
    """

    best: Tried
    prbs: Tried
    standard: tuple[Tried, ...]
    held: tuple[str, ...]
    limits: Limits
    settings: dict[str, float]
    evaluations: int

    @property
    def gain(self) -> np.ndarray:
        """Std under the PRBS over std under the design, by parameter, shape (p,)."""
        return self.prbs.found.std / self.best.found.std

    @property
    def worst_gain(self) -> float:
        """Std under the PRBS over std under the design, of the worst direction of each: √(E/E)."""
        return float(np.sqrt(self.best.found.e_value / self.prbs.found.e_value))


def excite(
    robot: Twin | None = None,
    duration: float = DURATION,
    *,
    noise: float = NOISE,
    free: Sequence[str] = UNKNOWN,
    limits: Limits | None = None,
    budget: int = 60,
    seed: int = 0,
    progress: Progress | None = None,
) -> Design:
    """Design the input of an experiment.

    Args:
        robot: the twin, at the values known before the experiment; the thesis' Table 3.2 when None.
        duration: of the experiment [s].
        noise: std of the noise on each angle [rad].
        free: parameters to determine; the start pose is unknown too.
        limits: what the input may do; the usual `Limits` when None.
        budget: evaluations of the information by the search, 2 p simulations each.
        seed: of the search.
        progress: is told of each improvement.

    Raises:
        InputError: a name, noise, duration, seed or limit is bad, or no input that was tried
            keeps the limits.
        DivergenceError: the twin cannot be simulated under the thesis' PRBS.
    """
    robot, limits = robot or build_twin(), limits or Limits()
    n = _samples(duration)
    refuse_negative("seed", seed)
    if budget < 1:
        raise InputError(f"a budget of {budget} evaluations finds nothing; give at least 1")
    _refuse_start(robot, limits)
    bench = Bench(robot, noise, tuple(free), limits)
    first, *rest = standard_inputs(n)
    baseline = bench.attempt(first[0], simulate(robot, first[1], SAMPLING), resolved=True)
    kept, held = determinable(baseline.found)
    if not kept:
        raise InputError("none of these parameters shows in the angles; free others")
    bench = replace(bench, names=kept)
    thesis = replace(baseline, found=baseline.found.about(kept))
    others = [bench.attempt(name, simulate(robot, u, SAMPLING)) for name, u in rest]
    tried = (thesis, *others)
    best = max((t for t in tried if t.allowed), key=lambda t: t.found.e_value, default=None)
    settings: dict[str, float] = {}
    found = counted(_search(bench, n, budget, seed), "inputs", budget)
    for count, (recipe, candidate) in enumerate(found, 1):
        if best is None or candidate.found.e_value > best.found.e_value:
            best, settings = candidate, recipe.settings(limits)
            if progress is not None:
                gain = np.sqrt(best.found.e_value / thesis.found.e_value)
                progress(f"{count} of {budget}: {recipe.kind}, worst direction {gain:.2f} times"
                         " better known than by the thesis' PRBS")  # fmt: skip
    if best is None:
        raise InputError(
            "no input that was tried keeps the limits; allow a smaller tension margin, more"
            " workspace or more current"
        )
    best = bench.attempt(best.name, best.run, resolved=True)
    return Design(
        best=best, prbs=thesis, standard=tried, held=held, limits=limits, settings=settings,
        evaluations=budget,
    )  # fmt: skip


@dataclass(frozen=True)
class Bench:
    """The twin, the noise, the parameters and the limits with which inputs are tried."""

    robot: Twin  # the twin at its nominal values
    sigma: float  # std of the noise on each angle [rad]
    names: tuple[str, ...]  # the parameters of interest; the start pose is unknown too
    limits: Limits  # what an input may do

    def attempt(self, name: str, run: Run, resolved: bool = False) -> Tried:
        """Returns the information that a run gives, from 2 p simulations.

        Twice as many estimate the errors of the sensitivities (`resolved`).
        """
        sampling = float(run.time[1] - run.time[0])
        trial = Experiment(
            plant=self.robot, inputs=run.currents, sampling_time=sampling, outputs=ANGLES,
            sigma=self.sigma,
        )  # fmt: skip
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


def _search(bench: Bench, n: int, budget: int, seed: int) -> Iterator[tuple[Recipe, Tried]]:
    """Yields recipes within the limits, with their information: half random, half near the best."""

    def drawn(tried: int, rng: np.random.Generator) -> Recipe:
        if tried == 0:
            return draw("multisine", rng, guess=True)
        return draw("multisine" if rng.random() < 0.5 else "prbs", rng)

    def attempt(recipe: Recipe) -> tuple[Recipe, Tried] | None:
        fit = bench.fitted(recipe, n)
        return fit and (fit[0], bench.attempt(f"designed {fit[0].kind}", fit[1]))

    return search(
        drawn, lambda best, rng: changed(best, rng, *rng.choice(MOVES)), attempt,
        lambda tried: tried.found.e_value, budget, np.random.default_rng(seed),
    )  # fmt: skip


def _samples(duration: float) -> int:
    if not 0.2 <= duration <= 120.0:
        raise InputError(f"an experiment of {duration:g} s cannot be designed; give 0.2 s to 120 s")
    return round(duration / SAMPLING) + 1


def _refuse_start(robot: Twin, limits: Limits) -> None:
    least = float(robot.start.tension.min())
    if least <= limits.margin:
        raise InputError(
            f"the robot rests with {least:.2f} N in a cable, below the margin of"
            f" {limits.margin:g} N; give a smaller margin"
        )
