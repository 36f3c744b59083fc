"""inca discover LOG..., inca demo: what the model lacks, with proof on unseen data."""

from __future__ import annotations

import time
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

import inca_mj as inca
from identification.commands.common import LogLists, Output, add_drawings, flat, note, say, say_json
from identification.commands.stopping import NO_ANSWER, leaving_out
from identification.errors import InputError
from identification.runtime.progress import duration
from identification.storage.folders import draft_of
from identification.storage.results import RESULT, write_result
from inca_mj.commands.common import Trust, Values, cannot_draw, do_not_draw, read_logs
from inca_mj.files import example_path

if TYPE_CHECKING:
    from identification.discovery.result import Discovery
    from identification.storage.folders import Draft
    from inca_mj.workflows.discovery_files import TwinDiscoveryFiles

FILES = {  # by what they are called, in the order in which they are named
    "report": "report.html", "model": "model.xml", "effects": "effects.json", "film": "film.mp4",
}  # fmt: skip
LEAVE_OUT = "Ctrl-C leaves it out, and so does --no-film"


@dataclass(frozen=True)
class Discover:
    """Find what the model lacks and prove it on unseen data, or say that it is unknown.

    Examples:
        inca discover examples/log.csv --spread none --out out/discover
        inca discover a.csv b.csv --confirm c.csv --out out/discover
    """

    log: Annotated[tuple[Path, ...], tyro.conf.Positional, tyro.conf.arg(metavar="LOG")]
    """Logs to explain; the TOML of each may name the split estimation; the rest is unseen."""
    confirm: LogLists = ()
    """Logs for the proof, of which a fit sees the first two seconds; the flag may be repeated."""
    spread: str = "usual"
    """How much the drives and points of one robot differ: none, usual, or a TOML file."""
    film: bool = True
    """Film the model before and after against unseen seconds of the log; only with --out."""
    settled: bool = False
    """The robot stood at rest by itself, with what the twin lacks, when the log began."""
    options: Annotated[Path | None, tyro.conf.arg(metavar="PATH")] = None
    """TOML file of options: min_proof_t = 3.0, without = ["add_pair"], ... (docs/discovery.md)."""
    minutes: float | None = None
    """Time after which no further effect is sought (10 if not given). What comes before and after
    is always finished and counts besides: the fit without effects, last checks and the report."""
    trust: Trust = ()
    """Checks of the log that you overrule: sensors, units, wiring."""
    robot: Values = Values()
    output: Output = Output()

    def run(self) -> int:
        """Discover, say, keep."""
        blind = ""
        if self.film and self.output.out is not None:
            blind = cannot_draw()  # before MuJoCo is imported
        else:
            do_not_draw()
        from identification.discovery.options import options_of

        if not self.log:
            raise InputError("no log is given; write inca discover LOG")
        trust = flat(self.trust)
        logs, confirm = read_logs(self.log, trust), read_logs(flat(self.confirm), trust)
        parameters, place = self.robot.parameters(), self.robot.place()
        spread = inca.spread_of(self.spread)
        options = options_of(self.options, self.minutes)
        for path, log in zip(self.log, logs, strict=True):
            self.output.tell(f"log {path}: {log.duration:.4g} s, {len(log)} samples")
        with leaving_out(NO_ANSWER):
            found = inca.discover(
                logs, parameters, place, confirm=confirm, spread=spread, progress=self.output.tell,
                settled=self.settled, options=options, trust=trust,
            )  # fmt: skip
        from identification.report.discovery.report import discovery_text  # slow to import
        from inca_mj.workflows.discovery_files import TwinDiscoveryFiles

        files = TwinDiscoveryFiles(found)
        if not self.output.json:
            say(discovery_text(found))
        model: dict[str, str] = {}
        with ExitStack() as stack:
            draft = None
            try:  # what was found is said even where it cannot be saved
                if self.output.out is not None:
                    draft = stack.enter_context(draft_of(self.output.out))
                    saved = files.keep(draft.folder, draft.place)
                    write_result(draft.folder / RESULT, self, {**files.record, **saved})
                    model = {"model": str(draft.place / saved["model"])}
                    draft.save()
            finally:
                if self.output.json:
                    say_json({**files.record, **model})
            if draft is not None:
                self._draw(found, files, draft, blind)
                if not self.output.json:
                    places = {what: draft.place / name for what, name in FILES.items()}
                    lines = [f"{what + ':':<8} {at}" for what, at in places.items() if at.exists()]
                    say("\n" + "\n".join(lines))
        return 0

    def _draw(self, found: Discovery, files: TwinDiscoveryFiles, draft: Draft, blind: str) -> None:
        """Add figures and the report to the saved results, and then the film."""
        begun, tell = time.monotonic(), self.output.tell
        page = draft.folder / FILES["report"]

        def write() -> bool:
            tell("drawing the report")
            if not add_drawings(draft, "figures and report", lambda: files.draw(draft.folder)):
                return False
            drawn = duration(time.monotonic() - begun)
            tell(f"report: {draft.place / page.name} (drawn in {drawn}, beside the search)")
            return True

        if blind or not self.film:
            if write() and blind:
                note(f"no film: {blind}")
            return
        from inca_mj.commands.film import FilmProgress
        from inca_mj.commands.filmed import FPS, film_beside

        progress = FilmProgress(tell, FPS, hint=LEAVE_OUT)
        with film_beside(found, draft.folder, progress) as film:
            if write() and add_drawings(draft, "film", lambda: files.write_filmed(page, film())):
                tell(f"the film took {duration(time.monotonic() - begun)}")


@dataclass(frozen=True)
class Demo:
    """Find what the model lacks of the robot in a log, prove it, film it, write one report.

    Examples:
        inca demo
        inca demo examples/log.csv --no-film --out out/mine
    """

    log: Annotated[Path | None, tyro.conf.Positional, tyro.conf.arg(metavar="LOG")] = None
    """The log; the one that comes with the program when none is given."""
    film: bool = True
    """Film the model before and after against unseen seconds of the log."""
    robot: Values = Values()
    output: Output = Output(out=Path("out/demo"))

    def run(self) -> int:
        """Do all of it, say the verdict first and where the report lies last."""
        log = self.log or example_path()
        return Discover((log,), film=self.film, robot=self.robot, output=self.output).run()
