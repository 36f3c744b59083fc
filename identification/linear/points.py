"""States at which a model, and changes of it, are evaluated.

What moves no position shares the positions of the states (`identification.native.forward`).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import islice
from typing import Protocol

import mujoco
import numpy as np

from identification.engine import quiet, untimed
from identification.errors import DivergenceError
from identification.model.rollout import threads
from identification.native.forward import STATE, Case, evaluate

RATES = ("qacc", "act_dot")
TOGETHER = 32  # changes that share the positions of a point; more would save little more
MEMORY = 2**28  # bytes of their models at most: one with meshes has tens of millions


class AtPoints(Protocol):
    """M states of one model, each array with M rows."""

    @property
    def model(self) -> mujoco.MjModel:
        """The model."""

    @property
    def qpos(self) -> np.ndarray:
        """Positions, shape (M, nq)."""

    @property
    def qvel(self) -> np.ndarray:
        """Velocities, shape (M, nv)."""

    @property
    def act(self) -> np.ndarray:
        """Activations, shape (M, na)."""

    @property
    def inputs(self) -> np.ndarray:
        """Inputs that reach the model, shape (M, nu)."""

    @property
    def time(self) -> np.ndarray:
        """Of the points [s], shape (M,)."""


@dataclass(frozen=True)
class Change:
    """What differs from the states at which a model is evaluated.

    Attributes:
        fields: other values of `qpos`, `qvel`, `act` or `ctrl`, one row or a row for each point.
        model: with other numbers; that of the states when None.
        is_derived: whether those numbers matter to what follows from positions alone.
    """

    fields: Mapping[str, np.ndarray] = field(default_factory=dict)
    model: mujoco.MjModel | None = None
    is_derived: bool = True


class Points:
    """States at which a model, and its changes, are evaluated.

    Args:
        at: the states.
        results: fields of MjData that are returned side by side.
    """

    def __init__(self, at: AtPoints, results: Sequence[str] = RATES) -> None:
        parts = (at.time[:, None], at.qpos, at.qvel, at.act, at.inputs)
        self._base = Case(at.model, np.ascontiguousarray(np.concatenate(parts, axis=1), float))
        ends = np.cumsum([part.shape[1] for part in parts])
        self._places = {f: slice(*ends[k : k + 2]) for k, f in enumerate(STATE[1:])}
        self._results = results

    def rates(self, **changed: np.ndarray) -> np.ndarray:
        """The results, by default accelerations and rates of activations, shape (M, nv + na).

        Args:
            changed: values of `qpos`, `qvel`, `act` or `ctrl` that differ from the states' own.

        Raises:
            DivergenceError: they are not finite.
        """
        (one,) = self.each([Change(changed)])
        return one

    def each(self, changes: Iterable[Change]) -> Iterator[np.ndarray]:
        """The results of changes, in their order, each of shape (M, nv + na).

        Raises:
            DivergenceError: they are not finite.
        """
        changes = iter(changes)
        together = max(1, min(TOGETHER, MEMORY // int(self._base.model.nbuffer)))
        while some := list(islice(changes, together)):
            yield from self._together(some)

    def _together(self, changes: Sequence[Change]) -> list[np.ndarray]:
        """The results of a few changes at once."""
        own = np.array([self._moves_positions(change) for change in changes])
        cases = [self._case(change) for change in changes]
        out: list[np.ndarray] = [np.empty(0)] * len(cases)
        for shares in (True, False):
            places = np.flatnonzero(own != shares)
            if not places.size:
                continue
            with quiet(), untimed():
                found = evaluate(
                    self._base, [cases[k] for k in places], self._results, shares=shares,
                    threads=threads(),
                )  # fmt: skip
            if not np.isfinite(found).all():
                raise DivergenceError(
                    "the accelerations along the trajectory are not finite; use values nearer to"
                    " the nominal ones"
                )
            for k, one in zip(places, found, strict=True):
                out[k] = one
        return out

    def _moves_positions(self, change: Change) -> bool:
        """Whether a change needs its own positions; sensors of positions are read with them."""
        others = change.model is not None and change.is_derived
        return others or "qpos" in change.fields or not {*self._results} <= {*RATES}

    def _case(self, change: Change) -> Case:
        states = self._base.states
        if change.fields:
            states = states.copy()
            for name, value in change.fields.items():
                states[:, self._places[name]] = value
        return Case(change.model or self._base.model, states)
