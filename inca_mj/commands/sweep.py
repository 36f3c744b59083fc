"""inca sweep CONFIG: thousands of worlds, trials or logs, on one machine or many."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from identification.commands.common import import_without_graphics
from identification.commands.sweep import SweepCommand


@dataclass(frozen=True)
class Sweep(SweepCommand):
    """Run the tasks of a sweep, keep a record of each, and say what they come to.

    Examples:
        inca sweep benchmarks/sweeps/trials.toml --jobs 2 --out out/trials
        inca sweep benchmarks/sweeps/null_score.toml --backend dask --resume
    """

    def run(self) -> int:
        """Run, keep, say; 1 where every task met an error."""
        import_without_graphics(own_methods=True)
        return super().run()

    def methods(self) -> Mapping[str, str]:
        """Returns the methods that a sweep may name: those on any robot, and those on INCA."""
        from inca_mj.studies import METHODS

        return METHODS
