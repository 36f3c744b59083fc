"""Shared parts of the commands: values of options, and where results go and how they are told."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import tyro

from identification.commands.beat import told
from identification.commands.stopping import leaving_out
from identification.errors import InputError
from identification.storage.folders import draft_of
from identification.storage.results import RESULT, plain_text, write_result

if TYPE_CHECKING:
    from identification.report.page.page import Section
    from identification.storage.folders import Draft

T = TypeVar("T")
_BACKENDS = ("egl", "osmesa", "glfw")  # of MuJoCo, by the words of MUJOCO_GL
LOG_KINDS = (
    "A log of any kind: .csv (with a TOML beside it), .mat (with u, y and Ts), .npz, .parquet, an"
    " episode of LeRobot, .mcap, .db3, .bag, or a folder of ROS."
)
OneLog = Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="LOG", help=LOG_KINDS)]
LogLists = Annotated[  # an option that takes logs and may be given again; see `flat`
    tuple[tuple[Path, ...], ...], tyro.conf.UseAppendAction, tyro.conf.arg(metavar="LOG")
]
Trust = Annotated[
    tuple[tuple[str, ...], ...],
    tyro.conf.UseAppendAction,
    tyro.conf.arg(
        metavar="WORD",
        help="What you know better than a check: contacts, gaps, joints, limits, rows, sensors,"
        " start, steps, time, units, wiring.",
    ),
]


@dataclass(frozen=True)
class Output:
    """The way in which results are said and kept."""

    json: bool = False
    """Print one JSON object on stdout and nothing else."""
    out: Annotated[Path | None, tyro.conf.arg(metavar="DIR")] = None
    """Folder for the results, result.json among them; made when missing."""
    quiet: bool = False
    """Say nothing of the progress."""

    def tell(self, text: str) -> None:
        """Writes one line about progress to stderr, unless it shall be quiet."""
        if not self.quiet:
            note(text)


def say(text: str) -> None:
    """Writes one line of a result to stdout."""
    sys.stdout.write(text + "\n")
    sys.stdout.flush()


def flat(groups: Iterable[Iterable[T]]) -> list[T]:
    """Returns all values that were given to an option, however often it was written."""
    return [each for group in groups for each in group]


def assignments(texts: Sequence[str], option: str, example: str = "m=0.2") -> dict[str, float]:
    """Returns the values of an option whose words are NAME=VALUE, or refuses a wrong one."""
    values: dict[str, float] = {}
    for text in texts:
        name, equals, right = text.partition("=")
        name = name.strip()
        try:
            value = float(right if equals else "none")
        except ValueError:
            raise InputError(f"{text!r} is not NAME=VALUE; write e.g. {option} {example}") from None
        if name in values:
            raise InputError(
                f"{option} gives {name} twice, {values[name]:g} and {value:g}; give it once"
            )
        values[name] = value
    return values


def note(text: str) -> None:
    """Writes one line to stderr, above the bars of progress if there are some."""
    told()
    if "tqdm" in sys.modules:
        sys.modules["tqdm"].tqdm.write(text, file=sys.stderr)
    else:
        sys.stderr.write(text + "\n")


def say_json(result: Mapping[str, Any]) -> None:
    """Writes the result as one JSON object to stdout; what is not finite is null."""
    say(json.dumps(plain_text(result), allow_nan=False))


def conclude(
    command: Any,
    record: Mapping[str, Any],
    text: str,
    keep: Callable[[Path], object] | None = None,
    draw: Callable[[Path], object] | None = None,
    saved: str = "",
) -> bool:
    """Save the results in the folder that was asked for, say them, then draw.

    Args:
        command: with its `output`; its fields are the configuration that result.json tells.
        record: the results as plain values: result.json, and what `--json` prints.
        text: what is printed without `--json`.
        keep: writes more results into a folder: logs, a model.
        draw: writes figures and the report into a folder.
        saved: what is printed below the text once the results are saved.

    Returns:
        Whether figures and report were written.
    """
    output: Output = command.output
    with ExitStack() as stack:
        draft, told = None, text
        try:
            if output.out is not None:
                draft = stack.enter_context(draft_of(output.out))
                write_result(draft.folder / RESULT, command, record)
                if keep is not None:
                    try:
                        keep(draft.folder)
                    except (InputError, OSError):
                        raise
                    except Exception as error:  # nothing else may cost what took minutes to find
                        _note_without("data and model", error)
                draft.save()
                told = "\n".join(line for line in (text, saved) if line)
        finally:  # a full disk must not cost what took minutes
            if output.json:
                say_json(record)
            else:
                say(told)
        if draft is None or draw is None:
            return False
        # Behind the results, so that an interrupt or an error costs the drawings only.
        return add_drawings(draft, "figures and report", partial(draw, draft.folder))


def add_drawings(draft: Draft, what: str, write: Callable[[], object]) -> bool:
    """Add drawings to results that were saved; returns whether no error kept them away."""
    try:
        with leaving_out(f"left out: {what}; the results are kept in {draft.place}"):
            write()
            draft.save()
    except Exception as error:  # a full disk, too: what was saved before is whole
        reason = str(error).replace(str(draft.folder), str(draft.place))
        _note_without(what, reason or type(error).__name__, f" in {draft.place}")
        return False
    return True


def _note_without(what: str, error: Exception | str, where: str = "") -> None:
    reason = (str(error).strip() or type(error).__name__).splitlines()[0]
    note(f"no {what}: {reason}; the results are kept without{where}")


def draw_report(
    out: Path, title: str, verdict: Sequence[str], sections: Sequence[Section], **how: Any
) -> None:
    """Write the figures of sections and the one-file report into a folder; see `write_report`."""
    from identification.report.page.page import save_figures, write_report

    save_figures(sections, out)
    write_report(out / "report.html", title, verdict, sections, **how)


def import_without_graphics(*, own_methods: bool = False) -> None:
    """Makes MuJoCo be imported without OpenGL, here and in processes that begin from here.

    Nothing of these commands draws with it, and MuJoCo's import dies of a wrong MUJOCO_GL. Where
    methods of the user run, which may draw, it stays if it names one of MuJoCo's backends.
    """
    backend = os.environ.get("MUJOCO_GL", "").lower().strip()
    if not (own_methods and backend in _BACKENDS):
        os.environ["MUJOCO_GL"] = "disable"


def table(head: tuple[str, ...], rows: Sequence[tuple[str, ...]]) -> str:
    """Returns a plain text table whose cells are aligned to the right."""
    lines = [head, *rows]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    return "\n".join(
        "  ".join(cell.rjust(width) for cell, width in zip(line, widths, strict=True))
        for line in lines
    )


def parameter_table(rows: Iterable[tuple[str, float, float, str, float, bool]]) -> str:
    """Returns a table of name, value, std, unit, start and whether the value is at a bound."""
    from identification.quantities import matched

    cells = [
        (name, *matched(value, std), unit, f"{start:z.6g}", "at bound" if bound else "")
        for name, value, std, unit, start, bound in rows
    ]
    return table(("parameter", "value", "std", "unit", "start", ""), cells)
