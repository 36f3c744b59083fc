"""What a help shows can be run, a shell can complete it, and progress can be had or not."""

import re
import shlex
import subprocess

import pytest

from identification.__main__ import main as identification
from identification.commands.arguments import _commands, examples_of, parsed
from identification.commands.cli import EXAMPLES as ROBOT_EXAMPLES
from identification.commands.cli import Command as RobotCommand
from identification.logs.formats.formats import KINDS
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


@pytest.mark.parametrize("command", ["new", "inspect", "fit", "discover", "torques"])
def test_the_help_of_a_log_names_every_kind(command, capsys):
    with pytest.raises(SystemExit):
        identification([command, "--help"])
    said = capsys.readouterr().out
    assert [kind for kind in KINDS if kind not in said] == []
    assert "LeRobot" in said


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


def test_the_help_of_trust_has_every_word_and_no_other(capsys):
    """The words are written out there, because a help must not wait for MuJoCo."""
    from identification.refusals.trust import TRUST

    with pytest.raises(SystemExit):
        identification(["fit", "--help"])
    said = " ".join(re.sub("[│╭╮╰╯─]", " ", capsys.readouterr().out).split())
    told = re.search(r"better than a check: ([a-z, ]+)\.", said)
    assert told[1].split(", ") == sorted(TRUST)
