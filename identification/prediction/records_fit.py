"""Parameters fitted to the windows of one or several records, and judged on unseen ones.

    D = σ H σ,   H = Σ_w S_wᵀ(I - P_w) S_w,   D v = λ v

σ are the std of what was known before. Along q = σ v with λ < 1 the windows tell less than that:
there the fitted values are those of the prior, whatever their std.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from identification.discovery.attempts import attempt
from identification.discovery.nominal_model import NominalModel, without_starts
from identification.discovery.options import DiscoveryOptions
from identification.errors import InputError
from identification.logs.log import Log
from identification.prediction.fits.model import WindowModel
from identification.prediction.fits.nominal_fit import begin, fit_nominal
from identification.prediction.fits.record_errors import (
    RecordError,
    error_of_all,
    errors_by_unit,
    record_errors,
)
from identification.prediction.fits.std import is_told_by_few
from identification.prediction.judging.extension import as_last_fit
from identification.prediction.judging.trial import find_doubt
from identification.runtime.pool import one_blas_thread
from identification.runtime.progress import Progress
from identification.windows.comparison import Prediction, compare
from identification.windows.fit import WindowFit
from identification.windows.problem import no_moves
from identification.windows.records import Record, as_records
from identification.windows.settling import settle
from identification.windows.unseen import Unseen, predict

NO_HORIZON = (
    "records are judged by predictions over a horizon, and none is given; write horizon = 0.2 (in"
    " seconds) into the robot's file"
)


@dataclass(frozen=True, kw_only=True)
class RecordsFit:
    """The result of a fit of records, and its predictions of those that it has not seen."""

    records: tuple[Record, ...]  # what was fitted and what confirms
    horizon: float  # over which records are predicted [s]
    model: WindowModel  # the fitted model
    start: np.ndarray  # the values with which the fit began, in their units, shape (p,)
    begun: Unseen  # errors of these values on the records that confirm
    seconds: float  # wall time [s]

    @property
    def values(self) -> dict[str, float]:
        """The fitted values by name, in their units; a record's own ones are `name [record]`."""
        return self.model.fit.values

    @property
    def shared(self) -> dict[str, float]:
        """The fitted values that hold for all records."""
        return self.model.fit.shared

    @property
    def own_values(self) -> dict[str, dict[str, float]]:
        """The values that each record has for itself, by record and by name, in their units."""
        return self.model.own_values

    @property
    def stopped(self) -> bool:
        """Tells whether the user stopped the search, which keeps no values over a horizon."""
        return False

    @property
    def converged(self) -> bool:
        """Tells whether the search ended by itself."""
        return self.model.fit.converged

    @property
    def std(self) -> np.ndarray:
        """Std of each value by blocks of windows and by the steps, in its unit, shape (p,).

        NaN where it lies on a bound; inf where no window tells of it.
        """
        return np.array([*self.model.told_std.values()])

    @property
    def is_told_by_few(self) -> np.ndarray:
        """True where few windows tell of a value, shape (p,); its std takes them for usual."""
        return is_told_by_few(self.model.fit)

    @property
    def at_bound(self) -> np.ndarray:
        """True where a value lies on a bound, shape (p,)."""
        fit = self.model.fit
        return fit.problem.prior.space.on_bound(fit.q)

    @property
    def own(self) -> Mapping[str, Mapping[str, tuple[float, float]]]:
        """The own values of each record that confirms, and their std."""
        return self.model.unseen.own

    @property
    def rms(self) -> float:
        """Rms error of the windows that were fitted, in `unit`."""
        return error_of_all(self._fitted_squares, self.model.scale, self.records[0].log)

    @property
    def rms_by_unit(self) -> dict[str, float]:
        """Rms error of the windows that were fitted, by the outputs' units, each in its unit."""
        return errors_by_unit(self._fitted_squares, self.model.scale, self.records[0].log)

    @property
    def unseen_rms(self) -> tuple[float, float]:
        """Rms errors on the records that confirm: begun and fitted, in `unit`."""
        before, after = (
            error_of_all(np.concatenate(u.of_outputs), self.model.scale, self.records[0].log)
            for u in (self.begun, self.model.unseen)
        )
        return before, after

    @property
    def unseen_by_unit(self) -> dict[str, float]:
        """Rms errors of the fitted values on the records that confirm, by the outputs' units."""
        squares = np.concatenate(self.model.unseen.of_outputs)
        return errors_by_unit(squares, self.model.scale, self.records[0].log)

    @property
    def noise_rms(self) -> float:
        """Rms of the sensors' noise, in `unit`."""
        return error_of_all(self.model.unseen.noise, self.model.scale, self.records[0].log)

    @property
    def noise_by_unit(self) -> dict[str, float]:
        """Rms of the sensors' noise by the outputs' units, each in its unit."""
        return errors_by_unit(self.model.unseen.noise, self.model.scale, self.records[0].log)

    @property
    def unit(self) -> str:
        """The unit of errors over all outputs; empty where these have several, or none."""
        return self.records[0].log.output_unit

    @property
    def _fitted_squares(self) -> np.ndarray:
        """Mean squares of the windows that were fitted in units of s², shape (W, ny)."""
        scale = self.model.scale
        return np.concatenate([np.mean((e / scale) ** 2, axis=1) for e in self.model.fit.errors])

    @cached_property
    def errors(self) -> tuple[RecordError, ...]:
        """Errors by record, with the values with which the fit began and with the fitted ones."""
        fit, scale = self.model.fit, self.model.scale
        begun = _begun_errors(fit, fit.problem.prior.space.encode(self.start))
        unseen = self.begun, self.model.unseen
        return record_errors(self.records, scale, unseen, (begun, fit.errors))

    @property
    def worse(self) -> Prediction | None:
        """The proof that it predicts unseen records worse than the values with which it began.

        None where that is not proven.
        """
        found = compare(self.model.unseen, self.begun)
        return found if find_doubt(found, 1, DiscoveryOptions()) is None else None

    @property
    def blind(self) -> np.ndarray:
        """Directions of q that the windows tell less of than was known before, shape (k, p)."""
        weight = self.model.fit.problem.prior.weight
        σ = 1 / np.where(weight > 0, weight, 1.0)
        H = self.model.fit.information
        λ, v = np.linalg.eigh(σ[:, None] * H * σ)
        rows = (σ[:, None] * v[:, λ < 1]).T
        return np.asarray(rows / np.linalg.norm(rows, axis=1, keepdims=True))


@one_blas_thread()
def fit_records(
    nominal_model: NominalModel,
    fit: Sequence[Log],
    confirm: Sequence[Log] = (),
    progress: Progress | None = None,
) -> RecordsFit:
    """Fit the free parameters of a model to records, over windows of its horizon.

    Args:
        nominal_model: the model, its free parameters, what is known of them, and the horizon.
        fit: logs to fit.
        confirm: logs that the fit may not see; where there is none, the first half of each log is
            fitted and the second half confirms.
        progress: is told one line per linearisation.

    Raises:
        InputError: there is no horizon, windows do not fit a log, or a parameter has no effect.
        DivergenceError: the values with which the fit begins cannot be simulated.
    """
    base = without_starts(nominal_model)
    if base.horizon is None:
        raise InputError(NO_HORIZON)
    clock = time.perf_counter()
    records = as_records(fit, confirm)
    unseen = [r for r in records if r.role == "confirm"]
    found = fit_nominal(base, records, progress)
    model = (
        attempt(None, partial(as_last_fit, found, base.horizon, unseen, is_weighed=False)) or found
    )
    begun = predict(model.plant, unseen, base.horizon, model.scale, {}, model.unseen)
    unknowns = model.fit.problem.unknowns
    start = unknowns.all.space.decode(begin(base, unknowns))
    return RecordsFit(
        records=records, horizon=base.horizon, model=model, start=start, begun=begun,
        seconds=time.perf_counter() - clock,
    )  # fmt: skip


def _begun_errors(fit: WindowFit, q: np.ndarray) -> list[np.ndarray]:
    """Returns y - ŷ of the fitted windows at q (p,), where the fit began, (W, L, ny) a record."""
    problem = fit.problem
    settled = settle(problem.held(q), no_moves(problem))
    return [part.error(s.r) for part, s in zip(problem.parts, settled, strict=True)]
