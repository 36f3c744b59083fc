"""inca discover LOG...: what the model lacks, with proof on unseen data."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import tyro

from identification.commands.common import (
    Output,
    flat,
    keep_if_possible,
    note,
    output_field,
    say,
    say_json,
    write_result,
)
from inca_mj.commands.common import Trust, Values, cannot_draw, do_not_draw, values_field

if TYPE_CHECKING:
    from identification.discovery.result import Discovery
    from identification.report.page import Section
    from inca_mj.twin.twin import Twin

FILES = "The model with it is in model.xml and effects.json; inca_mj.load_twin reads them."


@dataclass(frozen=True)
class Discover:
    """Find what the model lacks and prove it on unseen data, or say that it is unknown.

    Examples:
        inca discover examples/log.csv --spread none --out out/discover
        inca discover a.csv b.csv --confirm c.csv --out out/discover
    """

    log: Annotated[tuple[Path, ...], tyro.conf.Positional, tyro.conf.arg(metavar="LOG")]
    """Logs to explain; the TOML of each may name the split estimation; the rest is unseen."""
    confirm: Annotated[
        tuple[tuple[Path, ...], ...], tyro.conf.UseAppendAction, tyro.conf.arg(metavar="LOG")
    ] = ()
    """Logs for the proof, of which a fit sees the first two seconds; the flag may be repeated."""
    spread: str = "usual"
    """How much the drives and points of one robot differ: none, usual, or a TOML file."""
    film: bool = True
    """Film the model before and after against unseen seconds of the log; only with --out."""
    settled: bool = False
    """The robot stood at rest by itself, with what the twin lacks, when the log began."""
    options: Annotated[Path | None, tyro.conf.arg(metavar="PATH")] = None
    """TOML file with judgement constants, such as min_proof_t = 3.0 (docs/discovery.md)."""
    trust: Trust = ()
    """Checks of the log that you overrule: sensors, units, wiring."""
    robot: Annotated[Values, tyro.conf.OmitArgPrefixes] = values_field
    output: Annotated[Output, tyro.conf.OmitArgPrefixes] = output_field

    def run(self) -> int:
        """Discover, say, keep."""
        blind = ""
        if self.film and self.output.out is not None:
            blind = cannot_draw()  # before MuJoCo is imported
        else:
            do_not_draw()
        from identification.discovery.options import read_options
        from identification.errors import InputError
        from inca_mj.twin.logs import read_inca_log
        from inca_mj.workflows.discovery import discover
        from inca_mj.workflows.spread import spread_of

        if not self.log:
            raise InputError("no log is given; write inca discover LOG")
        logs = [read_inca_log(path, flat(self.trust)) for path in self.log]
        confirm = [read_inca_log(path, flat(self.trust)) for path in flat(self.confirm)]
        parameters, place = self.robot.parameters(), self.robot.place()
        spread = spread_of(self.spread)
        options = None if self.options is None else read_options(self.options)
        for path, log in zip(self.log, logs, strict=True):
            self.output.tell(f"log {path}: {log.duration:.4g} s, {len(log)} samples")
        found = discover(
            logs,
            parameters,
            place,
            confirm=confirm,
            spread=spread,
            progress=self.output.tell,
            settled=self.settled,
            options=options,
            trust=flat(self.trust),
        )
        from identification.report.discovery_text import discovery_text  # slow to import

        if not self.output.json:
            say(discovery_text(found))
        files: dict[str, Path] = {}
        try:
            files = self._keep(found, blind)
        finally:  # what was found is said even where it cannot be kept
            if self.output.json:
                say_json(as_json(found, files.get("model")))
        if files and not self.output.json:
            say("\n" + "\n".join(f"{what + ':':<8} {path}" for what, path in files.items()))
        return 0

    def _keep(self, found: Discovery, blind: str) -> dict[str, Path]:
        """Keep the results in the folder that was asked for; the paths by kind."""
        from identification.folders import whole_folder
        from identification.progress import duration

        if (out := self.output.out) is None:
            return {}
        begun = time.monotonic()
        if blind:
            note(f"no film: {blind}")
        with whole_folder(out) as draft:
            files = keep(found, draft, self, film=self.film and not blind)
        drawn = duration(time.monotonic() - begun)
        self.output.tell(f"report, figures and film took {drawn}, beside the search")
        return {what: out / path.name for what, path in files.items()}


def as_json(found: Discovery, model: Path | None) -> dict[str, Any]:
    """The outcome and the path of its model as plain values; what is not finite is null."""
    from identification.report.discovery_json import discovery_to_json

    return {**discovery_to_json(found), "model": None if model is None else str(model)}


def keep(found: Discovery, out: Path, command: Any, *, film: bool) -> dict[str, Path]:
    """Write report, figures, model, effects, result and film into a folder; the paths by kind."""
    from identification.report.discovery_report import write_discovery_report
    from inca_mj.report.sections import model_section
    from inca_mj.twin.saved import save_twin
    from inca_mj.workflows.discovery_model import named_twin

    robot = named_twin(found)
    model, effects = save_twin(robot, out)
    write_result(out / "result.json", command, as_json(found, Path(model.name)))
    files = {"model": model, "effects": effects}

    def draw() -> None:
        command.output.tell("drawing the report")
        drawn = _film(found, out, command.output.tell) if film else None
        more = [*([drawn[1]] if drawn else []), model_section(_without_zeros(robot))]
        files.update({"film": drawn[0]} if drawn else {})
        files["report"] = write_discovery_report(found, out, sections=more, files=FILES)

    keep_if_possible("figures and report", draw)
    order = ("report", "model", "effects", "film")
    return {what: files[what] for what in order if what in files}


def _without_zeros(robot: Twin) -> Twin:
    """The twin without the parameters of effects that are zero, which need no row in a table."""
    from dataclasses import replace

    shown = tuple(p for p in robot.parameters if p.where != "effect" or p.value)
    return replace(robot, parameters=replace(robot.parameters, records=shown))


def _film(found: Discovery, out: Path, tell: Callable[[str], None]) -> tuple[Path, Section] | None:
    """The film and its section; None, and a sentence, where it cannot be drawn."""
    from identification.errors import DivergenceError, GraphicsError, InputError
    from inca_mj.commands.film_progress import FilmProgress
    from inca_mj.commands.filmed import FPS, film_discovery

    try:
        return film_discovery(found, out, FilmProgress(tell, FPS))
    except (DivergenceError, GraphicsError, InputError) as error:
        note(f"no film: {error}")
        return None
