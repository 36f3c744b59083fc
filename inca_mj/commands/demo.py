"""inca demo: the main job on a shipped log, from the log to a report with a film in it."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

from inca_mj.commands.common import (
    Output,
    Robot,
    bar,
    cannot_draw,
    folder,
    note,
    robot_field,
    say,
    write_result,
)

if TYPE_CHECKING:
    from inca_mj.comparison import Comparison


@dataclass(frozen=True)
class Demo:
    """Compare a log with the twin, film it, and check the twin against the reference ODE."""

    log: Annotated[Path, tyro.conf.Positional] = Path("examples/log.csv")
    """The log."""
    robot: Annotated[Robot, tyro.conf.OmitArgPrefixes] = robot_field
    output: Annotated[Output, tyro.conf.OmitArgPrefixes] = field(
        default_factory=lambda: Output(out=Path("out/demo"))
    )

    def run(self) -> int:
        """Do all of it, write one report, say where it lies; 1 when the models disagree."""
        blind = cannot_draw()  # before MuJoCo is imported
        from inca_mj.commands import compare, crosscheck
        from inca_mj.comparison import compare as compare_log
        from inca_mj.crosscheck import crosscheck as check
        from inca_mj.logs import read_inca_log
        from inca_mj.report import write_report
        from inca_mj.run import save_run
        from inca_mj.sections import (
            compare_section,
            compare_verdict,
            crosscheck_section,
            film_section,
            model_section,
            save_figures,
        )

        parameters, place = self.robot.parameters(), self.robot.place()
        note("1/3 comparing the log with the twin")
        result = compare_log(
            read_inca_log(_shipped(self.log)), parameters, place, timestep=self.robot.step
        )
        say(compare.summary(result))
        note("2/3 checking the twin against a reference that shares no code with it")
        checked = check(parameters, place, progress=note)
        say(crosscheck.summary(checked))
        note("3/3 filming")
        out = folder(self.output.out or Path("out/demo"))
        film = None if blind else _film(result, out)
        if blind:
            note(f"no film: {blind}")

        sections = [
            compare_section(result),
            *([film_section(film)] if film else []),
            crosscheck_section(checked),
            model_section(result.run.twin),
        ]
        save_figures(sections, out)
        result.run.twin.save(out / "model.xml")
        save_run(result.run, out / "run.npz")
        report = write_report(
            out / "report.html",
            f"{result.log.name}: the robot and its twin",
            [*compare_verdict(result), *checked.sentences],
            sections,
        )
        write_result(
            out / "result.json",
            self,
            {"compare": result.to_json(), "crosscheck": checked.to_json()},
        )
        say(f"report: {report}" + (f"\nfilm:   {film}" if film else ""))
        return 0 if checked.passed else 1


def _shipped(log: Path) -> Path:
    """The log, or the one of that name that came with the source."""
    source = Path(__file__).parents[2] / log
    return source if not log.exists() and source.exists() else log


def _film(result: Comparison, out: Path) -> Path | None:
    """The first ten seconds as a film; None, and a sentence, where nothing can be drawn."""
    from identification.errors import GraphicsError
    from inca_mj.film import film
    from inca_mj.logs import pose_of

    shown = result.run.until(min(10.0, float(result.run.time[-1])))
    n = len(shown.time)
    pose = pose_of(result.log)
    try:
        return film(
            shown,
            out / "film.mp4",
            measured=result.log.outputs[:n],
            measured_pose=None if pose is None else pose[:n],
            progress=bar("film"),
        )
    except GraphicsError as error:
        note(f"no film: {error}")
        return None
