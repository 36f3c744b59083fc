"""inca film|view LOG|RUN: the robot in a film, drawn without a screen, or in a viewer."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import tyro

import inca_mj as inca
from identification.commands.common import Output, say, say_json
from identification.errors import GraphicsError, InputError
from identification.runtime.progress import duration
from identification.storage.files import check_file
from identification.storage.folders import whole_folder
from identification.storage.results import RESULT, write_result
from inca_mj.commands.common import SavedRobot, cannot_draw, do_not_draw

if TYPE_CHECKING:
    from inca_mj.rendering.scene import Scene

FPS = 30.0  # frames per second of the film
FIRST = 10  # frames whose rate is measured; the first of all also waits for the renderer
SOON = 5.0  # [s] after which the rate of fewer frames is told
EVERY = 10.0  # [s] between two lines


@dataclass(frozen=True, kw_only=True)
class Film:
    """Film a log (measured as ghost, simulated in colour) or a saved run, or two side by side.

    Examples:
        inca film examples/log.csv --seconds 5 --out out/film
        inca film out/before/run.npz out/after/run.npz --title nominal found --still 8
    """

    source: Annotated[tuple[Path, ...], tyro.conf.Positional, tyro.conf.arg(metavar="LOG|RUN")]
    """One or two: a log (.csv, .mat), or a run (.npz) that another command saved."""
    title: tuple[str, ...] = ()
    """A line over each picture; else two pictures have the names of their folders."""
    seconds: Annotated[float | None, tyro.conf.arg(metavar="SECONDS")] = None
    """Film only so many seconds from the start."""
    camera: Literal["front", "side", "handle"] = "front"
    """Where to look from."""
    speed: float = 1.0
    """Seconds of the run in a second of film; 0.25 is slow motion."""
    plots: bool = True
    """Draw the motor angles beside the picture; two pictures have no room for them."""
    magnify: float = 20.0
    """By how much the deviation from a path that inca track asked is drawn larger."""
    still: tuple[float, ...] = ()
    """Times [s] at which to write a PNG of the picture too."""
    robot: SavedRobot = SavedRobot()
    output: Output = Output(out=Path("out/film"))

    def run(self) -> int:
        """Draw film.mp4 and stills."""
        self._refuse_unclear()
        blind = cannot_draw()  # before MuJoCo is imported
        if blind:
            raise GraphicsError(blind)
        from inca_mj.rendering.film import common_time, film, stills

        scenes = [self._scene(source) for source in self.source]
        begin, end = common_time(scenes)
        off = [t for t in self.still if not begin <= t <= end]
        if off:
            raise InputError(f"no still at {off[0]:g} s: the film is of {begin:g} to {end:g} s")
        scene, titles = scenes[0], list(self.title)
        if not titles and len(scenes) > 1:
            titles = [path.resolve().parent.name for path in self.source]
        look: Any = {
            "beside": scenes[1] if len(scenes) > 1 else None, "titles": titles,
            "camera": self.camera, "plots": None if self.plots else False, "magnify": self.magnify,
        }  # fmt: skip
        out, progress = self.output.out or Path("out/film"), FilmProgress(self.output.tell, FPS)
        with whole_folder(out) as draft:
            path = draft / "film.mp4"
            film(scene, path, fps=FPS, speed=self.speed, progress=progress, **look)
            names = [p.name for p in (path, *stills(scene, draft, self.still, **look))]
            record = {"film": names[0], "stills": names[1:], "seconds": end, "titles": titles}
            write_result(draft / RESULT, self, record)
        files = [str(out / name) for name in names]
        if self.output.json:
            say_json({**record, "film": files[0], "stills": files[1:]})
        else:
            say("\n".join(files))
        return 0

    def _refuse_unclear(self) -> None:
        """Refuse options and files that make no sense, before anything heavy is imported."""
        from inca_mj.rendering import checks

        if not self.source:
            raise InputError("LOG|RUN is missing; write inca film LOG|RUN")
        if len(self.source) > 2:
            raise InputError(
                f"{len(self.source)} logs and runs; a film shows one, or two side by side"
            )
        for source in self.source:
            if source.suffix not in (".npz", ".csv", ".mat") and not source.is_dir():
                raise InputError(
                    f"{source} is neither a log nor a run; give a log (.csv, .mat), or the run.npz"
                    " that inca simulate and inca track keep in their folder --out"
                )
            check_file(source, what="log (.csv, .mat) or run (.npz)")
        checks.refuse_titles(self.title, len(self.source))
        checks.refuse_seconds(self.seconds)
        checks.refuse_speed(FPS, self.speed)
        checks.refuse_magnify(self.magnify)
        self.robot.check()

    def _scene(self, source: Path) -> Scene:
        """Returns the scene of a saved run, or of a log beside the twin with the given values."""
        from inca_mj.commands.compare import compare_with
        from inca_mj.rendering.scene import make_scene
        from inca_mj.twin.logs import UNJUDGED, read_inca_log

        if source.suffix == ".npz":
            return make_scene(source, self.seconds)
        log = read_inca_log(source, UNJUDGED)
        if self.seconds is not None and 0 < self.seconds < log.duration:
            log = log.between(float("-inf"), float(log.time[0]) + self.seconds)
        self.output.tell(f"simulating {log.duration:g} s of {source}")
        return make_scene(compare_with(self.robot, log, UNJUDGED), self.seconds)


@dataclass(frozen=True)
class View:
    """Open the interactive viewer: pull at the platform and give currents, or play a log or a run.

    Examples:
        inca view
        inca view examples/log.csv --speed 0.5
    """

    source: Annotated[Path | None, tyro.conf.Positional, tyro.conf.arg(metavar="LOG|RUN")] = None
    """A run (.npz) to play, or a log under whose currents the twin is played."""
    plain: bool = False
    """Show models/inca6d_plain.xml, the approximation that needs MuJoCo only."""
    speed: float = 1.0
    """Seconds of the run in a second; 0.25 is slow motion."""
    robot: SavedRobot = SavedRobot()

    def run(self) -> int:
        """Show it until the window is closed."""
        do_not_draw()  # the viewer has an OpenGL of its own
        from inca_mj.commands.compare import compare_with
        from inca_mj.rendering.interactive import refuse_speed, require_screen, view_model, view_run
        from inca_mj.twin.logs import UNJUDGED

        if self.plain and self.source is not None:
            raise InputError("--plain shows a model and no run; leave out --plain, or the file")
        refuse_speed(self.speed)
        require_screen()  # before anything is simulated
        if self.source is not None:
            if self.source.suffix == ".npz":
                run = inca.load_run(self.source)
            else:
                log = inca.read_inca_log(self.source, UNJUDGED)
                run = compare_with(self.robot, log, UNJUDGED).run
            view_run(run, speed=self.speed)
        elif self.plain:
            view_model(inca.build_plain(self.robot.parameters(), self.robot.place()).compile())
        else:
            view_model(self.robot.twin(1e-2).model)
        return 0


@dataclass
class FilmProgress:
    """Counts the frames of a film, and says how long the rest will take."""

    tell: Callable[[str], None]  # is told each line
    fps: float  # frames per second of the film
    # whether it is told a line now and then; where stderr is a terminal, a bar says it
    lines: bool = field(default_factory=lambda: not sys.stderr.isatty())
    clock: Callable[[], float] = time.monotonic  # the time [s]
    hint: str = ""  # how to do without the film; told where it begins
    _first: int = 0
    _began: float = 0.0
    _last_line: float = 0.0
    _is_promised: bool = False

    def __call__(self, done: int, frames: int) -> None:
        """Counts `done` frames of all; some may have been drawn before the first call."""
        now = self.clock()
        if not self._first:
            self._first, self._began, self._last_line = done, now, now
            more = f"; {self.hint}" if self.hint else ""
            self.tell(f"film: {frames} frames, {frames / self.fps:.3g} s of film{more}")
            return
        rest = (now - self._began) / (done - self._first) * (frames - done)
        if done == frames:
            return
        if not self._is_promised:
            if done - self._first >= FIRST or now - self._began >= SOON:
                self._last_line, self._is_promised = now, True
                self.tell(f"film: {frames} frames, about {duration(rest)} to draw")
        elif self.lines and now - self._last_line >= EVERY:
            self._last_line = now
            self.tell(f"film: {done} of {frames} frames, {duration(rest)} left")
