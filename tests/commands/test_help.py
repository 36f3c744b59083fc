"""What a help shows can be run, a shell can complete it, and progress can be had or not."""

import re
import shlex
import subprocess
import sys
from io import StringIO

import pytest

from identification.__main__ import main as identification
from identification.commands.arguments import SHELLS, _commands, examples_of, parsed
from identification.commands.cli import EXAMPLES as ROBOT_EXAMPLES
from identification.commands.cli import Command as RobotCommand
from identification.commands.program import metered
from identification.progress import stage
from identification.refusals.trust import TRUST
from inca_mj.cli import EXAMPLES, Command
from inca_mj.cli import main as inca

PROGRAMS = {"inca": (Command, inca, EXAMPLES),
            "identification": (RobotCommand, identification, ROBOT_EXAMPLES)}  # fmt: skip
SHIPPED = ("examples/", "models/")
EVERY = [
    (program, name, example)
    for program, (commands, _, _) in PROGRAMS.items()
    for name, command in _commands(commands)
    for example in examples_of(command)
] + [(p, None, example) for p, (_, _, examples) in PROGRAMS.items() for example in examples]


@pytest.mark.parametrize(("program", "name", "example"), EVERY, ids=[e[2] for e in EVERY])
def test_an_example_is_a_right_command_line(program, name, example, request):
    words = shlex.split(example)
    assert words[0] == program
    arguments = words[1:]
    commands = PROGRAMS[program][0]
    assert name in (None, arguments[0])
    assert type(parsed(commands, program, "", arguments)) is dict(_commands(commands))[arguments[0]]
    for word in arguments:
        if word.startswith(SHIPPED):
            assert (request.config.rootpath / word).is_file()


@pytest.mark.parametrize("program", PROGRAMS)
def test_every_help_ends_with_two_examples(capsys, program):
    commands, main, examples = PROGRAMS[program]
    for name, command in [*_commands(commands), (None, None)]:
        with pytest.raises(SystemExit) as end:
            main([name, "--help"] if name else ["--help"])
        assert not end.value.code
        shown = examples_of(command) if command else examples
        assert len(shown) == 2
        lines = capsys.readouterr().out.splitlines()
        assert lines[-3:] == ["examples:", *(f"  {example}" for example in shown)]


@pytest.mark.parametrize("shell", SHELLS)
def test_a_shell_gets_a_script_that_completes(capsys, shell):
    with pytest.raises(SystemExit) as end:
        inca(["--completion", shell])
    assert not end.value.code
    script = capsys.readouterr().out
    for name, _ in _commands(Command):
        assert re.search(rf"\b{name}\b", script)
    assert "examples:" not in script


def test_bash_completes_a_command(capsys):
    with pytest.raises(SystemExit):
        inca(["--completion", "bash"])
    ask = 'COMP_WORDS=(inca cali); COMP_CWORD=1; _tyro_inca; echo "${COMPREPLY[@]}"'
    script = capsys.readouterr().out + ask
    done = subprocess.run(["bash"], input=script, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "calibrate"


@pytest.mark.parametrize("quiet", [True, False])
def test_progress_is_told_unless_it_shall_be_quiet(capsys, quiet):
    line = ["crosscheck", "--duration", "0.1", "--states", "20"]
    assert inca(line + ["--quiet"] * quiet) == 0
    out, error = capsys.readouterr()
    assert out
    assert (error == "") is quiet


class Screen(StringIO):
    def isatty(self):
        return True


def test_bars_are_drawn_on_a_terminal_only(monkeypatch):
    monkeypatch.setattr("identification.commands.program.SLOW", 0)
    monkeypatch.setenv("COLUMNS", "80")
    for screen, quiet, drawn in [(Screen(), False, True), (Screen(), True, False),
                                 (StringIO(), False, False)]:  # fmt: skip
        monkeypatch.setattr(sys, "stderr", screen)
        with metered(quiet), stage("refits", 1) as advance:
            advance()
            advance()  # more than it was said to take
        assert ("refits" in screen.getvalue()) is drawn


def test_the_help_of_trust_lists_every_word(capsys):
    with pytest.raises(SystemExit):
        identification(["fit", "--help"])
    said = " ".join(capsys.readouterr().out.replace("│", " ").split())
    assert f"{', '.join(sorted(TRUST))}." in said
