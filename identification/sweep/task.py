"""Studies, their grids, and the tasks of a sweep: each is plain data and a seed.

    t ↔ (s, c, k)      task t is draw k at point c of the grid of study s
    seed = SeedSequence(seed).spawn(..)[s].spawn(..)[c].spawn(..)[k]       c = 0 where paired

A task is made from its number when it is asked for, so that a million of them take no memory.
"""

from __future__ import annotations

import json
from bisect import bisect_right
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from hashlib import sha256
from itertools import accumulate
from math import prod
from pathlib import Path

from identification.sweep.method import Method, Seed
from identification.sweep.settings import Plain, check_values, resolve


@dataclass(frozen=True, kw_only=True)
class Study:
    """One method over a grid of its settings."""

    name: str  # of the study
    word: str  # how the TOML names the method
    reference: str  # where a worker finds it
    method: Method  # it
    count: int  # tasks for each point of the grid
    paired: bool  # whether the k-th task has the same seed at all points
    settings: Mapping[str, Plain]  # values that all tasks have, by name
    grid: Mapping[str, tuple[Plain, ...]]  # values of each axis, by the setting's name

    @property
    def points(self) -> int:
        """The number of points of the grid."""
        return prod(len(values) for values in self.grid.values())

    def at(self, point: int) -> dict[str, Plain]:
        """Returns the values of all settings at a grid point; the last axis changes fastest."""
        chosen: dict[str, Plain] = {}
        for name, values in reversed([*self.grid.items()]):
            point, k = divmod(point, len(values))
            chosen[name] = values[k]
        where = f"study {self.name!r}"
        return check_values(self.method.settings, {**self.settings, **chosen}, where)


@dataclass(frozen=True)
class Task:
    """A task as a worker gets it: plain data and a seed."""

    number: int  # in the sweep, from 0
    reference: str  # of the method
    settings: Mapping[str, Plain]  # values of all its settings, paths whole
    seed: Seed  # of the task


@dataclass(frozen=True, kw_only=True)
class Sweep:
    """The content of a sweep's TOML.

    Attributes:
        path: of the TOML.
        seed: of all tasks.
        about: title of the report.
        studies: in the order of the TOML.
    """

    path: Path
    seed: int
    about: str
    studies: tuple[Study, ...]

    @cached_property
    def _ends(self) -> list[int]:
        return [*accumulate(study.points * study.count for study in self.studies)]

    def __len__(self) -> int:
        return self._ends[-1]

    def locate(self, number: int) -> tuple[int, int, int]:
        """Returns the study, the point of its grid, and the draw of a task."""
        s = bisect_right(self._ends, number)
        before = self._ends[s - 1] if s else 0
        return s, *divmod(number - before, self.studies[s].count)

    def shown(self, number: int) -> dict[str, Plain]:
        """Returns the settings of a task as the TOML writes them."""
        s, point, _ = self.locate(number)
        return self.studies[s].at(point)

    def task(self, number: int) -> Task:
        """Returns a task by its number.

        Raises:
            InputError: a path names a variable of the environment that is not set.
        """
        s, point, draw = self.locate(number)
        study = self.studies[s]
        settings = resolve(study.method.settings, study.at(point), self.path.parent)
        seed = Seed(self.seed, (s, 0 if study.paired else point, draw))
        return Task(number, study.reference, settings, seed)

    def digest(self) -> str:
        """Returns a digest of what decides which tasks there are; comments and `about` do not."""
        plain = [
            [s.name, s.word, s.count, s.paired, dict(s.settings), dict(s.grid)]
            for s in self.studies
        ]
        text = json.dumps([self.seed, plain], sort_keys=True)
        return sha256(text.encode()).hexdigest()
