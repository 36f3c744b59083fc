"""identification sweep CONFIG: many tasks of one kind, here or on other machines."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

from identification.commands.common import Output, conclude, draw_report, flat, note
from identification.commands.places import refuse_place
from identification.errors import InputError

if TYPE_CHECKING:
    from identification.sweep.store import Store
    from identification.sweep.task import Sweep


@dataclass(frozen=True)
class SweepCommand:
    """Run the tasks of a sweep, keep a record of each, and say what they come to.

    Examples:
        identification sweep logs.toml --jobs 4 --out out/logs
        identification sweep logs.toml --out out/logs --resume
    """

    config: Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="CONFIG")]
    """TOML of the sweep: methods, settings, grids, seed (docs/sweeps.md)."""
    backend: str = "processes"
    """Where tasks run: processes, serial, dask, tcp://HOST:PORT, slurm or submitit-local."""
    jobs: int | None = None
    """Workers at a time; as many as processors when not given."""
    job: Annotated[
        tuple[tuple[str, ...], ...], tyro.conf.UseAppendAction,
        tyro.conf.arg(metavar="NAME=VALUE"),
    ] = ()  # fmt: skip
    """Of Slurm's jobs, such as slurm_partition=long timeout_min=600 tasks_per_job=20."""
    resume: bool = False
    """Go on with the records that are in the folder."""
    again: bool = False
    """Run tasks once more that met an error; goes with --resume."""
    summary: bool = False
    """Run nothing; make report and result.json anew from the records."""
    output: Output = Output()

    def run(self) -> int:
        """Run, keep, say; 1 where every task met an error."""
        from identification.sweep.config import read_sweep
        from identification.sweep.store import Store

        if self.again and not self.resume:
            raise InputError("--again runs tasks of an earlier start once more; write --resume too")
        sweep = read_sweep(self.config, self.methods(), files=not self.summary)
        folder = self.output.out or Path("out") / self.config.stem
        kept = replace(self, output=replace(self.output, out=folder))
        refuse_place(kept)
        if self.summary and not folder.is_dir():
            raise InputError(f"--summary needs records, and there is no folder {folder}")
        with Store(sweep, folder) as store:
            if self.again:
                self.output.tell(f"{store.drop_errors()} tasks with an error run again")
            if not self.summary:
                self._compute(sweep, store)
            if not store.done:
                raise InputError(f"{store.records} has no records; leave --summary out")
            return self._conclude(sweep, store, kept)

    def methods(self) -> Mapping[str, str]:
        """Returns the methods that a sweep may name."""
        from identification.sweep.log_methods import METHODS

        return METHODS

    def _compute(self, sweep: Sweep, store: Store) -> None:
        from identification.sweep.run import backend_of, run_sweep

        for word in flat(self.job):
            if not word.partition("=")[2]:
                raise InputError(
                    f"{word!r} is not NAME=VALUE; write e.g. --job slurm_partition=long"
                )
        options = dict(word.split("=", 1) for word in flat(self.job))
        backend = backend_of(self.backend, self.jobs, store.folder, options)
        tell = self.output.tell if not sys.stderr.isatty() else None  # there a bar says it
        ran = run_sweep(store, backend, resume=self.resume, progress=tell)
        self.output.tell(f"{ran} tasks were run, {len(store.done)} records are there")

    def _conclude(self, sweep: Sweep, store: Store, kept: SweepCommand) -> int:
        from identification.sweep.summary import summarise

        path = store.finish()
        found = summarise(sweep, store.rows())
        record = {**found.record, "path": str(path)}
        text = "\n".join([*found.sentences, f"The records are in {path}."])
        footer = f"seed {sweep.seed}, digest of the records {found.record['digest'][:16]}"
        title, said, sections = sweep.about, found.sentences, found.sections
        draw = partial(draw_report, title=title, verdict=said, sections=sections, footer=footer)
        conclude(kept, record, text, draw=draw)
        if found.record["failed"] == found.record["records"]:
            (most, *others) = found.record["errors"]
            note(f"every task met an error: {most}" + (", and others" if others else ""))
            return 1
        return 0
