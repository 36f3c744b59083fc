"""Mistakes in a robot's TOML, its model or its log are told in one sentence."""

from dataclasses import replace

import pytest
from joint_cases import SLIDER
from robot_cases import TOML, refused, simulated

from identification import write_log
from identification.robot.file.file import read_robot_file
from identification.robot.robot import read_robot_log


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("mass", "weight"), "'weight' is no model path"),
        (('"slider.xml"', '"none.xml"'), "none.xml"),
        (("position =", "positon ="), "did you mean 'position'"),
        (("[columns]", "[effects]\nturns = [0]\n[columns]"), "numbers above zero"),
        (('unit = "kg"', 'unit = "N"'), "has the unit 'N', and its numbers are in 'kg'"),
        (("free", "horizon = inf\nfree"), "horizon in"),
        (
            ("[columns]", "[effects]\nonly = ['stribek_friction']\n[columns]"),
            "did you mean 'stribeck",
        ),
        (("= [", "= {"), "is not TOML"),
    ],
)
def test_mistakes_are_named(folder, capsys, change, said):
    path = folder / "bad.toml"
    text = TOML.replace(*change, 1)
    assert text != TOML
    path.write_text(text)
    assert said in refused(capsys, "fit", path, folder / "plain.csv")


@pytest.mark.parametrize("name", ["motor3", "position"])
def test_a_column_that_is_used_twice_is_told_with_its_users(folder, capsys, name):
    path = folder / "twice.toml"
    lines = {"position": "x", "force": "u", name: "u"}
    columns = "\n".join(f'{n} = "{column}"' for n, column in lines.items())
    path.write_text(TOML.replace('position = "x"', columns))
    said = refused(capsys, "fit", path, folder / "plain.csv")
    users = [n for n, column in lines.items() if column == "u"]
    assert f"column 'u' is that of {' and '.join(users)}" in said
    assert ("unknown actuator or sensor" in said) == (name == "motor3")


@pytest.mark.parametrize("log", [".", ""])
def test_a_folder_is_no_log(folder, capsys, log):
    path = folder / "robot.toml"
    path.write_text(TOML)
    assert "is a folder; give the path of a log file" in refused(capsys, "fit", path, log)
    assert "is a folder; give the path of a log file" in refused(
        capsys, "discover", path, folder / "plain.csv", "--confirm", log
    )


def test_how_much_a_log_may_be_thinned_is_told(folder, capsys):
    path = folder / "every.toml"
    path.write_text("every = 240\n" + TOML)
    said = refused(capsys, "fit", path, folder / "plain.csv")
    assert f"every in {path} is 240" in said
    assert said.endswith("it may be 239 at most\n")
    path.write_text("every = 239\n" + TOML)
    assert len(read_robot_log(read_robot_file(path), folder / "plain.csv")) == 6
    (folder / "lines.toml").write_text('hold = "foh"')
    (folder / "lines.csv").write_text((folder / "plain.csv").read_text())
    assert len(read_robot_log(read_robot_file(path), folder / "lines.csv")) == 6


@pytest.mark.parametrize(("confirm", "horizon", "most"), [(False, -1, 6), (True, 12.1, 12)])
def test_how_long_a_horizon_may_be_is_told(folder, capsys, confirm, horizon, most):
    path = folder / "horizon.toml"
    path.write_text(f"horizon = {horizon}\n" + TOML)
    other = ["--confirm", folder / "other.csv"] if confirm else []
    said = refused(capsys, "fit", path, folder / "plain.csv", *other)
    assert f"horizon in {path} is {horizon} s" in said
    assert f"write one from 0.03 s (3 samples) to {most} s" in said


@pytest.mark.parametrize(("change", "line"), [
    (("</body>", ""), "mismatched tag: line 4"),
    (('gear="5"', 'geer="5"'), "'geer' Element 'general', li"),
])  # fmt: skip
def test_a_model_that_is_broken_is_told_with_its_path_and_line(folder, capsys, change, line):
    (folder / "broken.xml").write_text(SLIDER.replace(*change, 1))
    path = folder / "broken.toml"
    path.write_text(TOML.replace("slider.xml", "broken.xml"))
    said = refused(capsys, "fit", path, folder / "plain.csv")
    assert f"the model {folder / 'broken.xml'} cannot be read (" in said
    assert line in said
    assert said.endswith("correct it there\n")


def test_a_column_that_the_log_lacks_is_a_matter_of_the_file_that_names_it(folder, capsys):
    path = folder / "column.toml"
    path.write_text(TOML.replace('position = "x"', 'position = "y"'))
    said = refused(capsys, "fit", path, folder / "plain.csv")
    assert "lacks column y" in said
    assert "column.toml" in said
    assert "plain.toml" not in said


def test_a_dead_sensor_is_named(folder, capsys):
    log = simulated({})
    write_log(replace(log, outputs=0 * log.outputs + 0.3), folder / "dead.csv")
    said = refused(capsys, "fit", folder / "robot.toml", folder / "dead.csv")
    assert "position of log 'dead' never changes" in said


def test_a_log_with_hardly_more_samples_than_parameters_is_refused(folder, capsys):
    path = folder / "few.toml"
    path.write_text(TOML)
    lines = (folder / "plain.csv").read_text().splitlines()[:8]
    (folder / "short.csv").write_text("\n".join(lines) + "\n")
    assert "record longer" in refused(capsys, "fit", path, folder / "short.csv")


def test_a_robots_file_that_bears_the_name_of_its_log_is_told_so(folder, capsys):
    path = folder / "plain.toml"
    path.write_text(TOML)
    try:
        said = refused(capsys, "fit", path, folder / "plain.csv")
    finally:
        path.unlink()
    assert "would be read as what its log's own TOML says" in said
