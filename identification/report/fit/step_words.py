"""What the steps of the simulation make of a fit's error and values, in sentences.

    e(Δ/4) = λ e(Δ)        λ of `StepShift` and `Fit`, over windows and along a free run
    e(0)² ≈ e(Δ/4)² - (e(Δ)² - e(Δ/4)²)/(F² - 1),  F = 4      of an error that is proportional to Δ

An error that a quarter of the step takes away is none of the model. Where the quarter still errs by
more than the noise, and Δ = 0 may not, nobody knows before the steps are finer.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from identification.estimation.fit import Fit
from identification.estimation.uncertainty import share_left
from identification.model.protocol import FINER
from identification.quantities import quantity
from identification.report.fit.fitted_values import first_few, matters

if TYPE_CHECKING:  # it is slow to import
    from identification.prediction.records_fit import RecordsFit

# "all": nothing above the noise is left with finer steps; "most": that may be so; "no": it is not.
Part = Literal["all", "most", "no"]


def part_of_steps(fit: Fit | RecordsFit, ratio: float, most: float) -> Part:
    """Returns how much of an error comes from the steps of the simulation.

    Args:
        fit: that has ended.
        ratio: the error over the noise.
        most: of such a ratio that is noise.
    """
    left = _left(fit)
    if not ratio > most or left >= 1:
        return "no"
    if ratio * left <= most:
        return "all"
    at_zero = left**2 - (1 - left**2) / (FINER**2 - 1)
    return "most" if at_zero * ratio**2 <= most**2 else "no"


def steps_answer(fit: Fit | RecordsFit, part: Part, of_what: str) -> str:
    """Returns the first sentence of a fit whose error comes from the steps of the simulation.

    Args:
        fit: that has ended.
        part: how much of its error does.
        of_what: says how large the error is.
    """
    write = f'write timestep="{_step(fit) / FINER:.6g}" into the <option> of the model'
    if part == "all":
        return (
            f"The steps of the simulation are too coarse, and nothing else shows: {of_what}, and a"
            f" quarter of the step takes away what is above it; {write}, and run the command again."
        )
    return (
        f"Whether the model explains the log is not known before its steps are finer: {of_what},"
        f" and most of it comes from the steps; {write}, and run the command again."
    )


def free_run_steps(fit: Fit) -> list[str]:
    """Returns a sentence on what a finer step would change, where this is most of the std."""
    plant, own = fit.estimate.predictor.plant, _step(fit)
    units = {p.name: p.unit for p in plant.parameters}
    moves = dict(zip(fit.estimate.space.names, fit.step_shift.tolist(), strict=True))
    told = [
        f"{name} by {moves[name]:+z.2g}"
        for name in fit.far
        if matters(moves[name], fit.values[name], units[name], own)
    ]
    if not told:
        return []
    step = own / FINER
    return [
        f"A quarter of the model's step, {quantity(step, unit='s')}, would move"
        f" {first_few(told, '; ')}. The std include this; for smaller ones write"
        f' timestep="{step:.6g}" into the <option> of the model, and run the command again.'
    ]


def _left(fit: Fit | RecordsFit) -> float:
    """Returns the share of the rms error that a quarter of the step leaves: 1 where all of it."""
    return share_left(fit.step_error) if isinstance(fit, Fit) else fit.model.finer.left


def _step(fit: Fit | RecordsFit) -> float:
    """Returns the step of the user's model [s]."""
    plant = fit.estimate.predictor.plant if isinstance(fit, Fit) else fit.model.plant
    return float(plant.model.opt.timestep)
