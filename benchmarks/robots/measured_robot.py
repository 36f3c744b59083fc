"""A robot that was measured: its model, what is free, its records, and what others published.

A reader in this folder makes one from the raw files of its authors; nobody's data are part of this
project. `robots.written` writes one as the files that `python -m identification` takes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from identification import Log, on_a_grid

MODELS = Path(__file__).parent / "models"
PROJECT_MODELS = Path(__file__).parents[2] / "models"
# y - ŷ over windows of a log of a length [s], each from its best first state, shape (W, L, ny); the
# windows are those of `identification.windows.windows`.
Errors = Callable[[Log, float], np.ndarray]
BACK = 0.01  # share of the way back to where a search began before


@dataclass(frozen=True, kw_only=True)
class Free:
    """A free parameter: where it goes, where the search begins, and what is known of it."""

    name: str  # of the parameter; an effect's size is called `effect.size@place`
    value: float  # where the search begins, in its unit
    path: str = ""  # into the model; empty for the size of an effect
    # std of the prior: relative where the value must be positive, else in its unit
    known: float = 0.5
    unit: str = ""  # of the value
    scale: float | None = None  # a magnitude that matters, where the value may be zero
    # smallest and largest value; those of the effect or of the model when None
    bounds: tuple[float, float] | None = None


@dataclass(frozen=True, kw_only=True)
class PublishedSize:
    """A number that others found for this robot."""

    name: str  # of the parameter or effect here
    value: float  # in `unit`
    unit: str  # of the value
    source: str  # who published it, and where


@dataclass(frozen=True, kw_only=True)
class PublishedModel:
    """A model of others, made again from their equations and their numbers."""

    name: str  # what they call it
    source: str  # who published it, and where
    errors: Errors  # of its predictions


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """What a discovery left: values and window errors, for the evidence of a robot."""

    values: Mapping[str, float]  # of the final model, by name
    nominal: Errors  # window errors of the fitted nominal model
    final: Errors  # window errors of the model with what is named


@dataclass(frozen=True, kw_only=True)
class Apart:
    """Records of the robot as it was changed; they are neither fitted nor do they confirm."""

    what: str  # how the robot differs
    logs: tuple[Log, ...]  # the records
    # MJCF of the changed robot, None where the model is to show that something changed
    model: Path | None = None
    refit: tuple[str, ...] = ()  # parameters that the change should move


@dataclass(frozen=True, kw_only=True)
class MeasuredRobot:
    """A robot, its records, and what others published of it."""

    name: str  # a word
    title: str  # what it is, in a line
    source: str  # who measured it, and where the data are
    model: Path  # path of its MJCF
    free: tuple[Free, ...]  # free parameters, each with its start and its prior
    horizon: float  # over which predictions are judged [s]
    fit: tuple[Log, ...]  # records to fit
    confirm: tuple[Log, ...]  # records that no fit may see
    unit: str = ""  # of the outputs, where it is not that of the model's sensors
    # another split of records, those to fit and those that confirm; None for the same records with
    # their roles exchanged
    second: tuple[tuple[Log, ...], tuple[Log, ...]] | None = None
    # values of effects' shapes that the model has
    fixed: Mapping[str, float] = field(default_factory=dict)
    # effects one of which should be named first; empty where nobody knows
    expected: tuple[str, ...] = ()
    apart: tuple[Apart, ...] = ()  # records of the robot as it was changed
    # other values with which the whole work begins once more, by what they are
    starts: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    # free parameters that a poorer model of it lacks, by what that model is; the whole work is done
    # once more with it
    lacking: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    published: tuple[PublishedSize, ...] = ()  # numbers of others
    models: tuple[PublishedModel, ...] = ()  # models of others
    # what else the records show, as a JSON object; None where nothing is to be shown
    evidence: Callable[[Outcome], dict[str, Any]] | None = None

    @property
    def records(self) -> tuple[Log, ...]:
        """All records but those of the changed robot."""
        return (*self.fit, *self.confirm)

    def split(self, number: int) -> MeasuredRobot:
        """The robot with its first or its second split of records."""
        if number == 1:
            return self
        fit, confirm = self.second or (self.confirm, self.fit)
        return replace(self, fit=fit, confirm=confirm)

    def few(self, count: int) -> MeasuredRobot:
        """The robot with so many records that are fitted, and as many that confirm."""
        return replace(self, fit=self.fit[:count], confirm=self.confirm[:count])

    def started(self, values: Mapping[str, float]) -> MeasuredRobot:
        """The robot with other values at which the search begins.

        They are moved a little back to where it began before, off the ends of their ranges.
        """
        near = {p.name: values.get(p.name, p.value) for p in self.free}
        free = (replace(p, value=near[p.name] + BACK * (p.value - near[p.name])) for p in self.free)
        return replace(self, free=tuple(free))

    def poorer(self, names: Sequence[str]) -> MeasuredRobot:
        """The robot with a model that lacks some effects, one of which should be named first."""
        free = tuple(p for p in self.free if p.name not in names)
        effects = dict.fromkeys(n.partition(".")[0] for n in names)
        return replace(self, free=free, expected=tuple(effects))


def gridded(
    time: np.ndarray,
    inputs: Mapping[str, np.ndarray],
    outputs: Mapping[str, np.ndarray],
    *,
    units: Mapping[str, str],
    name: str,
    step: float,
    widest: float,
    means: bool = False,
) -> Log:
    """A log of columns whose time stamps are uneven, straight lines between samples.

    Args:
        time: stamps, shape (n,) [s].
        inputs: by name, shape (n,).
        outputs: by name, shape (n,).
        units: by name.
        name: of the log.
        step: of the grid [s].
        widest: gap that is bridged [s].
        means: whether an input is the mean over a step of the grid about each of its points, as a
            grid needs that is coarser than the record; outputs are never filtered.
    """
    columns = {**inputs, **outputs}
    t, on = on_a_grid(time, columns, step, widest)
    if means:
        begin = max(float(time[np.isfinite(x) & np.isfinite(time)].min()) for x in columns.values())
        on |= {n: _means(time, u, begin + t, step) for n, u in inputs.items()}
    return Log(
        time=t, inputs=np.column_stack([on[n] for n in inputs]),
        outputs=np.column_stack([on[n] for n in outputs]), input_names=tuple(inputs),
        output_names=tuple(outputs), units=dict(units), name=name, hold="foh",
    )  # fmt: skip


def _means(time: np.ndarray, u: np.ndarray, at: np.ndarray, step: float) -> np.ndarray:
    """Mean over [t - h/2, t + h/2] of the straight lines through samples, at times `at`, (m,)."""
    there = np.isfinite(u) & np.isfinite(time)
    t, v = time[there], u[there]
    areas = np.concatenate([[0.0], np.cumsum(0.5 * (v[1:] + v[:-1]) * np.diff(t))])
    slopes = np.diff(v) / np.diff(t)

    def area(x: np.ndarray) -> np.ndarray:
        k = np.clip(np.searchsorted(t, x, side="right") - 1, 0, len(t) - 2)
        return areas[k] + v[k] * (x - t[k]) + 0.5 * slopes[k] * (x - t[k]) ** 2

    low, high = np.maximum(at - step / 2, t[0]), np.minimum(at + step / 2, t[-1])
    return (area(high) - area(low)) / (high - low)
