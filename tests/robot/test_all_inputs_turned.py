"""All inputs turned at once are told, with what to write; no right log is refused for them."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from advice import advised
from plain_logs import plain_log
from tracked_cases import ARM, MOTION, payload, refused, robot, tracked

from identification import InputError
from identification.logs.units import UNITS
from identification.refusals.balance import unbalanced_share
from identification.refusals.forces import tendon_forces
from identification.refusals.wiring import refuse_miswired
from identification.robot.robot import read_robot_log

pytestmark = pytest.mark.usefixtures("few_effects")

HEAD = '<mujoco><compiler autolimits="true"/><option timestep="0.0025" integrator="RK4"{}/>'
WINCHES = (
    HEAD.format("")
    + """<worldbody><site name="p1" pos="-1.2 0 2.5"/><site name="p2" pos="1 0 2.3"/>
<body name="load" pos="0 0 1"><joint name="x" type="slide" axis="1 0 0" damping="0.5"/>
<joint name="z" type="slide" axis="0 0 1" damping="0.5"/>
<inertial pos="0 0 0" mass="7" diaginertia="0.01 0.01 0.01"/>
<site name="a1" pos="-0.1 0 0.05"/><site name="a2" pos="0.1 0 0.05"/></body></worldbody>
<tendon><spatial name="c1" damping="3"><site site="p1"/><site site="a1"/></spatial>
<spatial name="c2" damping="3"><site site="p2"/><site site="a2"/></spatial></tendon>
<actuator><motor name="T1" tendon="c1" gear="{0}" ctrlrange="{2}"/>
<motor name="T2" tendon="c2" gear="{1}" ctrlrange="{2}"/></actuator>
<sensor><jointpos name="x" joint="x"/><jointpos name="z" joint="z"/></sensor></mujoco>"""
)
WEIGHTLESS = (
    HEAD.format(' gravity="0 0 0"')
    + """<worldbody><body><joint name="q1" axis="0 0 1" damping="0.3"/>
<inertial pos="0.2 0 0" mass="2" diaginertia="0.03 0.03 0.03"/>
<body pos="0.4 0 0"><joint name="q2" axis="0 0 1" damping="0.1"/>
<inertial pos="0.15 0 0" mass="1" diaginertia="0.01 0.01 0.01"/></body></body></worldbody>
<actuator><motor name="u1" joint="q1"/><motor name="u2" joint="q2"/></actuator>
<sensor><jointpos name="q1" joint="q1"/><jointpos name="q2" joint="q2"/></sensor></mujoco>"""
)
MOTION = {**MOTION, WEIGHTLESS: ((0.6, 0.4, 0.0), (0.9, 0.7, 0.0))}


def winches(first=-1.0, second=-1.0, span="0 400"):
    return WINCHES.format(f"{first:g}", f"{second:g}", span)


def hung(mass, speed=1.0, gears=(1.0, 1.0), samples=500, seed=2):
    """A log of a load that two cables hold and move, with their tensions [N] over the gears."""
    model = mujoco.MjModel.from_xml_string(winches())
    model.body_mass[1] = mass
    data = mujoco.MjData(model)
    mujoco.mj_setConst(model, data)
    mujoco.mj_forward(model, data)
    u, y, hold = np.zeros((samples, 2)), np.zeros((samples, 2)), np.zeros(2)
    a, w = np.array([0.25, 0.2]), 2 * np.pi * speed * np.array([0.4, 0.55])
    for k in range(samples):
        t = 0.01 * k
        y[k] = data.qpos
        off, rate = a * np.sin(w * t) - data.qpos, a * w * np.cos(w * t) - data.qvel
        hold += 0.6 * mass * off
        force = mass * (60 * off + 12 * rate) + hold + [0, mass * 9.81]
        ways = [(data.site(f"a{i}").xpos - data.site(f"p{i}").xpos)[[0, 2]] for i in (1, 2)]
        J = np.array([way / np.linalg.norm(way) for way in ways])
        u[k] = data.ctrl[:] = np.clip(np.linalg.solve(-J.T, force), 1, 400)
        mujoco.mj_step(model, data, 4)
    y += 3e-4 * np.random.default_rng(seed).standard_normal(y.shape)
    return plain_log(u / gears, y, "T1 T2", "x z")


def test_winches_that_push_are_refused_whatever_hangs_from_them(tmp_path):
    said = refused(*robot(tmp_path, winches(1, 2.5), hung(5.0, gears=(1, 2.5)), "horizon = 0.3"))
    assert "with the other sign of all inputs" in said
    assert 'write gear="-1" for T1, gear="-2.5" for T2 into' in said
    assert "pushes its ends apart where it is positive" in said
    assert "[factors]" not in said  # the range of the motors would cut such inputs to zero
    assert 'or write trust = ["wiring"] into' in said


def test_where_ranges_allow_it_the_log_may_be_turned_and_that_mends_it(tmp_path):
    own, log = robot(tmp_path, winches(1, 1, "-400 400"), hung(9.0), "horizon = 0.3")
    said = refused(own, log)
    assert 'write gear="-1" for T1, T2 into' in said
    assert "write T1 = -1 and T2 = -1 (a line each) under [factors] of the log's TOML" in said
    (tmp_path / "log.toml").write_text("[factors]\nT1 = -1\nT2 = -1\n")
    refuse_miswired(own, read_robot_log(own.file, tmp_path / "log.csv"))
    refuse_miswired(replace(own, file=replace(own.file, trust=("wiring",))), log)


def test_winches_that_pull_are_not_refused_whatever_hangs_from_them(tmp_path):
    refuse_miswired(*robot(tmp_path, winches(), hung(12.0, 1.0), "horizon = 0.3"))


def test_all_outputs_turned_are_told_and_not_taken_for_inputs_where_gravity_tells(tmp_path):
    tilted = ARM.replace("<option timestep", '<option gravity="4 0 -8.9" timestep')
    log = tracked(mujoco.MjModel.from_xml_string(tilted), MOTION[ARM])
    said = refused(*robot(tmp_path, tilted, replace(log, outputs=-log.outputs), "horizon = 0.2"))
    assert "turn the sign of q1, q2: write q1 = -1 and q2 = -1 (a line each)" in said
    assert "or of" not in said


def test_without_gravity_both_are_told_because_none_can_tell_them_apart(tmp_path):
    log = tracked(mujoco.MjModel.from_xml_string(WEIGHTLESS), MOTION[WEIGHTLESS])
    refuse_miswired(*robot(tmp_path, WEIGHTLESS, log, "horizon = 0.2"))
    wrong = replace(log, outputs=-log.outputs)
    said = refused(*robot(tmp_path, WEIGHTLESS, wrong, "horizon = 0.2"))
    assert "turn the sign of q1, q2, or of u1, u2" in said
    both = replace(log, inputs=-log.inputs, outputs=-log.outputs)
    refuse_miswired(*robot(tmp_path, WEIGHTLESS, both, "horizon = 0.2"))


def test_the_balance_of_a_robot_with_tendons_holds_for_its_own_motion():
    """η vanishes for a log of the model itself, and not for inputs with the other sign."""
    log, model = hung(7.0), mujoco.MjModel.from_xml_string(winches(span="-400 400"))
    assert unbalanced_share(model, log).max() < 0.02
    assert unbalanced_share(model, replace(log, inputs=-log.inputs)).min() > 0.5


def test_forces_of_tendons_are_those_of_the_engine():
    xml = winches().replace('damping="3"', 'damping="3" stiffness="20" springlength="1.5"')
    model = mujoco.MjModel.from_xml_string(xml)
    rng, data = np.random.default_rng(0), mujoco.MjData(model)
    q, v = 0.2 * rng.standard_normal((5, 2)), rng.standard_normal((5, 2))
    resisting, springs = tendon_forces(model, q, v)
    assert len(resisting) == 4
    for k in range(5):
        data.qpos, data.qvel = q[k], v[k]
        mujoco.mj_forward(model, data)
        damped = 3 * (resisting[0][k] + resisting[2][k]) + 0.5 * v[k]  # of tendons and of joints
        np.testing.assert_allclose(damped, -data.qfrc_damper, atol=1e-9)
        np.testing.assert_allclose(springs[0][k] + springs[1][k], -data.qfrc_spring, atol=1e-9)


HORIZON = "horizon = 0.2"
CASES = [
    (ARM, [-1, 1], "deg", ""),
    (ARM, [1, -1], "rev", HORIZON),
]


def mistaken(xml, word, signs):
    """A log of a robot that is written in another unit and with other signs."""
    log = tracked(mujoco.MjModel.from_xml_string(xml), MOTION[xml])
    return replace(log, outputs=log.outputs * signs / UNITS[word][1])


@pytest.mark.parametrize(("xml", "signs", "word", "horizon"), CASES)
def test_both_are_told_and_what_is_told_mends_the_log(tmp_path, xml, signs, word, horizon):
    own, read = robot(tmp_path, xml, mistaken(xml, word, signs), horizon)
    said = refused(own, read)
    assert f"were it in {word} and with the other sign" in said
    assert f'write trust = ["units", "wiring"] into {own.file.path}' in said
    (tmp_path / "log.toml").write_text(advised(said))
    mended = read_robot_log(own.file, tmp_path / "log.csv")
    np.testing.assert_allclose(
        mended.outputs, read.outputs * signs * UNITS[word][1], rtol=1e-12, atol=0
    )
    refuse_miswired(own, mended)


def test_what_a_model_lacks_is_no_unit_and_no_sign(tmp_path):
    """Forces decide: where a payload or gravity explains them, no two mistakes are looked for."""
    truth = mujoco.MjModel.from_xml_string(ARM)
    payload(truth)
    refuse_miswired(*robot(tmp_path, ARM, tracked(truth, MOTION[ARM], seed=3), HORIZON))


def exchanged(log, of, signs, turned):
    """A log with two columns exchanged, and after that with other signs of inputs or outputs."""
    log = replace(log, **{of: getattr(log, of)[:, ::-1]})
    return replace(log, **{turned: getattr(log, turned) * signs})


@pytest.mark.parametrize(
    ("of", "turned", "signs", "horizon"),
    [("outputs", "inputs", [1, -1], HORIZON), ("inputs", "outputs", [-1, 1], HORIZON)],
)
def test_an_exchange_beside_a_turned_sign_is_told_and_mended(tmp_path, of, turned, signs, horizon):
    right = tracked(mujoco.MjModel.from_xml_string(ARM), MOTION[ARM])
    own, read = robot(tmp_path, ARM, exchanged(right, of, signs, turned), horizon)
    with pytest.raises(InputError, match="exchanged and with the other sign") as refused:
        refuse_miswired(own, read)
    said = str(refused.value)
    assert f'write trust = ["wiring"] into {own.file.path}' in said
    (tmp_path / "log.toml").write_text(advised(said))
    mended = read_robot_log(own.file, tmp_path / "log.csv")
    turns = [np.sign(np.sum(getattr(mended, of) * getattr(right, of), axis=0))
             for of in ("inputs", "outputs")]  # fmt: skip
    for of, turn in zip(("inputs", "outputs"), turns, strict=True):
        np.testing.assert_allclose(getattr(mended, of), turn * getattr(right, of), rtol=1e-12)
    np.testing.assert_array_equal(*turns)  # joint and drive turned together: seen from behind
    refuse_miswired(own, mended)
