"""identification excite ROBOT [RESULT]: the next experiment of any robot."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import tyro

from identification.commands.common import LogLists, Output, Trust, flat, note
from identification.commands.robots import conclude_files
from identification.errors import InputError


@dataclass(frozen=True)
class Excite:
    """Design the next experiment, within limits: for the worst-known values, or for rivals.

    Examples:
        identification excite robot.toml --log a.csv --out out/next
        identification excite robot.toml out/found --seconds 20 --widen 0.2
    """

    robot: Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="ROBOT")]
    """TOML that names model, columns, free parameters and candidates."""
    result: Annotated[Path | None, tyro.conf.Positional, tyro.conf.arg(metavar="RESULT")] = None
    """Folder that fit or discover has written with --out; its set of rivals is to be ended."""
    log: LogLists = ()
    """Logs that were recorded so far; those of RESULT when not given."""
    seconds: float | None = None
    """How long the experiment lasts [s]; as long as the first log when not given."""
    widen: float = 0.0
    """Share of itself by which the range of the logs is widened on each side, where the model has
    no range."""
    form: Literal["auto", "inputs", "reference"] = "auto"
    """Inputs that are played as they are, or a motion that a controller follows."""
    budget: int = 60
    """Experiments that the search evaluates."""
    seed: int = 0
    """Of the search."""
    trust: Trust = ()
    output: Output = Output()

    def run(self) -> int:
        """Read, design, say, keep."""
        from identification.report.experiment_words import FILE
        from identification.robot.experiment import design_experiment
        from identification.robot.reading import read_robot

        robot = read_robot(self.robot, self.logs(), trust=flat(self.trust))
        for remark in robot.remarks:
            note(remark)
        found = design_experiment(
            robot, self.result, seconds=self.seconds, widen=self.widen, form=self.form,
            budget=self.budget, seed=self.seed, progress=self.output.tell,
        )  # fmt: skip
        files = found.files
        text = "\n".join(files.record["verdict"])
        saved = "" if self.output.out is None else f"Written: {self.output.out / FILE}"
        conclude_files(self, files, text, "design", saved)
        return 0

    def logs(self) -> Sequence[Path]:
        """Returns the logs that were given, or else those of the result; refuses to have none."""
        from identification.storage.results import read_result

        given = flat(self.log)
        if given or self.result is None:
            if not given:
                raise InputError(
                    "a log tells noise, sampling and range of the robot, and none is given; write"
                    " --log LOG, or the folder of a result"
                )
            return given
        said: dict[str, Any] = read_result(self.result).get("configuration", {})
        confirm = [name for group in said.get("confirm", []) for name in group]
        logs = [Path(name) for name in (*said.get("logs", []), *confirm)]
        missing = [path for path in logs if not path.is_file()]
        if not logs or missing:
            what = f"names {missing[0]}, which is no file here" if missing else "names no log"
            raise InputError(f"{self.result} {what}; write the logs behind --log")
        return logs
