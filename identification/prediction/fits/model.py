"""A model with some effects, fitted to the windows of several records and judged on others.

`identification.prediction.fits.nominal_fit` makes the model without effects, and
`identification.prediction.judging.extension` those with one more, or with fewer.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from identification.discovery.fitted import StepShift
from identification.effects.effect import Candidate
from identification.estimation.uncertainty import with_steps
from identification.logs.noise import noise_floor
from identification.model.predictor import Plant
from identification.prediction.fits.std import step_shift, told_std
from identification.windows.fit import WindowFit
from identification.windows.own_values import Own
from identification.windows.records import Record
from identification.windows.unseen import LENGTHS, Unseen, predict


def held_values(candidates: Sequence[Candidate]) -> dict[str, float]:
    """Returns the values of some effects' shapes, and of sizes that have one value alone, by name.

    Args:
        candidates: the effects.
    """
    return {n: v for c in candidates for n, v in (*c.fixed.items(), *c.whole.items())}


@dataclass(frozen=True)
class WindowModel:
    """A model with some effects."""

    candidates: tuple[Candidate, ...]  # the effects, with their shapes as they began
    fit: WindowFit  # on the windows of the fitted records
    unseen: Unseen  # its errors on the records that confirm
    scale: np.ndarray  # rms error of each output under the nominal model, shape (ny,), in its unit

    @property
    def plant(self) -> Plant:
        """The plant with its own values."""
        return self.fit.problem.parts[0].predictor.plant

    @property
    def held(self) -> dict[str, float]:
        """Values of its effects that hold whatever is fitted: their shapes, and what is there."""
        return held_values(self.candidates)

    @property
    def values(self) -> dict[str, float]:
        """Values of all parameters that are not the plant's own and hold for all records."""
        return {**self.held, **self.fit.shared}

    @property
    def fitted_power(self) -> float:
        """Mean square of the errors of the fitted windows in units of s²."""
        squares = sum(float(np.sum((e / self.scale) ** 2)) for e in self.fit.errors)
        return squares / sum(e.size for e in self.fit.errors)

    @property
    def powers_of_outputs(self) -> np.ndarray:
        """Mean square of the errors of the fitted windows by output, (ny,), in units of s²."""
        each = [(e / self.scale).reshape(-1, len(self.scale)) for e in self.fit.errors]
        return np.asarray(np.mean(np.concatenate(each) ** 2, axis=0))

    @property
    def told_values(self) -> dict[str, float]:
        """`values`, and what each fitted record has for itself as `name [record]`."""
        return {**self.values, **self.fit.values}

    @property
    def own_values(self) -> dict[str, dict[str, float]]:
        """Values that each record has for itself, by record and by name, in their units.

        Those of fitted records are fitted, those of others the mean of what their halves tell.
        """
        unknowns = self.fit.problem.unknowns
        names = unknowns.own.names
        each = {r: self.fit.of_record(k) for k, r in enumerate(unknowns.records)}
        fitted = {r: {n: values[n] for n in names} for r, values in each.items()}
        told = {r: {n: v for n, (v, _) in own.items()} for r, own in self.unseen.own.items()}
        return {r: own for r, own in {**told, **fitted}.items() if own}

    @property
    def at_bound(self) -> tuple[str, ...]:
        """Names of the free values that lie on a bound."""
        on_bound = self.fit.problem.prior.space.on_bound(self.fit.q)
        return tuple(n for n, at in zip(self.fit.problem.names, on_bound, strict=True) if at)

    @property
    def told_std(self) -> dict[str, float]:
        """Std of the free values, in which the error of the model's steps counts.

        NaN where a value is on a bound.
        """
        std = with_steps(told_std(self.fit), self.finer.values)
        return dict(zip(self.fit.problem.names, std.tolist(), strict=True))

    @cached_property
    def finer(self) -> StepShift:
        """The change of the fit with a quarter of the model's step."""
        return step_shift(self.fit)

    @property
    def step_shift(self) -> dict[str, float]:
        """The change of each free value with a quarter of the step, in its unit."""
        return dict(zip(self.fit.problem.names, self.finer.values.tolist(), strict=True))

    @property
    def unlearned(self) -> dict[str, float]:
        """Std of each free value over the std that was known before; 0 where none was."""
        prior = self.fit.problem.prior
        slope = np.abs(prior.space.slope(self.fit.q))
        left = prior.weight * told_std(self.fit) / slope
        return dict(zip(self.fit.problem.names, left.tolist(), strict=True))

    @property
    def departures(self) -> dict[str, float]:
        """Change of each free value since before the fit, in std of what was known; 0 without.

        Shapes of effects are left out: of these nothing was known but a grid.
        """
        moved = dict(zip(self.fit.problem.names, -self.fit.problem.prior.against(self.fit.q),
                         strict=True))  # fmt: skip
        effects = {n for c in self.candidates for n in (*c.sizes, *c.fixed)}
        return {n: float(by) for n, by in moved.items() if n.partition(" [")[0] not in effects}

    @property
    def std(self) -> dict[str, float]:
        """Std of the free values by blocks of windows, by name, in their units."""
        return dict(zip(self.fit.problem.names, self.fit.std.tolist(), strict=True))


def predict_fitted(
    plant: Plant, confirm: Sequence[Record], horizon: float, scale: np.ndarray, found: WindowFit,
    fixed: Mapping[str, float], near: Unseen | None = None, others: Sequence[Unseen] = (),
    lengths: Sequence[float] = LENGTHS,
) -> Unseen:  # fmt: skip
    """Returns errors on unseen records; each half's own parameters are told by the other half.

    Where the state of a window is sought, each output weighs by its error in the fitted windows:
    with an s that is forty times its noise, an output would hardly be asked.

    Args:
        plant: the model.
        confirm: records that no fit has seen.
        horizon: [s].
        scale: s of each output, shape (ny,), in its unit.
        found: the fit of other records.
        fixed: values that are neither the plant's own nor fitted.
        near: errors of a model nearby, at whose states the windows' search begins.
        others: of other models, see `predict`.
        lengths: of the windows, in units of the horizon.

    Raises:
        InputError: no window of the horizon fits a record.
        DivergenceError: the model cannot be simulated.
    """
    unknowns, values = found.problem.unknowns, {**fixed, **found.shared}
    m = len(unknowns.own.names)
    start = unknowns.own.mean
    if m:
        start = found.q[len(unknowns.shared.names) :].reshape(-1, m).mean(axis=0)
    own = Own(unknowns.own, start)
    weights = np.minimum(scale, rms_error(found))
    return predict(plant, confirm, horizon, scale, values, near, own, others, lengths, weights)


def rms_error(found: WindowFit) -> np.ndarray:
    """Returns the rms error of each output over the windows, at least the sensors' noise, (ny,)."""
    logs = [p.predictor.log for p in found.problem.parts]
    noise = np.mean([noise_floor(log.outputs) ** 2 for log in logs], axis=0)
    square = np.mean(np.concatenate([np.mean(e**2, axis=1) for e in found.errors]), axis=0)
    return np.sqrt(np.maximum(square, noise) + 1e-300)
