"""Errors of a model on records that no fit has seen, over windows of several lengths.

The horizon is predicted first: what it refutes is not predicted over the other lengths. Each model
begins a window at the state that explains it best, found by the same smoother.

A search decides on `select` and tells of `report` (`identification.logs.parts`): on the windows
that lie wholly inside one of these parts of their record. A window on the border belongs to none.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from identification.errors import InputError
from identification.estimation.metrics import fit_percent
from identification.logs.noise import SCATTER, noise_floor
from identification.logs.parts import Part, Parts, inside
from identification.model.coordinates import NOTHING
from identification.model.predictor import Plant, Predictor
from identification.windows.held import held_records
from identification.windows.own_values import Own, of_halves, own_values
from identification.windows.problem import MOST_STEPS, most_windows
from identification.windows.records import Record
from identification.windows.settling import Starts, best_starts, settle, sought_from_others
from identification.windows.shooting import Shooting
from identification.windows.windows import Windows, first_states, spread, windows

LENGTHS = (0.5, 1.0, 2.0)  # of the horizon, over which an effect must predict better
HORIZON = (1.0,)  # the horizon alone
# Of fewer records the median is the mean; of more it has this share of the efficiency of the mean.
FEWEST_OF_MEDIAN, MEDIAN_EFFICIENCY = 3, 2 / np.pi


@dataclass(frozen=True, kw_only=True)
class Unseen:
    """Errors of one model on the records that confirm."""

    lengths: tuple[float, ...]  # of windows, in units of the horizon
    # mean square of each output over each window in units of s², shape (W, ny), by length and
    # record
    powers: tuple[tuple[np.ndarray, ...], ...]
    # where each window begins, shape (W, nx), by length and record
    moves: tuple[tuple[np.ndarray, ...], ...]
    # mean square of the sensors' noise in units of s², shape (ny,): of each output the median over
    # the records; motion that is sampled slowly looks like noise, and an encoder that rests like
    # none
    noise: np.ndarray
    # over windows of the horizon that are told of, of each output, shape (ny,) [%]
    fit_percent: np.ndarray
    # first sample of each window, and the one behind it, shape (W, 2), by length and record
    places: tuple[tuple[np.ndarray, ...], ...]
    # of each record; None where all of it both decides and is told of
    parts: tuple[Parts | None, ...]
    # from how many samples the noise is known; infinite where nobody had to estimate it
    samples: float = np.inf
    # by record, the parameters that it has for itself: value and std of each, from the values of
    # its two halves
    own: Mapping[str, Mapping[str, tuple[float, float]]] = field(default_factory=dict)

    @cached_property
    def squares(self) -> tuple[tuple[np.ndarray, ...], ...]:
        """Mean square of each window over its outputs, shape (W,), by length and record."""
        return tuple(tuple(x.mean(axis=1) for x in of_length) for of_length in self.powers)

    def begun(self, length: float) -> tuple[Starts, ...]:
        """Returns starts and errors of windows of a length, in units of the horizon, by record."""
        k = self.lengths.index(length)
        return tuple(Starts(*pair) for pair in zip(self.moves[k], self.squares[k], strict=True))

    def plus(self, other: Unseen) -> Unseen:
        """Returns the errors with other lengths; those of `other` count where both have them.

        Args:
            other: of the same model, on the same records.
        """
        each = {n: (u.powers[k], u.moves[k], u.places[k]) for u in (self, other)
                for k, n in enumerate(u.lengths)}  # fmt: skip
        lengths = tuple(sorted(each))
        powers, moves, places = zip(*(each[n] for n in lengths), strict=True)
        return replace(
            other if 1.0 in other.lengths else self,
            lengths=lengths, powers=powers, moves=moves, places=places,
        )  # fmt: skip

    @cached_property
    def select(self) -> Unseen:
        """The errors on which a search decides."""
        return self._of("select")

    @cached_property
    def report(self) -> Unseen:
        """The errors that are told, on which no search has decided."""
        return self._of("report")

    def _of(self, part: Part) -> Unseen:
        """Returns the errors of the windows that lie inside a part of their record."""
        if not any(self.parts):
            return self
        kept_at = [
            [inside(p, part, at) for p, at in zip(self.parts, places, strict=True)]
            for places in self.places
        ]

        def kept(each: Sequence[np.ndarray], k: int) -> tuple[np.ndarray, ...]:
            return tuple(x[at] for x, at in zip(each, kept_at[k], strict=True))

        every = range(len(self.lengths))
        return replace(
            self,
            powers=tuple(kept(self.powers[k], k) for k in every),
            moves=tuple(kept(self.moves[k], k) for k in every),
            places=tuple(kept(self.places[k], k) for k in every),
            parts=(None,) * len(self.parts),
        )  # fmt: skip

    @property
    def floor(self) -> float:
        """Mean square of the sensors' noise over all outputs, in units of s²."""
        return float(np.mean(self.noise))

    @property
    def floor_std(self) -> float:
        """Std of the estimate of `floor`, a share of it."""
        shares = self.noise / (np.sum(self.noise) + np.finfo(float).tiny)
        return float(np.sqrt(SCATTER / self.samples * np.sum(shares**2)))

    @property
    def of_outputs(self) -> tuple[np.ndarray, ...]:
        """Mean squares of each output over windows of the horizon itself, (W, ny) a record."""
        return self.powers[self.lengths.index(1.0)]

    @property
    def at_horizon(self) -> tuple[np.ndarray, ...]:
        """Mean squares over windows of the horizon itself, one array a record."""
        return self.squares[self.lengths.index(1.0)]


def predict(
    plant: Plant,
    records: Sequence[Record],
    horizon: float,
    scale: np.ndarray,
    values: Mapping[str, float],
    near: Unseen | None = None,
    own: Own | None = None,
    others: Sequence[Unseen] = (),
    lengths: Sequence[float] = LENGTHS,
    weights: np.ndarray | None = None,
) -> Unseen:
    """Returns the errors of a model on records, over windows of several lengths.

    Parameters that a record has for itself are fitted to one half of its windows, and judged on
    the other half.

    Args:
        plant: the model.
        records: that no fit has seen.
        horizon: [s].
        scale: s of each output, shape (ny,), in its unit.
        values: parameters that are not the plant's own.
        near: errors of a model nearby, at whose states the windows' search begins.
        own: parameters that each record has for itself.
        others: errors of other models; `near` is then of this model itself, and only windows that
            others begin with less error are sought again, from there.
        lengths: which, in units of the horizon; one that fits no record is left out, but for the
            horizon itself.
        weights: rms error by which each output weighs where the state of a window is sought, shape
            (ny,), in its unit; s where None.

    Raises:
        InputError: no window of the horizon fits a record.
        DivergenceError: the model cannot be simulated.
    """
    if near is not None and others:
        lengths = [n for n in lengths if _is_better_elsewhere(near, others, n)]
        if not lengths:
            return near
    powers, moves, places, told = [], [], [], []
    percent = np.zeros(len(scale))
    halves = [own_values(plant, r, horizon, scale, values, own or Own()) for r in records]
    weights = scale if weights is None else weights
    for factor in lengths:
        try:
            length = factor * horizon
            cuts = cut_unseen(plant, records, length, is_horizon=factor == 1.0)
        except InputError:
            if factor == 1.0:
                raise
            continue  # fewer than 3 samples, or longer than a record
        begun = near.begun(factor) if near is not None and factor in near.lengths else None
        each = _settled(plant, records, cuts, weights, values, halves, begun,
                        [o.begun(factor) for o in others if factor in o.lengths])  # fmt: skip
        if factor == 1.0:
            at = [inside(r.parts, "report", c.places)
                  for r, c in zip(records, cuts, strict=True)]  # fmt: skip
            measured, errors = (
                np.concatenate([x[k].reshape(-1, len(scale)) for x, k in zip(of, at, strict=True)])
                for of in ([c.outputs for c in cuts], [e for _, e in each])
            )
            percent = fit_percent(measured, measured - errors)
        told.append(factor)
        moves.append(tuple(d for d, _ in each))
        places.append(tuple(c.places for c in cuts))
        powers.append(tuple(np.mean((e / scale) ** 2, axis=1) for _, e in each))
    noise = np.median([noise_floor(r.log.outputs) for r in records], axis=0)
    found = Unseen(
        lengths=tuple(told), powers=tuple(powers), moves=tuple(moves),
        noise=(noise / scale) ** 2, samples=_samples(records), fit_percent=percent,
        places=tuple(places), parts=tuple(r.parts for r in records),
        own={r.log.name: of_halves(*h) for r, h in zip(records, halves, strict=True)},
    )  # fmt: skip
    return found if near is None or not others else near.plus(found)


def _samples(records: Sequence[Record]) -> float:
    """Returns how many samples a mean over records would need to tell the noise as their median."""
    count = sum(len(r.log) for r in records)
    return count if len(records) < FEWEST_OF_MEDIAN else count * MEDIAN_EFFICIENCY


def cut_unseen(
    plant: Plant, records: Sequence[Record], length: float, is_horizon: bool
) -> list[Windows]:
    """Returns the windows of a length [s] over which records are predicted, a record each.

    Raises:
        InputError: no window fits a record.
    """
    # the others only agree or not
    most = most_windows(plant, records, length, MOST_STEPS if is_horizon else MOST_STEPS // 3)
    return [spread(windows(r.log, length, r.edge), most) for r in records]


def _is_better_elsewhere(own: Unseen, others: Sequence[Unseen], length: float) -> bool:
    """Returns whether other models begin any window of a length with less error."""
    return any(
        (theirs.squares < mine.squares).any()
        for o in others
        if length in o.lengths
        for mine, theirs in zip(own.begun(length), o.begun(length), strict=True)
    )


def _settled(
    plant: Plant, records: Sequence[Record], cuts: Sequence[Windows], weights: np.ndarray,
    values: Mapping[str, float], halves: Sequence[tuple[Mapping[str, float], Mapping[str, float]]],
    near: Sequence[Starts] | None, others: Sequence[Sequence[Starts]],
) -> list[tuple[np.ndarray, np.ndarray]]:  # fmt: skip
    """Returns windows' initial states and errors by record, with each half's own values."""
    model = plant.model
    out, parts, begun, starts, places = [], [], [], [], []
    for k, (record, cut, own) in enumerate(zip(records, cuts, halves, strict=True)):
        moves = np.zeros((len(cut.starts), 2 * model.nv + model.na))
        if near is not None:  # of a model nearby, which may lack the last states
            moves[:, : near[k].d.shape[1]] = near[k].d
        mine = Starts(moves, np.zeros(len(moves)) if near is None else near[k].squares)
        elsewhere, is_better = best_starts(mine, [o[k] for o in others])
        out.append((moves, np.zeros(cut.outputs.shape)))
        is_late = cut.starts >= len(record.log) // 2
        if not own[0]:
            is_late = np.zeros(len(cut.starts), bool)
        for half, values_here in zip((~is_late, is_late), own, strict=True):
            if not half.any():
                continue
            fixed = {**values, **record.values, **values_here}
            predictor = Predictor(plant, record.log, (), fixed)
            here = cut.rows(half)
            first = first_states(predictor, np.zeros(0), here)
            parts.append(Shooting(predictor, NOTHING, here, first, np.diag(1 / weights), True))
            begun.append(moves[half])
            starts.append((elsewhere[half], is_better[half]))
            places.append((k, half))
    held = held_records(parts)
    if others:
        settled = sought_from_others(held, begun, starts)
    else:
        settled = settle(held, begun, is_thorough=True)
    for (k, half), part, s in zip(places, parts, settled, strict=True):
        d, errors = out[k]
        d[half], errors[half] = s.d, part.error(s.r)
    return out
