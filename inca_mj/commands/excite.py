"""inca excite: design the input of an experiment."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Annotated

import tyro

from identification.commands.common import Output, conclude, output_field, table
from inca_mj.commands.common import Robot, do_not_draw, robot_field

if TYPE_CHECKING:
    from pathlib import Path

    from inca_mj.workflows.excitation import Design


@dataclass(frozen=True, kw_only=True)
class Excite:
    """Design currents that show the worst determined parameter best, inside the limits.

    Examples:
        inca excite --duration 5 --budget 60 --out out/excite
        inca excite --free b_v b_c K_t --current 0 1.5
    """

    duration: float = 5.0
    """Length of the experiment [s]."""
    noise: float = 6.7e-4
    """Std of the noise on each motor angle [rad]."""
    free: Annotated[tuple[str, ...], tyro.conf.arg(metavar="NAME")] = (
        "lambda", "b", "J", "b_v", "b_c", "beta",
    )  # fmt: skip
    """Parameters to determine; the start pose is taken as unknown too."""
    budget: int = 60
    """Inputs to evaluate, about a second each."""
    seed: int = 0
    """Seed of the search."""
    current: tuple[float, float] = (0.0, 2.0)
    """Smallest and largest current [A]."""
    margin: float = 0.2
    """Every cable keeps more tension than this [N]."""
    reach: float = 0.35
    """The platform stays so near its start along x, y, z [m]."""
    turn: float = 60.0
    """And turns no further from its start [deg]."""
    robot: Annotated[Robot, tyro.conf.OmitArgPrefixes] = robot_field
    output: Annotated[Output, tyro.conf.OmitArgPrefixes] = output_field

    def run(self) -> int:
        """Design, say, keep."""
        do_not_draw()
        from math import radians

        from inca_mj.report.information import design_json, design_verdict
        from inca_mj.twin.twin import build_twin
        from inca_mj.workflows.bench import SAMPLING
        from inca_mj.workflows.comparison import timestep_for
        from inca_mj.workflows.excitation import excite
        from inca_mj.workflows.limits import Limits

        limits = Limits(
            low=self.current[0],
            high=self.current[1],
            margin=self.margin,
            reach=self.reach,
            turn=radians(self.turn),
        )
        robot = build_twin(
            self.robot.parameters(),
            self.robot.place(),
            timestep=timestep_for(SAMPLING, self.robot.step),
        )
        result = excite(
            robot,
            self.duration,
            noise=self.noise,
            free=self.free,
            limits=limits,
            budget=self.budget,
            seed=self.seed,
            progress=self.output.tell,
        )
        record = design_json(result)
        said = [summary(result), *design_verdict(result)]
        if self.output.out is not None:
            said.append(f"inca simulate --input {self.output.out / 'excite.csv'} replays it")
        conclude(self, record, "\n".join(said), partial(keep, result), partial(draw, result))
        return 0


def summary(result: Design) -> str:
    """Returns the std of every parameter under the PRBS and the design."""
    found = result.best.found
    return table(
        ("parameter", "std, PRBS", "std, designed", "gain"),
        [
            (name, f"{a:.3g}", f"{b:.3g}", f"{gain:.2f}")
            for name, a, b, gain in zip(
                found.names, result.prbs.found.std, found.std, result.gain, strict=False
            )
        ],
    )


def keep(result: Design, out: Path) -> None:
    """Write the input as a log that the twin replays."""
    from identification import write_log
    from inca_mj.twin.logs import run_to_log

    notes = f"designed by inca excite: {result.best.name}, simulated"
    write_log(run_to_log(result.best.run, "excite", notes), out / "excite.csv")


def draw(result: Design, out: Path) -> None:
    """Write figures and the report into a folder."""
    from identification.report.page import save_figures, write_report
    from inca_mj.report.information import design_section, design_verdict
    from inca_mj.report.sections import run_section

    sections = [design_section(result), run_section(result.best.run)]
    save_figures(sections, out)
    write_report(out / "report.html", "An input to identify with", design_verdict(result), sections)
