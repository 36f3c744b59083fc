"""The content of a film: a run of the twin, and the real robot under its currents as a ghost."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from identification.errors import InputError
from identification.logs.log import Log
from inca_mj.rendering.checks import refuse_seconds
from inca_mj.twin.logs import UNJUDGED, pose_of, read_inca_log
from inca_mj.twin.run import Run, load_run, rows_of
from inca_mj.workflows.comparison import Comparison, compare


@dataclass(frozen=True)
class Scene:
    """A run, and what was measured at the same times, where something was.

    Attributes:
        run: what the twin did, N samples.
        angles: motor angles of the real robot at `run.time`, shape (N, 8) [rad].
        pose: x, y, z [m], roll, pitch, yaw [rad] of the real robot where they were measured too,
            shape (N, 6); else its pose follows from the cable lengths (`inca_mj.rendering.ghost`).

    Raises:
        InputError: there are not N measured samples, or a pose without angles.
    """

    run: Run
    angles: np.ndarray | None = None
    pose: np.ndarray | None = None

    def __post_init__(self) -> None:
        if self.angles is None and self.pose is not None:
            raise InputError("a measured pose needs the measured motor angles beside it")
        if self.angles is not None and len(self.angles) != len(self.run.time):
            raise InputError(
                f"{len(self.angles)} measured samples for {len(self.run.time)} simulated ones"
            )

    def between(self, start: float, end: float) -> Scene:
        """Returns the samples from `start` to `end` [s], both included.

        Raises:
            InputError: fewer than two samples are left.
        """
        rows = rows_of(self.run.time, start, end)
        return replace(
            self,
            run=self.run.between(start, end),
            angles=None if self.angles is None else self.angles[rows],
            pose=None if self.pose is None else self.pose[rows],
        )


Source = Scene | Run | Comparison | Log | str | Path


def make_scene(source: Source, seconds: float | None = None) -> Scene:
    """Returns the scene of a log, a run, a comparison or a file, or of its first seconds.

    A log is laid over the twin's prediction with the thesis' Table 3.2; `compare` it first for
    other values. Raises InputError if the file is neither a log nor a run, or less than two samples
    are left, and DivergenceError if the twin cannot be simulated.
    """
    refuse_seconds(seconds)
    if isinstance(source, str | Path):
        path = Path(source)
        source = load_run(path) if path.suffix == ".npz" else read_inca_log(path, UNJUDGED)
    if isinstance(source, Log):
        if seconds is not None and seconds < source.duration:
            source = source.between(float("-inf"), float(source.time[0]) + seconds)
        source = compare(source, trust=UNJUDGED)  # a picture shows a log as it is
    if isinstance(source, Comparison):
        source = Scene(source.run, source.log.outputs, pose_of(source.log))
    elif isinstance(source, Run):
        source = Scene(source)
    return source if seconds is None else source.between(float("-inf"), seconds)
