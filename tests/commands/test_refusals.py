"""A wrong command line is told in one sentence, with what would be right."""

import pytest

from identification.__main__ import main as identification
from identification.commands.arguments import gathered
from identification.commands.cli import Command
from inca_mj.cli import Command as IncaCommand
from inca_mj.cli import main as inca

WRONG = [
    (inca, "", "no command is given; give one of simulate, compare"),
    (inca, "simulat", "unknown command 'simulat'; did you mean 'simulate'?"),
    (inca, "simulate --durration 3", "'--durration'; did you mean '--duration'? known: --duration"),
    (inca, "simulate --duration fast", "--duration is 'fast'; give a number; inca simulate --help"),
    (inca, "simulate --set none", "--set is 'none'; give one of simulation, trial"),
    (inca, "film", "LOG|RUN is missing; write inca film LOG|RUN"),
    (inca, "film a.npz b.npz c.npz", "3 logs and runs; a film shows one, or two"),
    (inca, "film README.md", "README.md is neither a log nor a run; give a log (.csv, .mat)"),
    (inca, "linearize --pose a.csv", "--pose is 'a.csv'; write a log behind --log, as --log a.csv"),
    (inca, "linearize --grid", "--grid has no axis; give one or more as NAME=LOW:HIGH:POINTS"),
    (inca, "statics --taut 100", "every cable shall keep 100 N, but with the largest current"),
    (inca, "simulate --figure 2.16 --set trial", "is made with --set simulation, not trial"),
    (inca, "identify", "LOG is missing; write inca identify LOG"),
    (inca, "compare a.csv b.csv", "b.csv is one argument too many"),
    (inca, "discover a.csv --spread", "--spread has no value; give one behind it"),
    (identification, "fit", "ROBOT is missing; write identification fit ROBOT LOG"),
    (identification, "fit robot.toml a.csv --horizon 1", "unknown option of identification fit:"),
]


@pytest.mark.parametrize(("program", "line", "said"), WRONG, ids=[w[1] or "none" for w in WRONG])
def test_a_wrong_line_is_told_in_one_sentence(capsys, program, line, said):
    assert program(line.split()) == 2
    out, error = capsys.readouterr()
    assert out == ""
    assert error.count("\n") == 1
    assert said in error


@pytest.mark.parametrize(("commands", "written", "read"), [
    (IncaCommand, "identify a.csv --free A --free B", "identify a.csv --free A B"),
    (IncaCommand, "identify a.csv --param m=1 --seed 3 --param=b=2",
     "identify a.csv --param m=1 b=2 --seed 3"),
    (Command, "fit --help", "fit --help"),
])  # fmt: skip
def test_what_is_repeated_adds_up(commands, written, read):
    assert gathered(commands, written.split()) == read.split()
