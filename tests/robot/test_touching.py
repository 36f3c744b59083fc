"""Geoms that touch along a log are told, and refused where the log contradicts them."""

import json

import pytest
from touching_cases import (
    BUFFER,
    GRIPPER,
    PEDESTAL,
    PLAIN,
    SHAFT,
    UNTOUCHED,
    WHEEL,
    make_robot,
    simulated,
)

from identification import InputError, read_robot
from identification.__main__ import main
from identification.refusals.touching import FAR_BETTER

HORIZONS = pytest.mark.parametrize("more", ["horizon = 0.3\n", ""], ids=["horizon", "free run"])


# Contacts are judged before any effect is sought.
pytestmark = pytest.mark.usefixtures("few_effects")


def pedestal(**changes):
    return PEDESTAL.format(**{**PLAIN, **changes})


@pytest.fixture(scope="module")
def log():
    return simulated(pedestal(**UNTOUCHED))


@HORIZONS
@pytest.mark.parametrize("xml", [PEDESTAL, SHAFT], ids=["pushed", "rubbed"])
def test_a_base_that_was_fixed_collides_with_its_link_and_is_refused(tmp_path, xml, more):
    log = simulated(xml.format(**{**PLAIN, **UNTOUCHED}))
    path = make_robot(tmp_path, xml.format(**PLAIN), log, "q", more)
    with pytest.raises(InputError) as caught:
        read_robot(path, tmp_path / "log.csv")
    said = str(caught.value)
    assert "geoms of arm and pedestal touch in all states of log 'log' that were" in said
    assert (
        " mm deep, and without this touch the model explains what was measured far better" in said
    )
    assert '<exclude body1="pedestal" body2="arm"/> into <contact> of robot.xml' in said
    assert f'write trust = ["contacts"] into {path}' in said


@pytest.mark.parametrize(
    "cure",
    [{"contact": '<exclude body1="pedestal" body2="arm"/>'}, {"flag": '<flag contact="disable"/>'}],
)
def test_each_line_that_is_told_cures_it(tmp_path, log, cure):
    path = make_robot(tmp_path, pedestal(**cure), log, "q")
    robot = read_robot(path, tmp_path / "log.csv")
    assert not robot.touches
    assert not any("touch" in remark for remark in robot.remarks)


def test_a_user_may_know_better(tmp_path, log):
    path = make_robot(tmp_path, pedestal(), log, "q")
    trust = ["contacts", "wiring", "units"]
    robot = read_robot(path, tmp_path / "log.csv", trust=trust)
    assert "arm and pedestal touch in 100 % of the states" in robot.touches
    assert FAR_BETTER in robot.touches


@HORIZONS
def test_a_wheel_on_the_ground_is_never_refused(tmp_path, more):
    log = simulated(WHEEL.format(**PLAIN))
    path = make_robot(tmp_path, WHEEL.format(**{**PLAIN, **{"mass": 3.0}}), log, "r", more)
    robot = read_robot(path, tmp_path / "log.csv")
    assert "geoms of wheel and the world (plane ground) touch in 100 % of" in robot.touches
    assert "far better" not in robot.touches
    assert robot.touches in robot.remarks


@HORIZONS
@pytest.mark.parametrize(
    ("xml", "joint", "pair"),
    [(BUFFER, "x", "carriage and the world (box buffer)"), (GRIPPER, "q", "right and left")],
)
def test_an_end_stop_and_a_closed_gripper_are_a_remark(tmp_path, more, xml, joint, pair):
    log = simulated(xml.format(**PLAIN))
    path = make_robot(tmp_path, xml.format(**{**PLAIN, "mass": 3.0}), log, joint, more)
    robot = read_robot(path, tmp_path / "log.csv")
    assert f"In the model geoms of {pair} touch in " in robot.touches
    assert "far better" not in robot.touches


def test_a_ground_that_the_log_does_not_have_is_a_remark(tmp_path, capsys):
    """The remark stands in the output, in JSON and in the verdict, and names the line."""
    free = BUFFER.format(**{**PLAIN, **UNTOUCHED})
    path = make_robot(tmp_path, BUFFER.format(**PLAIN), simulated(free), "x")
    assert main(["fit", str(path), str(tmp_path / "log.csv"), "--json"]) == 0
    shown = capsys.readouterr()
    record = json.loads(shown.out)
    (said,) = (s for s in record["verdict"] if "touch" in s)
    assert f" deep, {FAR_BETTER}. If this touch is not meant, write <exclude" in said
    assert 'write <exclude body1="world" body2="carriage"/> into <contact> of robot.xml' in said
    assert said in record["remarks"]
    assert said in shown.err


def test_what_lies_beside_the_robot_is_not_told(tmp_path):
    cube = """<geom type="plane" pos="0 0 -2" size="9 9 1"/>
    <body name="cube" pos="3 3 -1.9"><freejoint/><geom type="box" size="0.1 0.1 0.1"/></body>"""
    xml = GRIPPER.format(**PLAIN).replace("<worldbody>", f"<worldbody>{cube}")
    path = make_robot(tmp_path, xml, simulated(xml), "q")
    assert "cube" not in read_robot(path, tmp_path / "log.csv").touches
