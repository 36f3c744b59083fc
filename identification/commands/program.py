"""A program of several commands: its errors in one sentence, its exit codes.

0: done; 1: the check failed; 2: bad input, said in one sentence; 130: stopped by Ctrl-C.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from itertools import pairwise
from typing import Any

from identification.commands.arguments import parsed
from identification.commands.beat import Beat, beating
from identification.commands.common import note
from identification.commands.places import refuse_place
from identification.commands.stopping import STOPPED, stoppable
from identification.errors import InputError
from identification.runtime.progress import USUAL, watched

SLOW = 0.5  # [s] before a bar is drawn, so that short stages do not flicker


@contextmanager
def metered(quiet: bool) -> Iterator[None]:
    """Show the stages of the block on stderr, with the time that each will still take.

    A terminal has a bar for each; everywhere a line is said at least every `beat.EVERY` seconds.
    Nothing is shown when it shall be quiet.
    """
    if quiet:
        yield
        return
    show = _bar if sys.stderr.isatty() else None
    with beating(Beat(note)) as beat, watched(partial(beat.stage, show=show), beat.follow):
        yield


@contextmanager
def _bar(what: str, steps: int | None) -> Iterator[Callable[[], None]]:
    from tqdm import tqdm

    with tqdm(total=steps or USUAL, desc=what, leave=False, delay=SLOW, file=sys.stderr) as meter:

        def advance() -> None:
            meter.total = max(meter.total, meter.n + 1)
            meter.update()

        yield advance


def run_program(
    commands: Any,
    name: str,
    description: str,
    arguments: Sequence[str] | None = None,
    examples: tuple[str, ...] = (),
) -> int:
    """Run the command that the arguments name; returns the exit code.

    Args:
        commands: a union of dataclasses with a method `run`, as tyro takes it.
        name: of the program.
        description: what it does.
        arguments: those of the process when None.
        examples: command lines that its help shows.
    """
    given = sys.argv[1:] if arguments is None else arguments
    # All is drawn without a screen; matplotlib fails to import under a name that it does not know.
    os.environ["MPLBACKEND"] = "agg"
    try:
        with stoppable(name):
            try:
                if [*given] == ["--version"]:
                    sys.stdout.write(f"{name} {versions()}\n")
                    return 0
                if "--out=" in given or ("--out", "") in pairwise(given):
                    # it would be the folder in which the user stands
                    raise InputError('--out is given as ""; name a folder, such as --out out/run')
                command = parsed(commands, name, description, given, examples)
                refuse_place(command)
                output = getattr(command, "output", None)
                with metered(getattr(output, "quiet", False)):
                    return int(command.run())
            finally:
                sys.stdout.flush()  # the help too may not find room
    except ValueError as error:
        if not isinstance(error, InputError):
            raise
        sys.stderr.write(f"{name}: {error}\n")
        return 2
    except BrokenPipeError:  # the reader of stdout has gone, e.g. `| head`
        sys.stderr.close()
        return 0
    except OSError as error:
        reason = error.strerror or type(error).__name__
        what = f"cannot write to {error.filename}: {reason}" if error.filename else reason
        sys.stderr.write(f"{name}: {what}; make room or choose another place\n")
        return 2
    except KeyboardInterrupt:
        return STOPPED


def versions() -> str:
    """Returns the versions of the package, of MuJoCo and of Python."""
    from importlib.metadata import version

    python = sys.version.split()[0]
    return f"{version('inca-mj')}, MuJoCo {version('mujoco')}, Python {python}"
