"""Torques of an arm in closed loop: a hidden load is found; where nothing is missing, nothing."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest
from torque_cases import TOML, planar, planar_record, planar_robot

from identification import fit_torques
from identification.__main__ import main
from identification.logs.formats.csv_files import write_log
from identification.report.torques.report import torque_headline
from identification.report.torques.tables import centre_words
from identification.robot.torques import free_numbers
from identification.torques.equations.others import Others

LOAD = 0.7


@pytest.fixture(scope="module")
def loaded(tmp_path_factory):
    folder = tmp_path_factory.mktemp("loaded")
    records = [planar_record(k, LOAD, name=f"r{k}") for k in (11, 12)]
    return fit_torques(planar_robot(folder, records[0], confirm=[records[1]]))


def test_a_hidden_load_is_found_first_and_weighed(loaded):
    first = loaded.named[0]
    assert first.missing.title == "payload, body fore"
    assert first.size[0] == pytest.approx(LOAD, rel=0.03)
    assert abs(first.size[0] - LOAD) < 4 * first.std[0]
    assert first.fall > 0.9
    assert "payload, body fore: M = " in repr(loaded)


def test_a_load_at_any_place_is_told_with_its_centre_of_mass(loaded):
    load = next(s for s in loaded.found.scores if s.missing.title == "load, body fore")
    size = dict(zip(load.missing.sizes, load.size, strict=True))
    assert size["h_z"] / size["m"] == pytest.approx(0.5, abs=0.05)
    sure = replace(load, std=0.01 * np.abs(load.size))
    words = centre_words(sure)
    assert words.endswith("in the frame of body fore.")
    z = float(re.search(r"z = ([\d.]+) ± [\d.]+ m in", words)[1])
    assert z == pytest.approx(size["h_z"] / size["m"], abs=0.006)
    assert centre_words(replace(load, std=np.abs(load.size))) == ""  # m is not sure
    assert centre_words(loaded.named[0]) == ""  # a payload has its place by its name


def test_frictions_and_base_parameters_are_those_of_the_truth(loaded):
    truth = {
        "h_z of upper + 0.5 m of fore": 2.0 + 0.5 * LOAD,
        "h_z of fore": 0.4 + 0.5 * LOAD,
        "I_yy of fore": 0.11 + 0.25 * LOAD,
        "armature of elbow": 0.3,
        "viscous of elbow": 2.0,
        "coulomb of shoulder": 1.0,
    }
    for name, value in truth.items():
        assert loaded.values[name] == pytest.approx(value, rel=0.05)
        assert abs(loaded.values[name] - value) < 5 * loaded.std[name]


def test_where_nothing_is_missing_nothing_is_named(tmp_path):
    robot = planar_robot(tmp_path, planar_record(21), planar_record(22, name="other"))
    found = fit_torques(robot)
    assert found.named == ()
    assert "the torques prove no effect" in found.to_dict()["verdict"][0]


def test_a_friction_that_the_model_lacks_is_told(tmp_path):
    """The first sentence said that nothing is proven, and a later one told two frictions."""
    robot = planar_robot(tmp_path, planar_record(61, f=1.6))
    found = fit_torques(robot)
    first, *rest = found.to_dict()["verdict"]
    (said,) = [s for s in rest if "differ from the model" in s]
    assert first.startswith(
        "Apart from frictions that differ from the model (coulomb of shoulder and coulomb of"
        " elbow), told below, the torques prove no effect. "
    )
    (answer,) = torque_headline(found.found, robot.plant.model).answers
    assert answer.name == "No effect is proven"
    assert answer.place.startswith("apart from frictions that differ from the model: coulomb of s")
    assert answer.place.endswith("(model 1 N m)")
    assert "coulomb of shoulder" in said
    assert "coulomb of elbow" in said
    assert "(model 1 N m)" in said
    assert found.values["coulomb of elbow"] == pytest.approx(1.6, rel=0.02)


def test_frictions_are_told_beside_the_drag_that_was_found(tmp_path):
    """Without it a drag is a larger viscous friction and a negative level."""
    records = [planar_record(k, name=f"r{k}", force=lambda q, v: -3.0 * v[1] * abs(v[1]))
               for k in (81, 82)]  # fmt: skip
    found = fit_torques(planar_robot(tmp_path, records[0], confirm=[records[1]]))
    assert found.named[0].missing.key == ("quadratic_friction", "joint elbow")
    assert not [s for s in found.to_dict()["verdict"] if "differ from the model" in s]


def test_a_load_of_one_record_is_told_without_any_prior(tmp_path):
    records = planar_record(41, name="empty"), planar_record(42, LOAD, name="carrying")
    toml = 'model = "arm.xml"\nfree = ["body/fore.mass"]\nhorizon = 0.2\n'
    found = fit_torques(planar_robot(tmp_path, *records, toml=toml)).found.differences[0]
    assert found.is_proven
    assert found.missing.where == "body fore in carrying"
    assert found.missing.sizes == ("m", "h_x", "h_z", "I_yy")  # the joints feel no other number
    truth = np.array([LOAD, 0.0, 0.5 * LOAD, 0.25 * LOAD])
    np.testing.assert_allclose(found.size, truth, atol=0.07 * LOAD)


def test_torques_need_no_free_value_and_a_fit_does(tmp_path, capsys):
    (tmp_path / "arm.xml").write_text(planar())
    (tmp_path / "arm.toml").write_text('model = "arm.xml"\nfree = []\ntrust = ["units", "steps"]\n')
    write_log(planar_record(11, LOAD), tmp_path / "log.csv")
    arguments = [str(tmp_path / "arm.toml"), str(tmp_path / "log.csv"), "--quiet"]
    assert main(["torques", *arguments]) == 0
    assert capsys.readouterr().out.startswith("The torques need payload, body fore")
    for command in ("fit", "discover"):
        assert main([command, *arguments]) == 2
        assert "is empty, so that there is nothing to fit" in capsys.readouterr().err


def test_the_command_tells_and_keeps_what_python_does(tmp_path, capsys):
    (tmp_path / "arm.xml").write_text(planar())
    (tmp_path / "arm.toml").write_text(
        'model = "arm.xml"\nfree = ["body/fore.mass"]\ntrust = ["units", "steps"]\n'
    )
    write_log(planar_record(11, LOAD), tmp_path / "log.csv")
    out = tmp_path / "out"
    arguments = ["torques", str(tmp_path / "arm.toml"), str(tmp_path / "log.csv")]
    assert main([*arguments, "--out", str(out), "--quiet"]) == 0
    said = capsys.readouterr().out
    assert said.startswith("The torques need payload, body fore")
    record = json.loads((out / "result.json").read_text())
    assert record["named"][0]["name"] == "payload"
    assert record["joints"]["elbow"]["unit"] == "N m"
    model = {n: v["model"] for n, v in record["base_parameters"].items() if "model" in v}
    assert model["h_z of fore"] == pytest.approx(0.4)
    page = (out / "report.html").read_text()
    assert "The torques need" in page
    assert ">Payload<" in page
    assert len(page) > 10_000
    assert len([*out.glob("torques-*.png")]) == 1
    assert np.isfinite([j["final"]["unseen"] for j in record["joints"].values()]).all()


def test_a_load_that_free_masses_hide_is_judged_with_them_at_what_was_known(tmp_path):
    names = ("body/upper.mass", "body/fore.mass", "joint/shoulder.armature", "joint/elbow.armature")
    toml = f"model = 'arm.xml'\nfree = {[*names]}\nhorizon = 0.2\n"
    toml += "".join(f'[parameters."{n}"]\nknown = 0.05\n' for n in names)
    records = [planar_record(k, LOAD, name=f"r{k}", noise=2e-4) for k in (51, 52)]
    found = fit_torques(planar_robot(tmp_path, records[0], toml=toml, confirm=[records[1]])).found
    assert np.abs(found.model.base.far).max() > 3.0
    assert found.named[0].missing.title == "payload, body fore"
    assert found.found[0].held_t > max(3.0, found.found[0].t)
    assert abs(found.named[0].size[0] - LOAD) < 4 * found.named[0].std[0]


SPRING = (
    TOML.replace('["joint/', '["joint/elbow.stiffness", "joint/', 1)
    + """
[parameters."joint/elbow.stiffness"]
known = 0.5
"""
)


@pytest.mark.parametrize("toml", [TOML, SPRING])
def test_a_free_spring_is_fitted_and_a_held_one_is_named(toml, tmp_path):
    """The model has 20 N m/rad, the arm 26: what is free is no effect that is missing."""
    robot = planar_robot(tmp_path, planar_record(71, k=26.0), toml=toml, k=20.0)
    found = fit_torques(robot)
    if toml == TOML:
        assert "stiffness, joint elbow" in {s.missing.title for s in found.named}
    else:
        assert found.named == ()
        assert found.values["joint/elbow.stiffness"] == pytest.approx(26.0, rel=0.02)


def test_a_free_friction_is_no_number_of_the_model_beside_the_friction_of_every_fit(tmp_path):
    free = TOML.replace(
        "free = [", 'free = ["coulomb_friction.f_c@elbow", "joint/elbow.damping", ', 1
    )
    free += '[parameters."coulomb_friction.f_c@elbow"]\nvalue = 0.5\n'
    robot = planar_robot(tmp_path, planar_record(71), toml=free)
    found = free_numbers(robot, [robot.log])
    assert [f.name for f in found] == ["joint/elbow.armature", "body/fore.mass"]


def test_the_column_of_a_free_spring_is_the_position(tmp_path):
    found = fit_torques(planar_robot(tmp_path, planar_record(71, k=26.0), toml=SPRING, k=20.0))
    equations, (number,) = found.found.equations, [
        f for f in free_numbers(found.robot, [found.robot.log]) if f.moved is not None
    ]  # fmt: skip
    others = Others.of([number], equations, [found.robot.log])
    q = equations.stacked("q")
    np.testing.assert_allclose(others.columns[:, 1, 0], q[:, 1], atol=1e-6)
    np.testing.assert_allclose(others.columns[:, 0, 0], 0.0, atol=1e-6)
