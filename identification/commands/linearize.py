"""identification linearize ROBOT [LOG]: the linear model of any robot."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

from identification.commands.common import Output, assignments, conclude, draw_report, table

if TYPE_CHECKING:
    from collections.abc import Sequence

    from identification.linear.system import LinearSystem


@dataclass(frozen=True, kw_only=True)
class Linearize:
    """A, B, C, D of any MJCF at rest or along a log, its minimal states and its modes.

    Examples:
        identification linearize models/emps.toml log.csv --out out/linear
        identification linearize robot.toml log.csv --time 1.5 3 --json
    """

    robot: Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="ROBOT")]
    """TOML that names model, columns and values."""
    log: Annotated[Path | None, tyro.conf.Positional, tyro.conf.arg(metavar="LOG")] = None
    """Log of the robot: its rate is that of the discrete model, and --time is a time of it."""
    time: Annotated[tuple[float, ...], tyro.conf.arg(metavar="SECONDS")] = ()
    """Where along the log's free run; without a time, at the rest nearest to the start."""
    input: Annotated[tuple[str, ...], tyro.conf.arg(metavar="NAME=VALUE")] = ()
    """Inputs that act at rest, by actuator; zero where not given."""
    rate: Annotated[float | None, tyro.conf.arg(metavar="HZ")] = None
    """Samples a second of the discrete model [Hz]; that of the log when not given."""
    trust: Annotated[tuple[str, ...], tyro.conf.arg(metavar="WORD")] = ()
    """What you know better than a check of the log: contacts, gaps, joints, rows, sensors, start,
    steps, time, units, wiring."""
    output: Output = Output()

    def run(self) -> int:
        """Linearise, say, keep."""
        from identification.linear.linearization import linearize
        from identification.linear.system import sampling_time_of
        from identification.report.linear import system_to_json
        from identification.robot.file.file import read_robot_file
        from identification.robot.linearization import operating_points
        from identification.robot.robot import read_robot_log

        if self.rate is not None:
            sampling_time_of(self.rate)
        log = None if self.log is None else read_robot_log(read_robot_file(self.robot), self.log)
        inputs = assignments(self.input, "--input", "drive=0.5")
        points, outputs = operating_points(self.robot, log, self.time, inputs, self.trust)
        systems = linearize(points, outputs)
        rate = 1 / log.sampling_time if self.rate is None and log is not None else self.rate
        labels = [f"at {t:g} s" for t in points.time] if self.time else ["at rest"]
        record = {
            "points": [
                {"time": t if self.time else None, **system_to_json(s, rate)}
                for t, s in zip(points.time.tolist(), systems, strict=True)
            ]
        }
        units = {} if log is None else log.units
        text = "\n".join(said(s, label) for s, label in zip(systems, labels, strict=True))

        def draw(out: Path) -> None:
            from identification.linear.modes import modes
            from identification.report.linear import linear_sections, slowest_and_fastest

            verdict = [slowest_and_fastest(modes(systems[0]))]
            sections = linear_sections(systems, labels, rate, units)
            draw_report(out, "The linear model", verdict, sections)

        conclude(self, record, text, partial(save_systems, systems, rate), draw)
        return 0


def said(system: LinearSystem, label: str) -> str:
    """Returns the modes of a system as a text table, and a sentence on its minimal realisation."""
    from identification.linear.modes import minimal
    from identification.report.linear import HEAD, minimal_sentence, mode_rows

    sizes = f"{len(system.states)} states, {len(system.inputs)} inputs, {len(system.outputs)}"
    return "\n".join(
        [f"{label}: {sizes} outputs", table(HEAD, mode_rows(system)),
         minimal_sentence(minimal(system), len(system.A))]
    )  # fmt: skip


def save_systems(systems: Sequence[LinearSystem], rate: float | None, out: Path) -> None:
    """Write each continuous system, its minimal and its discrete form (at a rate in [Hz])."""
    from identification.linear.export import FORMATS, save_system
    from identification.linear.modes import minimal

    for k, system in enumerate(systems, 1):
        forms = {"system": system, "minimal": minimal(system).system}
        if rate is not None:
            forms["discrete"] = system.discrete(rate)
        for name, form in forms.items():
            number = f"_{k}" if len(systems) > 1 else ""
            for end in FORMATS:
                save_system(form, out / f"{name}{number}{end}")
