"""A log is told with its rates, gaps and answers, and a fit runs from the file that is written."""

import re
import tomllib
from dataclasses import replace

import numpy as np
import pytest
from bag_cases import BEGIN, numbers, state, write_bag
from robot_cases import refused, run
from touching_cases import simulated

from identification import InputError, fit, inspect_log, read_robot
from identification.inspection.answers import find_answers
from identification.inspection.beginning import write_beginning
from identification.inspection.guesses import is_time, time_unit, unit_of
from identification.inspection.matching import Channel, match
from identification.inspection.words import answer_sentence, answer_sentences
from identification.logs.headers.column_words import role_of
from identification.storage.files import toml_value

STEP = 0.01


@pytest.mark.parametrize(("name", "role", "unit"), [
    ("joint_states.position.elbow", "output", "rad"), ("joint_states.effort.elbow", "input",
    "N m"), ("action.elbow", "input", ""), ("observation.state.elbow", "output", "rad"),
    ("desired.position.elbow", "input", "rad"), ("i_motor", "input", "A"), ("supply", "", ""),
    ("motorCurrent [mA]", "input", "mA"), ("angle_deg", "output", "deg"),
    ("field.velocity0", "output", "rad/s"), ("tool_force_2", "input", "N"),
])  # fmt: skip
def test_names_tell_roles_and_units(name, role, unit):
    assert role_of(name) == role
    assert unit_of(name, 1.0)[0] == unit


def test_an_angle_of_many_radians_is_rather_one_in_degrees():
    assert unit_of("position.elbow", 20.0)[0] == "rad"
    assert unit_of("position.elbow", 85.0)[0] == "deg"


@pytest.mark.parametrize("rate", [10.0, 30.0, 100.0, 1000.0])
@pytest.mark.parametrize(("unit", "factor"), [("s", 1), ("ms", 1e3), ("us", 1e6), ("ns", 1e9)])
def test_the_unit_of_time_is_that_of_a_rate_of_robots(rate, unit, factor):
    stamps = factor * (7.0 + np.arange(200) / rate)
    assert time_unit(stamps) == unit
    assert is_time("header.stamp", stamps)
    assert not is_time("header.stamp", stamps[::-1])
    assert not is_time("battery", stamps)


def waves(n=3000, seed=0):
    """A smooth random signal and its two integrals, sampled."""
    rng = np.random.default_rng(seed)
    a = np.convolve(rng.standard_normal(n + 60), np.hanning(61) / 30, "valid")
    v = np.cumsum(a) * STEP
    v -= np.linspace(v[0], v[-1], n)
    return a, v


def test_what_answers_what_and_how_late():
    u, other = waves()[0], waves(seed=1)[0]
    inputs = {"u": u, "other": other}
    late = np.roll(u, 7)
    (answer,) = find_answers(STEP, inputs, {"y": late})
    assert (answer.input, answer.of) == ("u", "itself")
    assert answer.lag == pytest.approx(7 * STEP)
    assert answer.gain == pytest.approx(1, abs=0.02)
    assert answer.is_setpoint
    (turned,) = find_answers(STEP, inputs, {"y": -0.1 * late})
    assert turned.correlation < -0.95
    assert not turned.is_setpoint
    assert "with the opposite sign" in answer_sentence(turned)
    (moved,) = find_answers(STEP, inputs, {"y": waves()[1]})
    assert (moved.input, moved.of) == ("u", "rate")
    assert moved.lag <= 2 * STEP
    assert "as it would answer a torque" in answer_sentence(moved)
    (against,) = find_answers(STEP, inputs, {"y": -waves()[1]})
    assert "as it would answer" not in answer_sentence(against)  # a motor's force does not
    assert len(answer_sentences([moved])) == 2  # it is a hint and no proof
    assert find_answers(STEP, inputs, {"y": np.ones(len(u))}) == ()


@pytest.mark.parametrize("seed", range(6))
def test_a_free_cart_that_slow_waves_push_answers_them_with_their_own_sign(seed):
    rng, t = np.random.default_rng(seed), np.arange(4000) * STEP
    ω = 2 * np.pi * rng.uniform(0.2, 0.3, 2)
    force = np.sin(np.outer(t, ω)) @ rng.uniform(0.5, 1, 2)
    moved = -np.sin(np.outer(t, ω)) @ (rng.uniform(0.5, 1, 2) / ω**2)  # its acceleration: waves
    (answer,) = find_answers(STEP, {"force": force}, {"x": moved})
    assert answer.correlation > 0
    assert "opposite" not in answer_sentence(answer)


def test_rates_gaps_ranges_and_words_of_a_csv(tmp_path):
    path = tmp_path / "run.csv"
    rows = [f"{1000 * STEP * k:.0f},{k % 5},{k},on" for k in range(300) if not 100 <= k < 110]
    path.write_text("\n".join(["stamp [ms],u,angle,mode", *rows]) + "\n")
    found = inspect_log(path)
    assert (found.time_column, found.time_unit) == ("stamp [ms]", "ms")
    assert found.step == pytest.approx(STEP)
    assert not found.is_even
    assert found.left_out == ("mode",)
    u, angle = found.columns
    assert (u.role, angle.role, angle.unit) == ("input", "output", "deg")
    assert (angle.least, angle.most, angle.gaps, angle.empty) == (0, 299, 1, 0)
    assert angle.widest == pytest.approx(11 * STEP)
    assert angle.rate == pytest.approx(100)


def test_topics_with_rates_of_their_own(tmp_path):
    q = waves(600)[0]
    topics = {
        "/joint_states": [(BEGIN + 10**7 * k, state(BEGIN + 10**7 * k, ["elbow"], [x]))
                          for k, x in enumerate(q)],
        "/commands": [(BEGIN + 4 * 10**7 * k, numbers([x])) for k, x in enumerate(q[::4])],
    }  # fmt: skip
    found = inspect_log(write_bag(tmp_path / "run", topics))
    rates = {c.name: c.rate for c in found.columns}
    assert rates == pytest.approx({"joint_states.position.elbow": 100, "commands.data_1": 25})
    (answer,) = found.answers
    assert answer.input == "commands.data_1"


ARM = """<mujoco><option timestep="0.002" integrator="implicitfast"/><worldbody>
<body name="upper"><joint name="shoulder" axis="0 1 0" damping="0.2" armature="0.02"/>
  <inertial pos="0 0 -0.1" mass="0.6" diaginertia="0.004 0.004 0.001"/>
  <body name="lower" pos="0 0 -0.25"><joint name="elbow" axis="0 1 0" damping="{damping}"/>
    <inertial pos="0 0 -0.1" mass="0.4" diaginertia="0.004 0.004 0.001"/></body></body>
</worldbody><actuator><position name="shoulder_servo" joint="shoulder" kp="9" kv="0.5"/>
  <position name="elbow_servo" joint="elbow" kp="6" kv="0.5"/></actuator>
<sensor><jointpos name="shoulder_pos" joint="shoulder"/><jointpos name="elbow_pos" joint="elbow"/>
</sensor></mujoco>"""


@pytest.mark.parametrize(("sent", "seen"), [("goal", "present"), ("cmd", "meas"), ("goal", "is")])
def test_columns_are_found_by_names_before_their_order(tmp_path, sent, seen):
    """A setpoint and a position share the name of the joint; other words tell which is which."""
    joints = ("pan", "lift", "elbow")
    inputs = [Channel(j, j, True) for j in joints]
    channels = inputs + [Channel(f"{j}_pos", j, False) for j in joints]
    names = [f"{sent}_{j}" for j in joints] + [f"{seen}_{j}" for j in reversed(joints)]
    data = np.random.default_rng(0).normal(size=(50, 7))
    data[:, 0] = np.arange(50) / 50
    path = tmp_path / "log.csv"
    np.savetxt(path, data, delimiter=",", header=",".join(["time", *names]), comments="")
    found = {m.channel.name: m.column for m in match(channels, inspect_log(path))}
    assert found == {c.name: f"{sent if c.is_input else seen}_{c.joint}" for c in channels}


@pytest.fixture(scope="module")
def arm(tmp_path_factory):
    """The folder of an arm, and the recording of one with more damping of its elbow, in degrees."""
    folder = tmp_path_factory.mktemp("arm")
    (folder / "arm.xml").write_text(ARM.format(damping=0.1))
    log = simulated(ARM.format(damping=0.4), samples=500, noise=1e-4)
    joints = ("elbow", "shoulder")  # in another order than that of the model
    stamps = BEGIN + 10**7 * np.arange(len(log))
    states = [(int(t), state(int(t), joints, np.rad2deg(y[::-1])))
              for t, y in zip(stamps, log.outputs, strict=True)]  # fmt: skip
    sent = [(int(t), state(int(t), joints, np.rad2deg(u[::-1])))
            for t, u in zip(stamps, log.inputs, strict=True)]  # fmt: skip
    write_bag(folder / "run", {"/joint_states": states, "/desired": sent})
    return folder


def test_a_fit_runs_from_the_file_that_is_written(arm, capsys, monkeypatch):
    monkeypatch.chdir(arm)
    begun = run(capsys, "new", "arm.xml", "run")
    assert begun["needs"] == []
    assert begun["robot"] == "robot.toml"
    free = ["joint/shoulder.damping", "joint/elbow.damping", "actuator/shoulder_servo.kp",
            "actuator/elbow_servo.kp"]  # fmt: skip
    assert any(f"free = {toml_value(free)}" in g for g in begun["guessed"])
    assert any("elbow_pos is column joint_states.position.elbow" in g for g in begun["guessed"])
    assert any("answers desired.position.elbow" in f for f in begun["found"])
    record = run(capsys, "inspect", "run", "--out", "out")
    said = {a["output"]: a["input"] for a in record["answers"]}
    assert said["joint_states.position.elbow"] == "desired.position.elbow"
    assert (arm / "out" / "log.png").stat().st_size > 1000
    text = (arm / "robot.toml").read_text()
    content = tomllib.loads(text)
    assert content["columns"] == {
        "shoulder_servo": "desired.position.shoulder", "elbow_servo": "desired.position.elbow",
        "shoulder_pos": "joint_states.position.shoulder",
        "elbow_pos": "joint_states.position.elbow",
    }  # fmt: skip
    assert "a position servo: its input is a setpoint" in text
    assert {*content["log"]["units"].values()} == {"deg"}
    robot = read_robot("robot.toml", "run", trust=["steps"])
    assert fit(robot).values["joint/elbow.damping"] == pytest.approx(0.4, rel=0.05)


def test_no_file_is_replaced(arm, capsys, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "robot.toml").write_text("mine")
    said = refused(capsys, "new", arm / "arm.xml", arm / "run")
    assert "robot.toml exists, and nothing of yours is replaced" in said
    assert (tmp_path / "robot.toml").read_text() == "mine"
    run(capsys, "new", arm / "arm.xml", arm / "run", "--robot", "other.toml")
    assert tomllib.loads((tmp_path / "other.toml").read_text())["outputs"]


def test_a_missing_model_is_told_before_a_file_that_stands_in_the_way(
    arm, capsys, monkeypatch, tmp_path
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "robot.toml").write_text("mine")
    said = refused(capsys, "new", "none.xml", arm / "run")
    assert "no such file: none.xml" in said
    assert "exists" not in said


def test_names_without_a_role_are_told_the_right_way_round():
    """The one that comes late answers, and not the other way round."""
    u, _ = waves()
    late = np.concatenate([np.zeros(8), u[:-8]])
    both = {"motor": u, "shaft": late}
    assert [(a.output, a.input) for a in find_answers(STEP, both, both)] == [("shaft", "motor")]


def test_a_file_that_would_be_read_as_the_log_s_own_is_not_written(tmp_path):
    (tmp_path / "arm.xml").write_text(ARM.format(damping=0.2))
    rows = "\n".join(f"{STEP * k},{k},{k},{k},{k}" for k in range(50))
    (tmp_path / "run.csv").write_text(f"time,m1,m2,a1,a2\n{rows}\n")
    found = inspect_log(tmp_path / "run.csv")
    with pytest.raises(InputError, match="give another name behind --robot"):
        write_beginning(found, tmp_path / "arm.xml", tmp_path / "run.toml")
    assert not (tmp_path / "run.toml").exists()


def test_a_log_of_a_few_rows_is_no_beginning(tmp_path):
    (tmp_path / "arm.xml").write_text(ARM.format(damping=0.2))
    rows = "\n".join(f"{STEP * k},{k},{k},{k},{k}" for k in range(5))
    (tmp_path / "run.csv").write_text(f"time,m1,m2,a1,a2\n{rows}\n")
    begun = write_beginning(inspect_log(tmp_path / "run.csv"), tmp_path / "arm.xml",
                            tmp_path / "robot.toml")  # fmt: skip
    assert any("5 rows: too short" in need for need in begun.needs)


@pytest.mark.parametrize("change", ["nothing", "servos", "slow", "a third joint"])
def test_torques_are_offered_where_forces_and_all_positions_are_logged(arm, tmp_path, change):
    text = ARM.format(damping=0.1)
    if change != "servos":
        text = re.sub(r'<position (name="\w+" joint="\w+")[^>]*/>', r"<motor \1/>", text)
    if change == "a third joint":
        text = text.replace("<worldbody>", '<worldbody><body><joint name="base" axis="1 0 0"/>'
                            '<geom size="0.1" mass="1"/></body>')  # fmt: skip
    (tmp_path / "arm.xml").write_text(text)
    found = inspect_log(arm / "run")
    if change == "slow":
        found = replace(found, time=10 * found.time)
    begun = write_beginning(found, tmp_path / "arm.xml", tmp_path / "robot.toml")
    assert begun.torques == (change == "nothing")


def test_logs_of_which_nothing_can_be_said_are_refused(tmp_path, refusal):
    path = tmp_path / "run.csv"
    path.write_text("volts,angle\n1,2\n2,1\n3,2\n4,2\n")
    assert "no column that looks like time; it has volts, angle" in refusal(inspect_log, path)
    path.with_suffix(".toml").write_text("sampling_time = 0.5\n")
    assert inspect_log(path).step == 0.5
    assert "is a folder; give the path of a log file" in refusal(inspect_log, tmp_path)
    assert "no such file" in refusal(inspect_log, tmp_path / "none.csv")
    (tmp_path / "run.mat").write_bytes(b"")
    with pytest.raises(InputError, match="no names of columns"):
        inspect_log(tmp_path / "run.mat")


def test_a_setpoint_has_the_unit_of_the_position_that_it_commands(tmp_path):
    t = STEP * np.arange(800)
    wanted, moved = (40 * np.sin(2 * x) + 15 * np.sin(5 * x) for x in (t, t - 0.03))
    table = np.column_stack([t, wanted, moved])
    np.savetxt(tmp_path / "run.csv", table, "%.5f", ",", header="time,s1,q1", comments="")
    (tmp_path / "arm.xml").write_text("""<mujoco><worldbody><body><joint name="elbow"/>
        <geom size="0.1" mass="1"/></body></worldbody>
        <actuator><position name="s1" joint="elbow" kp="20" kv="1"/></actuator>
        <sensor><jointpos name="q1" joint="elbow"/></sensor></mujoco>""")
    write_beginning(
        inspect_log(tmp_path / "run.csv"), tmp_path / "arm.xml", tmp_path / "robot.toml"
    )
    content = tomllib.loads((tmp_path / "robot.toml").read_text())
    assert content["log"]["units"] == {"q1": "deg", "s1": "deg"}
