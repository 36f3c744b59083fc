"""Where a model fails over a horizon: in which outputs and windows, and over which lengths.

The forces that it would need are those of `identification.report.discovery.needed_forces`.

    r_y = √(mean (y - ŷ)²)           of an output over windows of the horizon, in its unit
    e_w = √(mean_g Σ_g r_wy²/Σ_g ν_y²)
                                     of a window, how many times the noise it errs; Σ_g: over the
                                     outputs of a unit, ν: the sensors' noise. It is the ratio of
                                     the verdict (`Discovery.times_noise`), of one window
    e(L) = e √(V(L)/V)               over another length: V, V(L) are mean squares in units of s²
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from identification.discovery.result import Discovery
from identification.prediction.fits.model import WindowModel
from identification.quantities import held, quantity
from identification.report.discovery.needed_forces import NeededForces, find_needed
from identification.report.words.parts import records_words
from identification.windows.unseen import Unseen

WORST = 4  # windows that are drawn
NEAR_NOISE = 1.5  # times the noise, below which no window or force is told
APART = 3  # windows between two of them: neighbours fail for the same reason


@dataclass(frozen=True)
class OutputError:
    """The error of one output on windows that are told of, all in `unit`; of two models."""

    name: str
    unit: str
    before: float
    after: float
    noise: float


@dataclass(frozen=True)
class RecordWindows:
    """Errors of the windows of the horizon in one record."""

    name: str  # of the record
    role: str  # "fit" or "confirm"
    time: np.ndarray  # at which each window begins, shape (W,) [s]
    before: np.ndarray  # of the fitted model without effects, how many times the noise, shape (W,)
    after: np.ndarray  # of the final model


@dataclass(frozen=True)
class LengthError:
    """Errors over windows of one length, how many times the noise; of two models."""

    length: float
    before: float
    after: float


@dataclass(frozen=True)
class FailedWindow:
    """A fitted window in which the final model fails, of the output that errs most."""

    record: str  # its name
    output: str  # its name
    unit: str  # of the output
    time: np.ndarray  # of the samples, shape (L,) [s]
    measured: np.ndarray  # shape (L,), in `unit`
    predicted: np.ndarray  # likewise
    ratio: float  # how many times the noise the window errs


@dataclass(frozen=True)
class HorizonGap:
    """What the fitted model without effects, and the final one, fail to predict over a horizon."""

    # the one first that errs most with the final model, in multiples of its noise
    outputs: tuple[OutputError, ...]
    records: tuple[RecordWindows, ...]  # those that were fitted, then those that confirm
    # of windows, over which they were predicted, the shortest first
    lengths: tuple[LengthError, ...]
    is_far: bool  # whether any window errs by more than noise may make
    needed: NeededForces  # forces that the final model would need; none near the noise
    windows: tuple[FailedWindow, ...]  # fitted ones in which the final model fails most


def find_gap(found: Discovery) -> HorizonGap | None:
    """Returns where the models of a discovery fail over its horizon; None along a free run."""
    nominal, final, scale = found.nominal, found.final, found.scale
    if not (isinstance(nominal, WindowModel) and isinstance(final, WindowModel)) or scale is None:
        return None
    told = nominal.unseen.report, final.unseen.report
    noise = final.unseen.noise  # ν²/s² of each output
    ratios = partial(_ratios, units=[*found.outputs.values()], scale=scale, noise=noise)
    rms = [np.sqrt(np.concatenate(u.of_outputs).mean(axis=0)) * scale for u in told]
    each = zip(found.outputs.items(), *rms, np.sqrt(noise) * scale, strict=True)
    outputs = [OutputError(name, unit, *map(float, of)) for (name, unit), *of in each]
    outputs.sort(key=lambda o: -o.after / o.noise if o.noise > 0 else -np.inf)
    parts = [(p.predictor.log, p.cut.starts) for p in final.fit.problem.parts]
    fitted = [
        RecordWindows(
            log.name,
            "fit",
            log.time[starts],
            *(ratios(np.mean((e / scale) ** 2, axis=1)) for e in pair),
        )
        for (log, starts), *pair in zip(parts, nominal.fit.errors, final.fit.errors, strict=True)
    ]
    places = final.unseen.places[final.unseen.lengths.index(1.0)]
    logs = [r.log for r in found.records if r.role == "confirm"]
    squares = nominal.unseen.of_outputs, final.unseen.of_outputs
    confirm = [
        RecordWindows(log.name, "confirm", log.time[at[:, 0]], ratios(a), ratios(b))
        for log, at, a, b in zip(logs, places, *squares, strict=True)
    ]
    of_all = [float(ratios(np.concatenate(u.of_outputs).mean(axis=0)[None])[0]) for u in told]
    every = (*fitted, *confirm)
    is_far = max((float(r.after.max(initial=0.0)) for r in every), default=0.0) > NEAR_NOISE
    return HorizonGap(
        outputs=tuple(outputs), records=every,
        lengths=_lengths(found.horizon or 0.0, told, of_all), is_far=is_far,
        needed=find_needed(found, final) if is_far else NeededForces(),
        windows=_worst(final, [r.after for r in fitted], scale, found.outputs),
    )  # fmt: skip


def _ratios(
    squares: np.ndarray, units: Sequence[str], scale: np.ndarray, noise: np.ndarray
) -> np.ndarray:
    """Returns e_w of windows, shape (W,); of a sensor without noise, its rms error in s.

    The outputs have units, scales s (ny,) in these, and noise ν²/s² (ny,); `squares` are mean
    squares in units of s², shape (W, ny).
    """
    groups = [np.array([u == unit for u in units]) for unit in dict.fromkeys(units)]
    each = []
    for at in groups:
        level = float(scale[at] ** 2 @ noise[at])
        each.append(squares[:, at] @ scale[at] ** 2 / level if level else squares[:, at].sum(1))
    return np.asarray(np.sqrt(np.mean(each, axis=0)))


def _lengths(
    horizon: float, told: Sequence[Unseen], of_all: Sequence[float]
) -> tuple[LengthError, ...]:
    """Returns the errors over each length that both models were judged by.

    The horizon is in [s]; `of_all` is e over it, of the model before and after.
    """
    before, after = told

    def ratio(k: int, length: float) -> float:
        u = told[k]
        square = float(np.concatenate(u.squares[u.lengths.index(length)]).mean())
        return of_all[k] * float(np.sqrt(square / np.concatenate(u.at_horizon).mean()))

    lengths = [n for n in before.lengths if n in after.lengths]
    return tuple(LengthError(horizon * n, ratio(0, n), ratio(1, n)) for n in lengths)


def _worst(
    final: WindowModel, ratios: Sequence[np.ndarray], scale: np.ndarray, outputs: Mapping[str, str]
) -> tuple[FailedWindow, ...]:
    """Returns the fitted windows in which a model fails most, none of them near another.

    By record, `ratios` are how many times the noise each window errs; s (ny,) is each output's
    scale in its unit, which `outputs` names.
    """
    every = [(float(e), k, w) for k, each in enumerate(ratios) for w, e in enumerate(each)]
    errors, names = final.fit.errors, [*outputs]
    taken, out = list[tuple[int, int]](), list[FailedWindow]()
    for ratio, k, w in sorted(every, reverse=True):
        if len(out) == WORST:
            break
        if any(k == j and abs(w - v) < APART for j, v in taken):
            continue
        taken.append((k, w))
        part, error = final.fit.problem.parts[k], errors[k][w]
        log, y = part.predictor.log, int(np.argmax(np.mean((error / scale) ** 2, axis=0)))
        measured = part.cut.outputs[w][:, y]
        time = log.time[part.cut.starts[w] + np.arange(len(measured))]
        out.append(FailedWindow(
            log.name, names[y], outputs[names[y]], time, measured, measured - error[:, y], ratio,
        ))  # fmt: skip
    return tuple(out)


def worst_lines(gap: HorizonGap) -> list[str]:
    """Returns which window errs most, in which record; none where no window is known."""
    most = max(gap.records, key=lambda r: float(r.after.max(initial=0.0)))
    if not len(most.after):
        return []
    at, every = int(np.argmax(most.after)), np.concatenate([r.after for r in gap.records])
    begin, ratio = float(most.time[at]), float(most.after[at])
    return [
        f"the worst window begins at {quantity(begin, unit='s')} of {most.name}, with"
        f" {held(ratio)} times the noise; the median of all windows of"
        f" {records_words([r.name for r in gap.records])} is {held(float(np.median(every)))} times"
        " the noise"
    ]
