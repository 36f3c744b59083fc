"""The program `inca`: one command a file in `inca_mj.commands`; heavy imports wait until needed.

Exit code 0: done; 1: the check failed; 2: bad input, said in one sentence.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Annotated

import tyro

from inca_mj.commands.compare import Compare
from inca_mj.commands.crosscheck import Crosscheck
from inca_mj.commands.demo import Demo
from inca_mj.commands.discover import Discover
from inca_mj.commands.excite import Excite
from inca_mj.commands.film import Film
from inca_mj.commands.identify import Identify
from inca_mj.commands.sensitivity import Sensitivity
from inca_mj.commands.simulate import Simulate
from inca_mj.commands.trials import Trials

Command = (
    Annotated[Simulate, tyro.conf.subcommand("simulate")]
    | Annotated[Compare, tyro.conf.subcommand("compare")]
    | Annotated[Crosscheck, tyro.conf.subcommand("crosscheck")]
    | Annotated[Identify, tyro.conf.subcommand("identify")]
    | Annotated[Discover, tyro.conf.subcommand("discover")]
    | Annotated[Sensitivity, tyro.conf.subcommand("sensitivity")]
    | Annotated[Excite, tyro.conf.subcommand("excite")]
    | Annotated[Trials, tyro.conf.subcommand("trials")]
    | Annotated[Film, tyro.conf.subcommand("film")]
    | Annotated[Demo, tyro.conf.subcommand("demo")]
)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; returns the exit code."""
    try:
        command = tyro.cli(
            Command,
            prog="inca",
            description="The digital twin of the INCA 6D cable robot, and what it lacks.",
            args=arguments,
            config=(tyro.conf.AvoidSubcommands,),
        )
        return command.run()
    except ValueError as error:
        from identification.errors import InputError

        if not isinstance(error, InputError):
            raise
        sys.stderr.write(f"inca: {error}\n")
        return 2
    except BrokenPipeError:  # the reader of stdout has gone, e.g. `| head`
        sys.stderr.close()
        return 0
    except OSError as error:
        sys.stderr.write(f"inca: {error.strerror or error}; make room or choose another place\n")
        return 2
    except KeyboardInterrupt:
        sys.stderr.write("inca: stopped\n")
        return 130


if __name__ == "__main__":
    sys.exit(main())
