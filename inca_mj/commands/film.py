"""inca film LOG|RUN: a film of the robot, drawn without a screen."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import tyro

from identification.commands.common import Output, say, say_json
from inca_mj.commands.common import SavedRobot, cannot_draw, saved_robot_field

if TYPE_CHECKING:
    from inca_mj.rendering.scene import Scene


@dataclass(frozen=True, kw_only=True)
class Film:
    """Film a log (measured as ghost, simulated in colour) or a saved run.

    Examples:
        inca film examples/log.csv --seconds 5 --out out/film
        inca film out/prbs/run.npz --camera handle --speed 0.25 --still 1.0
    """

    source: Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="LOG|RUN")]
    """A log (.csv, .mat), or a run (.npz) that inca simulate or inca compare saved."""
    seconds: float | None = None
    """Film only so many seconds from the start."""
    camera: Literal["front", "side", "handle"] = "front"
    """Where to look from."""
    speed: float = 1.0
    """Seconds of the run in a second of film; 0.25 is slow motion."""
    plots: bool = True
    """Draw the motor angles beside the picture."""
    still: tuple[float, ...] = ()
    """Times [s] at which to write a PNG of the picture too."""
    robot: Annotated[SavedRobot, tyro.conf.OmitArgPrefixes] = saved_robot_field
    output: Annotated[Output, tyro.conf.OmitArgPrefixes] = field(
        default_factory=lambda: Output(out=Path("out/film"))
    )

    def run(self) -> int:
        """Draw film.mp4 and stills."""
        blind = cannot_draw()  # before MuJoCo is imported
        if blind:
            from identification.errors import GraphicsError

            raise GraphicsError(blind)
        from identification.errors import InputError
        from identification.folders import whole_folder
        from inca_mj.rendering.film import film, stills

        scene = self._scene()
        end = float(scene.run.time[-1])
        late = [t for t in self.still if not 0 <= t <= end]
        if late:
            raise InputError(f"no still at {late[0]:g} s: the run ends at {end:g} s")
        out = self.output.out or Path("out/film")
        with whole_folder(out) as draft:
            path = film(
                scene,
                draft / "film.mp4",
                camera=self.camera,
                plots=self.plots,
                speed=self.speed,
            )
            pictures = stills(scene, draft, self.still, camera=self.camera, plots=self.plots)
        files = [str(out / p.name) for p in (path, *pictures)]
        if self.output.json:
            say_json({"film": files[0], "stills": files[1:], "seconds": end})
        else:
            say("\n".join(files))
        return 0

    def _scene(self) -> Scene:
        """What to film: a saved run, or a log beside the twin with the values that were asked."""
        from inca_mj.commands.compare import compare_with
        from inca_mj.rendering.scene import make_scene
        from inca_mj.twin.logs import read_inca_log

        if self.source.suffix == ".npz":
            return make_scene(self.source, self.seconds)
        log = read_inca_log(self.source)
        if self.seconds is not None and 0 < self.seconds < log.duration:
            log = log.between(float("-inf"), float(log.time[0]) + self.seconds)
        return make_scene(compare_with(self.robot, log), self.seconds)
