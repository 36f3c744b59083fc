"""inca track: follow a circle under a controller that believes a twin."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import tyro

import inca_mj as inca
from identification.commands.common import Output, assignments, conclude, draw_report
from identification.errors import InputError, unknown_name
from identification.quantities import plain_fields
from inca_mj.commands.common import Robot, do_not_draw, keep_run

if TYPE_CHECKING:
    from identification.effects.effect import Effect


@dataclass(frozen=True, kw_only=True)
class Track:
    """Let a robot follow a circle; its controller sees motor angles and has a model.

    Examples:
        inca track --effect load_dependent_friction.mu=0.05 --out out/nominal
        inca track --effect load_dependent_friction.mu=0.05 --model out/discover --out out/found
    """

    model: Annotated[Path | None, tyro.conf.arg(metavar="DIR")] = None
    """Folder of a saved twin that is the controller's model; the nominal twin if none."""
    effect: Annotated[tuple[str, ...], tyro.conf.arg(metavar="NAME.SIZE=VALUE")] = ()
    """What the robot truly has beside its parameters, such as load_dependent_friction.mu=0.05."""
    radius: float = 0.3
    """Radius of the circle [m]."""
    rate: float = 1.0
    """Rate on the circle [rad/s]."""
    plane: Literal["xy", "xz", "yz"] = "xy"
    """Plane of the circle; z is up."""
    duration: float = 12.0
    """Length of the run [s]; the first 4 s lead to the circle, a turn at 1 rad/s takes 6.3 s."""
    bandwidth: float = 25.0
    """Bandwidth of the controller [rad/s]."""
    noise: float = 0.0
    """Standard deviation of the encoders' noise [rad]."""
    seed: int = 0
    """Seed of the noise."""
    knows_pose: bool = False
    """Tell the controller the true pose, which the real robot cannot measure."""
    robot: Robot = Robot()
    output: Output = Output(out=Path("out/track"))

    def run(self) -> int:
        """Track, write, say."""
        do_not_draw()
        effects, values = effects_of(self.effect)
        robot = self.robot.twin(inca.CONTROL_TIMESTEP, effects).with_values(values)
        model = (
            self.robot.twin(inca.CONTROL_TIMESTEP)
            if self.model is None
            else inca.load_twin(self.model)
        )
        x, y, z = map(float, robot.start.pose[:3])
        circle = inca.Circle(centre=(x, y, z), radius=self.radius, rate=self.rate, plane=self.plane)
        result = inca.track(
            robot, model, circle, duration=self.duration,
            gains=inca.Gains(bandwidth=self.bandwidth), knows_pose=self.knows_pose,
            noise=self.noise, seed=self.seed,
        )  # fmt: skip
        text = "\n".join(sentences(result))
        if self.output.out is not None:
            files = "log.csv, run.npz and model.xml are in"
            text += f"\n{files} {self.output.out}; figures and report.html follow"
        keep = partial(keep_run, result.run, "simulated by inca track")
        conclude(self, summary(result), text, keep, partial(draw, result))
        return 0


def effects_of(words: Sequence[str]) -> tuple[tuple[Effect, ...], dict[str, float]]:
    """Returns the effects of the catalogue that NAME.SIZE=VALUE words name, and their values.

    NAME alone stands for its first size, NAME.SIZE@3 for drive 3.
    """
    from inca_mj.effects.values import records

    known = {effect.name: effect for effect in inca.CATALOGUE}
    values: dict[str, float] = {}
    given = assignments(words, "--effect", "load_dependent_friction.mu=0.05")
    for word, value in given.items():
        name, _, place = word.partition("@")
        own, _, size = name.partition(".")
        if own not in known:
            raise unknown_name("effect", own, known)
        full = f"{own}.{size or known[own].sizes[0].name}" + (f"@{place}" if place else "")
        parameters = [p.name for p in records([known[own]])]
        if full not in parameters:
            raise unknown_name("parameter of an effect", full, parameters)
        if full in values:
            raise InputError(f"--effect gives {full} twice; give it once")
        values[full] = value
    named = {name.partition(".")[0] for name in values}
    return tuple(e for e in inca.CATALOGUE if e.name in named), values


def summary(result: inca.Tracking) -> dict[str, object]:
    """Returns what the command says in JSON."""
    from inca_mj.workflows.limits import remarks

    run = result.run
    return {
        **plain_fields(result, "rms", "cross_track_rms", "largest", "seen_rms", "turned"),
        "counted_from": result.counted,
        "seconds_simulated": float(run.time[-1]),
        "current_min": float(run.currents.min()),
        "current_max": float(run.currents.max()),
        "tension_min": float(run.tension.min()),
        "tension_max": float(run.tension.max()),
        "remarks": remarks(run),
    }


def sentences(result: inca.Tracking) -> list[str]:
    """Returns how near the platform came, with which currents and tensions, and remarks."""
    from inca_mj.workflows.limits import remarks

    run = result.run
    return [
        f"The platform is {1e3 * result.rms:.3f} mm rms from the point that is asked,"
        f" {1e3 * result.largest:.3f} mm at most, and {1e3 * result.cross_track_rms:.3f} mm rms off"
        f" the path; by the controller's own estimate {1e3 * result.seen_rms:.3f} mm rms.",
        f"Currents from {run.currents.min():z.2f} to {run.currents.max():z.2f} A, tensions from"
        f" {run.tension.min():.1f} to {run.tension.max():.1f} N.",
        *remarks(run),
    ]


def draw(result: inca.Tracking, out: Path) -> None:
    """Write figures and the report into a folder."""
    from inca_mj.report.sections import run_section, tracking_section
    from inca_mj.twin.section import model_section

    run = result.run
    sections = [tracking_section(result), run_section(run), model_section(run.twin)]
    draw_report(out, "A robot on a path", sentences(result), sections)
