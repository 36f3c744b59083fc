"""Values of a robot's file that leave no mass, or no number, are refused before anything is run."""

import pytest
from joint_cases import SLIDER
from robot_cases import TOML, simulated

from identification import InputError, read_robot
from identification.logs.write import write_log
from identification.sweep.method import reference_of


def files(folder, said):
    (folder / "slider.xml").write_text(SLIDER)
    (folder / "robot.toml").write_text(said)
    write_log(simulated({"damping": 3.0, "mass": 2.0}, 60), folder / "log.csv")
    return folder / "robot.toml", folder / "log.csv"


def test_a_moving_body_without_mass_is_refused(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # where MuJoCo would write a file of warnings
    said = TOML.replace("[parameters.mass]", "[parameters.mass]\nvalue = 0.0")
    assert said != TOML
    with pytest.raises(InputError, match="moves, and its mass is 0 kg; give it a value"):
        read_robot(*files(tmp_path, said))
    assert not (tmp_path / "MUJOCO_LOG.TXT").exists()


@pytest.mark.parametrize("key", ["known", "scale"])
@pytest.mark.parametrize(
    "value",
    [
        "1e-320",
        "1e300",
    ],
)
def test_a_magnitude_whose_square_is_no_number_is_refused(tmp_path, key, value):
    said = TOML.replace("[parameters.mass]", f"[parameters.mass]\n{key} = {value}")
    with pytest.raises(InputError, match=rf"{key} in .* is .*, which no robot has"):
        read_robot(*files(tmp_path, said))


@pytest.mark.parametrize("word", ["a\0b.py:X", 300 * "a" + ".py:X", "loop.py:X", "pipe/a.py:X"])
def test_a_method_in_a_file_of_no_name_is_refused(tmp_path, word):
    (tmp_path / "loop.py").symlink_to(tmp_path / "loop.py")
    with pytest.raises(InputError, match="there is no file"):
        reference_of(word, {}, tmp_path)
