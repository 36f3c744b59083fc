"""A robot told in TOML: the same fit and discovery as by hand."""

import json

import pytest
from robot_cases import NAMES, TOML, refused, run

from identification import InputError, discover, read_log, read_robot
from identification.__main__ import main
from identification.commands.common import Output
from identification.robot.file.file import read_robot_file
from identification.robot.results.write import write_robot
from identification.robot.robot import read_robot_log, robot_of


def test_what_the_file_leaves_out_comes_from_the_model_and_the_log(folder):
    file = read_robot_file(folder / "robot.toml")
    log = read_robot_log(file, str(folder / "other.csv"))
    robot = robot_of(file, log)
    at = robot.plant.parameters
    assert log.output_names == ("position",)
    assert log.units["position"] == "m"
    assert at["joint/slide.damping"].value == 3.0
    assert at["joint/slide.damping"].lower == 0.0
    assert at["mass"].value == 2.0
    assert at["qpos[0]"].value == log.outputs[0, 0]
    units = [at[n].unit for n in NAMES]
    assert units == ["kg", "N s/m", "m", "m/s"]
    assert robot.starts == ("qpos[0]", "qvel[0]")
    assert robot.nominal_model.names == NAMES
    assert {"stribeck_friction", "delay"} <= {e.name for e in robot.candidates}


def test_a_fit_recovers_the_truth_and_confirms_it_elsewhere(folder, tmp_path, capsys):
    path, out = folder / "robot.toml", tmp_path / "out"
    found = run(capsys, "fit", path, folder / "plain.csv", "--confirm", folder / "other.csv",
                "--out", out)  # fmt: skip
    for name, true in (("mass", 1.8), ("joint/slide.damping", 3.6)):
        p = found["parameters"][name]
        assert abs(p["value"] - true) < 4 * p["std"]
        assert p["value"] == pytest.approx(true, rel=0.02)
    assert found["confirm"][0]["after"] == pytest.approx(5e-4, rel=0.15)
    assert found["confirm"][0]["before"] > 2 * found["confirm"][0]["after"]
    assert json.loads((out / "result.json").read_text())["parameters"] == found["parameters"]


def test_a_discovery_names_what_is_hidden_and_writes_a_report(folder, tmp_path, capsys):
    out = tmp_path / "out"
    only = folder / "only.toml"
    only.write_text(
        TOML + '[effects]\nonly = ["asymmetric_viscous_friction", "stribeck_friction", "cogging"]\n'
    )
    found = run(capsys, "discover", only, folder / "hidden.csv", "--out", out)
    assert found["verdict"] == "named"
    (effect,) = found["effects"]
    assert effect["name"] == "asymmetric_viscous_friction"
    assert effect["parameters"]["d_a"]["value"] == pytest.approx(0.9, rel=0.1)
    assert "Missing from the model" in (out / "report.html").read_text()
    again = read_robot_file(out / "robot.toml")
    robot = robot_of(again, read_robot_log(again, str(folder / "hidden.csv")))
    name = "asymmetric_viscous_friction.d_a@slide"
    assert again.free == (*NAMES, name)
    assert robot.plant.parameters[name].value == effect["parameters"]["d_a"]["value"]
    assert robot.plant.parameters["mass"].value == pytest.approx(1.8, rel=0.02)


def test_options_of_a_file_decide(folder, tmp_path, capsys):
    path, options = folder / "one.toml", tmp_path / "options.toml"
    path.write_text(TOML + '[effects]\nonly = ["asymmetric_viscous_friction"]\n')
    options.write_text("min_proof_t = 1e9\n")
    call = [
        "discover",
        path,
        folder / "hidden.csv",
        "--out",
        tmp_path / "out",
        "--options",
        options,
    ]
    found = run(capsys, *call)
    assert found["verdict"] == "unknown effect"
    head = (tmp_path / "out" / "model.xml").read_text().partition("-->")[0]
    assert "missing from this model, and bends the values" in head
    assert found["options"]["min_proof_t"] == 1e9
    assert [r["doubt"] for r in found["rejected"]] == ["chance"]
    options.write_text("min_prof_t = 2.0\n")
    said = refused(capsys, "discover", path, folder / "hidden.csv", "--options", options)
    assert "did you mean 'min_proof_t'" in said


def test_a_robot_with_an_effect_reads_back_to_the_bit(folder, tmp_path):
    file = read_robot_file(folder / "robot.toml")
    robot = robot_of(file, read_robot_log(file, str(folder / "hidden.csv")))
    values = {"mass": 1.8123456789012345, "stribeck_friction.f_s@slide": 0.1 / 3,
              "stribeck_friction.v_s": 0.07 / 3}  # fmt: skip
    again = read_robot_file(write_robot(robot, values, tmp_path / "r.toml", tmp_path))
    back = robot_of(again, robot.log).plant.parameters
    assert {n: back[n].value for n in values} == values
    assert again.fixed == {"stribeck_friction.v_s": 0.07 / 3}
    assert again.records["mass"]["path"] == "body/cart.mass"


def test_what_an_input_did_before_one_log_is_kept_for_no_other(folder, tmp_path):
    file = read_robot_file(folder / "robot.toml")
    robot = robot_of(file, read_robot_log(file, str(folder / "hidden.csv")))
    (name,) = (p.name for p in robot.plant.parameters if p.name.endswith("delay.before"))
    values = {"mass": 1.8, "delay.tau@force": 0.01, name: 0.7}
    again = read_robot_file(write_robot(robot, values, tmp_path / "late.toml", tmp_path))
    back = robot_of(again, robot.log).plant.parameters
    assert back["delay.tau@force"].value == 0.01
    assert back[name].value == 0.0
    assert not again.fixed


def test_a_fit_that_is_stopped_keeps_its_best_values_and_says_so(folder, tmp_path, monkeypatch):
    def interrupt(output, line):
        raise KeyboardInterrupt

    monkeypatch.setattr(Output, "tell", interrupt)
    out = tmp_path / "out"
    given = ["fit", str(folder / "robot.toml"), str(folder / "plain.csv"), "--out", str(out)]
    assert main(given) == 130
    result = json.loads((out / "result.json").read_text())
    assert result["status"] == "stopped"
    assert {known["std"] for known in result["parameters"].values()} == {None}
    assert "The search was stopped" in (out / "robot.toml").read_text().splitlines()[0]


NAMES_VERBS = ("force",), ("x",)


def test_a_log_that_is_read_already_is_the_same_robot(folder):
    path = folder / "robot.toml"
    from_file = read_robot(path, folder / "plain.csv")
    again = read_robot(path, from_file.log, confirm=[from_file.log])
    assert again.plant.parameters == from_file.plant.parameters
    assert again.records == (from_file.log,)
    with pytest.raises(InputError, match="'x'"):  # the file's name of the column, not the sensor's
        read_robot(path, read_log(folder / "plain.csv", *NAMES_VERBS))


def test_a_robot_has_its_log_and_a_nominal_model_needs_one(folder):
    robot = read_robot(folder / "robot.toml", folder / "plain.csv")
    with pytest.raises(InputError, match="leave log and effects out"):
        discover(robot, robot.log, robot.candidates)
    with pytest.raises(InputError, match="needs a log and candidate effects"):
        discover(robot.nominal_model)
