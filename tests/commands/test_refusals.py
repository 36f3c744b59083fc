"""A wrong command line is told in one sentence, with what would be right."""

import pytest

from identification.__main__ import main as identification
from identification.commands.arguments import gathered
from identification.commands.cli import Command
from identification.errors import LISTED, NEAREST, unknown_name
from inca_mj.cli import Command as IncaCommand
from inca_mj.cli import main as inca

WRONG = [
    (inca, "", "no command is given; give one of simulate, compare"),
    (inca, "simulat", "unknown command 'simulat'; did you mean 'simulate'?"),
    (inca, "--verbose", "unknown command '--verbose'; known: calibrate"),
    (inca, "simulate --durration 3", "'--durration'; did you mean '--duration'? known: --duration"),
    (inca, "simulate --duration fast", "--duration is 'fast'; give a number; inca simulate --help"),
    (inca, "simulate --duration=fast", "--duration is 'fast'; give a number"),
    (inca, "simulate --seed 1.5", "--seed is '1.5'; give a whole number"),
    (inca, "simulate --set none", "--set is 'none'; give one of simulation, trial"),
    (inca, "film log.csv --still x", "--still is 'x'; give a number"),
    (inca, "film", "LOG|RUN is missing; write inca film LOG|RUN"),
    (inca, "film a.npz b.npz c.npz", "3 logs and runs; a film shows one, or two"),
    (inca, "film README.md", "README.md is neither a log nor a run; give a log (.csv, .mat)"),
    (inca, "linearize --pose a.csv", "--pose is 'a.csv'; write a log behind --log, as --log a.csv"),
    (inca, "linearize --pose 1 x", "--pose is '1'; give X Y Z ROLL PITCH YAW"),
    (inca, "linearize --grid", "--grid has no axis; give one or more as NAME=LOW:HIGH:POINTS"),
    (inca, "statics --pose 0 0 1", "--pose is '0'; give X Y Z ROLL PITCH YAW"),
    (inca, "statics --taut 100", "every cable shall keep 100 N, but with the largest current"),
    (inca, "kinematics", "no pose and no log is given; write inca kinematics X Y Z ROLL PITCH YAW"),
    (inca, "simulate --figure 2.16 --set trial", "is made with --set simulation, not trial"),
    (inca, "simulate --figure 3.2 --input step", "is made with --input prbs, not step"),
    (inca, "simulate --figure 2.16 --duration 11", "is made with --duration 10.0, not 11.0"),
    (inca, "identify", "LOG is missing; write inca identify LOG"),
    (inca, "identify --nope", "LOG is missing; write inca identify LOG"),
    (inca, "compare a.csv b.csv", "b.csv is one argument too many"),
    (inca, "discover a.csv --spread", "--spread has no value; give one behind it"),
    (inca, "crosscheck --step 0.001", "unknown option of inca crosscheck: '--step'; did you mean"),
    (identification, "fit", "ROBOT is missing; write identification fit ROBOT LOG"),
    (identification, "new arm.xml", "LOG is missing; write identification new MODEL LOG"),
    (identification, "find", "unknown command 'find'"),
    (identification, "fit robot.toml a.csv --horizon 1", "unknown option of identification fit:"),
]


@pytest.mark.parametrize(("program", "line", "said"), WRONG, ids=[w[1] or "none" for w in WRONG])
def test_a_wrong_line_is_told_in_one_sentence(capsys, program, line, said):
    assert program(line.split()) == 2
    out, error = capsys.readouterr()
    assert out == ""
    assert error.count("\n") == 1
    assert said in error


def test_of_very_many_names_the_nearest_are_listed():
    names = [f"joint_{k}.damping" for k in range(LISTED)]
    assert str(unknown_name("parameter", "nothing", names)).count("joint_") == LISTED
    many = [*names, "mass"]
    said = str(unknown_name("parameter", "joint_7.damp", many))
    assert "did you mean 'joint_7.damping'? known: " in said
    assert said.endswith(f" and {len(many) - NEAREST} more")
    listed = said.partition("known: ")[2].partition(" and ")[0].split(", ")
    assert len(listed) == NEAREST
    assert listed == sorted(listed)
    assert "joint_7.damping" in listed


@pytest.mark.parametrize(("commands", "written", "read"), [
    (IncaCommand, "identify a.csv --free A --free B", "identify a.csv --free A B"),
    (IncaCommand, "identify a.csv --param m=1 --seed 3 --param=b=2",
     "identify a.csv --param m=1 b=2 --seed 3"),
    (Command, "fit --help", "fit --help"),
])  # fmt: skip
def test_what_is_repeated_adds_up(commands, written, read):
    assert gathered(commands, written.split()) == read.split()
