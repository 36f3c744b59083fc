"""Mistakes in a robot's files are told in one sentence, with the good names and the next step."""

import pytest
from numba import njit
from robot_cases import write_slider

from identification import InputError, read_robot
from identification.effects.effect import Effect, places
from identification.effects.sizes import Size
from identification.robot.file.file import read_robot_file
from identification.robot.results.write import write_robot

pytestmark = pytest.mark.usefixtures("few_effects")


def refused(path, log, **more):
    with pytest.raises(InputError) as caught:
        read_robot(path, log, **more)
    said = str(caught.value)
    assert "\n" not in said
    return said


def test_an_unknown_output_is_told_with_the_sensors_and_the_joints(tmp_path):
    path, log = write_slider(tmp_path)
    path.write_text('outputs = ["q2"]\n' + path.read_text().replace("[columns]\nposition", "# "))
    said = refused(path, log)
    assert "unknown sensor under outputs in" in said
    assert "known: position" in said
    assert 'add <jointpos name="q2" joint="JOINT"/>' in said
    assert "with one of its joints: slide" in said


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("horizon = 0.3s", ("line 3, column 14", "reads 'horizon = 0.3s'")),
        ('free = ["a"\nevery = 2', ("line 4, column 1", "reads 'every = 2'")),
    ],
)
def test_bad_toml_is_told_with_its_line_and_what_stands_there(tmp_path, text, words):
    path = tmp_path / "bad.toml"
    path.write_text(f'# mine\nmodel = "a.xml"\n{text}\n')
    with pytest.raises(InputError) as caught:
        read_robot_file(path)
    for word in ("bad.toml is not TOML", *words):
        assert word in str(caught.value)


def test_a_log_of_five_rows_is_refused_as_one(tmp_path):
    path, log = write_slider(tmp_path)
    lines = log.read_text().split("\n")
    log.write_text("\n".join(lines[:6]) + "\n")
    assert "log.csv has 5 rows; one half of a log is fitted" in refused(path, log)


@njit
def pull(s, p):
    """A constant force."""
    return p[0]


OWN = Effect("magnet", "c", (Size("c", "N", 5.0, 1e-2),), places=places("joint", ("slide",)),
             phrase="force: a magnet", hooks={"force": pull})  # fmt: skip


def test_a_result_with_an_own_effect_asks_for_it_again(tmp_path):
    path, log = write_slider(tmp_path)
    robot = read_robot(path, log, own_effects=[OWN])
    size = "magnet.c@slide"
    again = write_robot(robot, {size: 0.7}, tmp_path / "out.toml", tmp_path)
    assert read_robot_file(again).own_effects == ("magnet",)
    assert "# magnet: your own, which read_robot takes as own_effects" in again.read_text()
    said = refused(again, log)
    assert "has values of magnet, which its [effects] own says to be your own" in said
    assert "read_robot(..., own_effects=[...])" in said
    back = read_robot(again, log, own_effects=[OWN])
    assert back.plant.parameters[size].value == 0.7
    # one that was tried and is not in the values is not asked for
    assert not read_robot_file(write_robot(robot, {}, again, tmp_path)).own_effects
