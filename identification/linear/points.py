"""States at which a model, and changes of it, are evaluated.

A change shares with the states what it leaves as it was (`identification.native.forward`). What
single actuators alone read changes their shares, and all else stays.
"""

from __future__ import annotations

import copy
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import islice

import mujoco
import numpy as np

from identification.errors import DivergenceError
from identification.model.paths import Slot
from identification.model.protocol import with_entries
from identification.model.rollout import UNDERIVED, threads
from identification.native.forward import RATES, STATE, Base, Case, Intervals, evaluate
from identification.native.installer import owners_of
from identification.runtime.engine import quiet, untimed

TOGETHER = 32  # changes that share the positions of a point; more would save little more
MEMORY = 2**28  # bytes of their models at most: one with meshes has tens of millions


@dataclass(frozen=True, kw_only=True)
class AtPoints:
    """M states of one model."""

    model: mujoco.MjModel  # with its numbers
    qpos: np.ndarray  # positions, shape (M, nq)
    qvel: np.ndarray  # velocities, shape (M, nv)
    act: np.ndarray  # activations, shape (M, na)
    inputs: np.ndarray  # that reach the model, shape (M, nu)
    time: np.ndarray  # of the points [s], shape (M,)


@dataclass(frozen=True)
class Change:
    """A change of the states or the numbers at which a model is evaluated."""

    # other values of `qpos`, `qvel`, `act` or `ctrl`, one row or a row for each point
    fields: Mapping[str, np.ndarray] = field(default_factory=dict)
    # entries of the model that differ, one each, and their values
    numbers: Sequence[tuple[Slot, float]] = ()
    # factors of its increments at the points, shape (k, M): each gives a result of its own; one
    # that is 1 throughout when None
    courses: np.ndarray | None = None

    @property
    def is_derived(self) -> bool:
        """Tells whether MuJoCo derives other numbers from those that differ (see `UNDERIVED`)."""
        return any(slot.field not in UNDERIVED for slot, _ in self.numbers)


class Points:
    """States at which a model, and its changes, are evaluated.

    Args:
        at: the states.
        results: fields of MjData that are returned side by side.
    """

    def __init__(self, at: AtPoints, results: Sequence[str] = RATES) -> None:
        parts = (at.time[:, None], at.qpos, at.qvel, at.act, at.inputs)
        states = np.ascontiguousarray(np.concatenate(parts, axis=1), float)
        # Numbers are written into copies, of which each thread has one.
        models = tuple(copy.copy(at.model) for _ in range(threads()))
        self._base = Base(models, states)
        ends = np.cumsum([part.shape[1] for part in parts])
        self._places = {f: slice(*ends[k : k + 2]) for k, f in enumerate(STATE[1:])}
        self._results = results
        is_shared = tuple(results) == RATES and not self._begins(at.act)
        self._owners = owners_of(at.model) if is_shared else {}
        every = np.arange(at.model.nactuator)
        owned = np.where(np.isin(every, [*self._owners.values()]), every, -1)
        # of each activation; none where its law gives no share
        self._actuator_of = np.repeat(owned, at.model.actuator_actnum)

    def rates(self, **changed: np.ndarray) -> np.ndarray:
        """Returns the results, by default accelerations and rates of activations (M, nv + na)."""
        (one,) = self.each([Change(changed)])
        return one

    def each(
        self, changes: Iterable[Change], intervals: Intervals | None = None
    ) -> Iterator[np.ndarray]:
        """Yields the results of changes, in their order; of each course of a change one.

        They have a row for each point, or for each interval.
        """
        changes = iter(changes)
        together = max(1, min(TOGETHER, MEMORY // int(self._base.models[0].nbuffer)))
        while some := list(islice(changes, together)):
            with quiet(), untimed():
                cases = [self._case(change) for change in some]
                found = evaluate(self._base, cases, self._results, intervals)
            if not np.isfinite(found).all():
                raise DivergenceError(
                    "the accelerations along the trajectory are not finite; use values nearer to"
                    " the nominal ones"
                )
            yield from found

    def _case(self, change: Change) -> Case:
        states = None
        actuators = self._actuators(change)
        if change.fields:
            states = self._base.states.copy()
            for name, value in change.fields.items():
                states[:, self._places[name]] = value
        if actuators:
            entries = [_entry(*number) for number in change.numbers]
            return Case(states, entries, courses=change.courses, actuators=actuators)
        # Sensors of positions are read with the positions.
        if change.is_derived or "qpos" in change.fields or not {*self._results} <= {*RATES}:
            keeps = "nothing"
        else:
            keeps = "positions" if "qvel" in change.fields else "velocities"
        if change.is_derived:
            other = with_entries(self._base.models[0], change.numbers)
            return Case(states, (), other, keeps, change.courses)
        entries = [_entry(*number) for number in change.numbers]
        return Case(states, entries, None, keeps, change.courses)

    def _begins(self, act: np.ndarray) -> bool:
        """Returns whether an actuator's first activation is zero, where its law begins anew."""
        first = self._base.models[0].actuator_actadr
        return bool((act[:, first[first >= 0]] == 0).any())

    def _actuators(self, change: Change) -> tuple[int, ...]:
        """Returns the actuators that alone read what differs; empty if there are other readers."""
        if not self._owners or "ctrl" in change.fields:
            return ()
        slots = [slot for slot, _ in change.numbers]
        some = {self._owners.get((slot.field, row), -1) for slot in slots for row in slot.rows}
        for name, values in change.fields.items():
            differs = (self._base.states[:, self._places[name]] != values).any(axis=0)
            if name == "act":
                if self._begins(np.atleast_2d(values)):
                    return ()
                some |= {*self._actuator_of[differs].tolist()}
            else:
                some |= {self._owners.get((name, int(k)), -1) for k in np.flatnonzero(differs)}
        return () if -1 in some else tuple(sorted(some))


def _entry(slot: Slot, value: float) -> tuple[str, tuple[int, ...], float]:
    """Returns an entry of a model as `Case` takes it."""
    (row,) = slot.rows
    return slot.field, (row,) if slot.column is None else (row, slot.column), value
