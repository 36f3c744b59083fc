"""Mistakes in a robot's TOML, its model or its log are told in one sentence."""

import re
from dataclasses import replace

import pytest
from joint_cases import SLIDER
from robot_cases import TOML, refused, simulated

from identification import write_log
from identification.effects.axes import Axis
from identification.effects.effect_parameters import effect_parameters
from identification.effects.joint_catalogue import TURNS, joint_effects
from identification.effects.named import unknown_number
from identification.robot.file import read_robot_file
from identification.robot.fit_json import _far
from identification.robot.robot import read_robot_log


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("mass", "weight"), "'weight' is no model path"),
        (("mass", "weight"), "tells of parameter 'mass'"),
        (('["mass", ', "[] # "), "is empty, so that there is nothing to fit; write what is to be"),
        (('["mass", ', '["joint/slide.damping"] # '), "bad.toml tells of parameter 'mass'"),
        (('model = "slider.xml"', ""), "does not say 'model'"),
        (('"slider.xml"', '"none.xml"'), "none.xml"),
        (("joint/slide.damping", "joint/slid.damping"), "did you mean 'slide'"),
        (("joint/slide.damping", "stribeck_friction.f_s@slide"), "give it a value"),
        (("position =", "positon ="), "did you mean 'position'"),
        (('position = "x"', "position = 3"), "columns in"),
        (("[columns]", "[fixed]\n'stribeck_friction.v' = 1.0\n[columns]"), "stribeck_friction.v_s"),
        (("[columns]", "[effects]\nturns = [0]\n[columns]"), "numbers above zero"),
        (("unit =", "units ="), "did you mean 'unit'"),
        (('unit = "kg"', 'unit = "g"'), "in 'kg': multiply them by 0.001 and write unit = 'kg'"),
        (('unit = "kg"', 'unit = "N"'), "has the unit 'N', and its numbers are in 'kg'"),
        (("free", "every = 0\nfree"), "every in"),
        (("free", "horizon = inf\nfree"), "horizon in"),
        (("free", "horizon = 1e308\nfree"), "give one that fits into a log"),
        (("free", "horizon = -1e308\nfree"), "give one that fits into a log"),
        (('"slider.xml"', f'"{900 * "long"}.xml"'), "which is no file; correct it there"),
        (("free", "outputs = ['nothing']\nfree"), "known: position"),
        (
            ("[columns]", "[effects]\nonly = ['stribek_friction']\n[columns]"),
            "did you mean 'stribeck",
        ),
        (("[columns]", "[effects]\njoints = ['arm']\n[columns]"), "known: slide"),
        (("joint/slide.damping", "viscous_friction.d@slide"), "mean 'joint/slide.damping'?"),
        (
            ("[columns]", "[fixed]\n'viscous_friction.d@slide' = 1.0\n[columns]"),
            "is no number of an effect; it is joint/slide.damping in",
        ),
        (("= [", "= {"), "is not TOML"),
        (("free", "trust = ['wirring']\nfree"), "did you mean 'wiring'? known: contacts, gaps"),
        (("[columns]", "[start]\n'qpos[0]' = 0.1\n[columns]"), "under [start] and frees it"),
        (("[columns]", "[start]\n'qpos[7]' = 0.1\n[columns]"), "qpos has 1 entries"),
        (
            ("joint/slide.damping", "coulomb_friction.f_c@slid"),
            "'slid'; did you mean 'slide'? known: slide",
        ),
        (
            ("joint/slide.damping", "coulmb_friction.f_c@slide"),
            "mean 'coulomb_friction.f_c@slide'?",
        ),
        (("joint/slide.damping", "coulomb_friction.f_c"), "did you mean 'coulomb_friction.f_c@sli"),
        (("joint/slide.damping", "delay.tau@forc"), "input in 'delay.tau@forc': 'forc'; did you"),
        (("joint/slide.damping", "stribeck_friction.v_s"), "give its value under [fixed]"),
        (("[columns]", "[fixed]\n'coulomb_friction.f_c@slid' = 1.0\n[columns]"), "known: slide\n"),
        (("[columns]", "[fixed]\n'joint/slide.armature' = 1.0\n[columns]"), "no number of an eff"),
    ],
)
def test_mistakes_are_named(folder, capsys, change, said):
    path = folder / "bad.toml"
    text = TOML.replace(*change, 1)
    assert text != TOML
    path.write_text(text)
    assert said in refused(capsys, "fit", path, folder / "plain.csv")


@pytest.mark.parametrize(
    ("change", "thing"),
    [(('general name="force"', "general"), "actuator"), (('name="position" ', ""), "sensor")],
)
@pytest.mark.parametrize("outputs", ["", "outputs = ['position']\n"])
def test_a_thing_without_a_name_is_told(folder, capsys, change, thing, outputs):
    (folder / "unnamed.xml").write_text(SLIDER.replace(*change, 1))
    path = folder / "unnamed.toml"
    path.write_text(outputs + TOML.replace("slider.xml", "unnamed.xml"))
    said = refused(capsys, "fit", path, folder / "plain.csv")
    assert f"{thing} 0 of {folder / 'unnamed.xml'}, counted from 0, has no name; give it" in said


def test_a_unit_of_what_has_no_known_one_is_of_si(folder, capsys):
    path = folder / "gear.toml"
    text = TOML.replace('"joint/slide.damping"', '"actuator/force.gear[0]"', 1)
    path.write_text(text + "[parameters.'actuator/force.gear[0]']\nunit = 'N/mA'\n")
    assert "multiply its numbers by 1000 and give the SI unit" in refused(
        capsys, "fit", path, folder / "plain.csv"
    )


@pytest.mark.parametrize("log", [".", "/", "", ".."])
def test_a_folder_is_no_log(folder, capsys, log):
    path = folder / "robot.toml"
    path.write_text(TOML)
    assert "is a folder; give the path of a log file" in refused(capsys, "fit", path, log)
    assert "is a folder; give the path of a log file" in refused(
        capsys, "discover", path, folder / "plain.csv", "--confirm", log
    )


@pytest.mark.parametrize(
    ("name", "meant"),
    [("coulomb_friction.f_c@x", "slide_coulomb_friction.f_c@x"),
     ("slide_coulomb_friction.f_c@swing", "coulomb_friction.f_c@swing"),
     ("slide_coulomb_friction@swing", "coulomb_friction.f_c@swing"),
     ("slide_coulomb_friction.f_c@swin", "coulomb_friction.f_c@swing"),
     ("slide_stribeck_friction.v_s@swing", "stribeck_friction.f_s@swing"),
     ("f_c@x", "slide_coulomb_friction.f_c@x"),
     ("f_c@swin", "coulomb_friction.f_c@swing"),
     ("coulomb@x", "slide_coulomb_friction.f_c@x"),
     ("coulomb.f_c@x", "slide_coulomb_friction.f_c@x"),
     ("coulomb_friction@x", "slide_coulomb_friction.f_c@x"),
     ("coulomb_friction.f_c@xx", "slide_coulomb_friction.f_c@x"),
     ("coulomb@swing", "coulomb_friction.f_c@swing"),
     ("friction.f_c@swing", "coulomb_friction.f_c@swing"),
     ("f_c@swing", "coulomb_friction.f_c@swing"),
     ("friction", "coulomb_friction.f_c@swing"),
     ("friction@x", "slide_coulomb_friction.f_c@x"),
     ("stiction", "stribeck_friction.f_s@swing"),
     ("f_c@joint", "coulomb_friction.f_c@swing"),
     ("viscous_friction", "joint/swing.damping"),
     ("viscous_friction.d@x", "joint/x.damping"),
     ("slide_viscous_friction.b@x", "joint/x.damping"),
     ("viscous_damping@swin", "joint/swing.damping"),
     ("coulomb_friction.f_c@swin", "swing")],
)  # fmt: skip
def test_what_is_suggested_can_be_written(name, meant):
    crane = (Axis("swing", "hinge", 1.0, 1.0, 1.0), Axis("x", "slide", 1.0, 1.0, 1.0))
    said = str(unknown_number(name, joint_effects(crane, TURNS)))
    assert f"did you mean {meant!r}?" in said
    listed = said.partition("known: ")[2].partition(" and ")[0].partition(". ")[0].split(", ")
    assert listed == sorted(listed)


@pytest.mark.parametrize(
    ("name", "begin"),
    [("viscous_friction", "'viscous_friction' is no number of an effect: viscous friction is"),
     ("viscous_friction.d@x", "'viscous_friction.d@x' is no number of an effect: viscous"),
     ("stiction", "unknown effect 'stiction'; did you mean"),
     ("stiction@swing", "unknown effect in 'stiction@swing': 'stiction'; did you mean")],
)  # fmt: skip
def test_an_unknown_effect_is_told_once(name, begin):
    crane = (Axis("swing", "hinge", 1.0, 1.0, 1.0), Axis("x", "slide", 1.0, 1.0, 1.0))
    assert str(unknown_number(name, joint_effects(crane, TURNS))).startswith(begin)


def test_what_cannot_be_fitted_is_suggested_under_fixed_alone():
    """A shape, such as the time of a jump, is no size; a user frees sizes."""
    effects = joint_effects((Axis("swing", "hinge", 1.0, 1.0, 1.0, duration=9.0),), TURNS)
    sizes = {p.name for e in effects for p in effect_parameters(e) if "@" in p.name}
    for name in ("friction", "friction_jump", "friction_jump.w@swing", "stribeck", "push"):
        said = str(unknown_number(name, effects))
        assert re.search("did you mean '(.*?)'", said)[1] in sizes, said
    said = str(unknown_number("friction_jump.ww", effects, is_free=False))
    assert "did you mean 'friction_jump.w'?" in said


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


@pytest.mark.parametrize(
    ("confirm", "horizon", "most"),
    [(False, h, 6) for h in (0, -1, 0.02, 6.1)] + [(True, h, 12) for h in (0.02, 12.1)],
)
@pytest.mark.parametrize("command", ["fit", "discover"])
def test_how_long_a_horizon_may_be_is_told(folder, capsys, command, confirm, horizon, most):
    path = folder / "horizon.toml"
    path.write_text(f"horizon = {horizon}\n" + TOML)
    other = ["--confirm", folder / "other.csv"] if confirm else []
    said = refused(capsys, command, path, folder / "plain.csv", *other)
    assert f"horizon in {path} is {horizon} s" in said
    assert f"it may be 0.03 s, of 3 samples, to {most} s, to fit" in said


def test_time_in_milliseconds_is_asked_for_and_converted(folder, capsys):
    log = simulated({})
    write_log(replace(log, time=1e3 * log.time), folder / "slow.csv")
    said = refused(capsys, "fit", folder / "robot.toml", folder / "slow.csv")
    assert "is sampled every 10 s, 5000 steps of" in said
    assert f'in ms? then write time = "ms" under [units] in {folder / "slow.toml"}' in said
    (folder / "slow.toml").write_text('units.time = "ms"')
    read = read_robot_log(read_robot_file(folder / "robot.toml"), folder / "slow.csv")
    assert read.sampling_time == pytest.approx(0.01)


@pytest.mark.parametrize(
    ("change", "line"),
    [(("</body>", ""), "mismatched tag: line 4"),
     (('gear="5"', 'geer="5"'), "'geer' Element 'general', li"),
     (('joint="slide" gear', 'joint="slid" gear'), "target 'slid'")],
)  # fmt: skip
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


@pytest.mark.parametrize("command", ["fit", "discover"])
def test_a_dead_sensor_is_named(folder, capsys, command):
    log = simulated({})
    write_log(replace(log, outputs=0 * log.outputs + 0.3), folder / "dead.csv")
    said = refused(capsys, command, folder / "robot.toml", folder / "dead.csv")
    assert "position of log 'dead' never changes" in said


@pytest.mark.parametrize("command", ["fit", "discover"])
def test_a_huge_number_is_named(folder, capsys, command):
    log = simulated({})
    outputs = log.outputs.copy()
    outputs[7] = 1e200
    write_log(replace(log, outputs=outputs), folder / "huge.csv")
    said = refused(capsys, command, folder / "robot.toml", folder / "huge.csv")
    assert f"of {folder / 'huge.csv'}: x is 1e+200, beyond 1e+15, which no robot has" in said


def test_a_log_with_hardly_more_samples_than_parameters_is_refused(folder, capsys):
    path = folder / "few.toml"
    path.write_text(TOML)
    lines = (folder / "plain.csv").read_text().splitlines()[:8]
    (folder / "short.csv").write_text("\n".join(lines) + "\n")
    assert "record longer" in refused(capsys, "fit", path, folder / "short.csv")


def test_values_that_no_robot_has_are_said_to_be_a_matter_of_units():
    near = {"initial": 0.5, "value": 0.7}
    (millimetres,) = _far({"mass": {"initial": 2.9, "value": 0.0032}})
    assert "units and signs" in millimetres
    assert _far({"mass": near, "x": {"initial": 0.0, "value": 9.0}}) == []
    (said,) = _far({"mass": near, "damping": {"initial": 0.02, "value": 3.4e45}})
    assert said.startswith("damping: more than 100 times")


def test_a_robots_file_that_bears_the_name_of_its_log_is_told_so(folder, capsys):
    path = folder / "plain.toml"
    path.write_text(TOML)
    try:
        said = refused(capsys, "fit", path, folder / "plain.csv")
    finally:
        path.unlink()
    assert "would be read as what its log's own TOML says" in said
