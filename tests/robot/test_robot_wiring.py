"""A log that another unit, sign or order of columns explains far better is refused."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from advice import advised
from joint_cases import ARM, SLIDER, arm, arm_log, run, slider, slider_log, steps
from plain_logs import plain_log, stepped
from tracked_cases import refused, robot

from identification import Log, read_robot, write_log
from identification.__main__ import main
from identification.errors import InputError
from identification.logs.units import UNITS
from identification.refusals import judge
from identification.refusals.balance import unbalanced_share
from identification.refusals.by_forces import NEEDED, rescaled
from identification.refusals.columns import Doubt
from identification.refusals.wiring import refuse_miswired

pytestmark = pytest.mark.usefixtures("few_effects")

RNG = np.random.default_rng(5)


CRANE = """<mujoco model="crane"><option timestep="0.0025" integrator="RK4"/>
<worldbody><body name="cart">
<joint name="x" type="slide" axis="1 0 0" damping="2.5" stiffness="60"/>
<inertial pos="0 0 0" mass="3" diaginertia="0.01 0.01 0.01"/>
<body name="bob"><joint name="swing" axis="0 1 0" damping="0.02"/>
<inertial pos="0 0 {z}" mass="0.8" diaginertia="0.002 0.002 0.001"/></body></body></worldbody>
<actuator><motor name="push" joint="x"/></actuator>
<sensor><jointpos name="pos" joint="x"/><jointpos name="ang" joint="swing"/></sensor></mujoco>"""


@pytest.fixture(scope="module")
def cart(tmp_path_factory):
    log = slider_log(steps(400))
    y = run(slider(), log)
    log = replace(log, outputs=y + 1e-3 * RNG.standard_normal(y.shape), units={})
    return robot(tmp_path_factory.mktemp("cart"), SLIDER, log)


@pytest.fixture(scope="module")
def two_joints(tmp_path_factory):
    u = steps(240, 2, hold=30)
    log = arm_log(u)
    y = run(arm(), log)
    log = replace(log, outputs=y + 1e-3 * RNG.standard_normal(y.shape))
    return robot(tmp_path_factory.mktemp("arm"), ARM, log)


def crane(z, feedback, samples=600):
    """A log of a pendulum on a cart, hanging or balanced by feedback [pos, ang, and rates]."""
    model = mujoco.MjModel.from_xml_string(CRANE.format(z=z))
    data = mujoco.MjData(model)
    data.qpos[1] = 0.1
    u, y = np.zeros((samples, 1)), np.zeros((samples, 2))
    push = 20 * steps(samples, hold=25)[:, 0] * (1 if z < 0 else 0.1)
    for k in range(samples):
        y[k] = data.qpos
        u[k] = data.ctrl[0] = push[k] + np.dot(feedback, [*data.qpos, *data.qvel])
        mujoco.mj_step(model, data, 4)
    y += 3e-4 * RNG.standard_normal(y.shape)
    return plain_log(u, y, "push", "pos ang")


@pytest.fixture(scope="module")
def hanging(tmp_path_factory):
    return robot(tmp_path_factory.mktemp("crane"), CRANE.format(z=-0.3),
                 crane(-0.3, np.zeros(4), samples=240))  # fmt: skip


@pytest.mark.parametrize("values", [{}, {"mass": 0.6}, {"damping": 12.0}])
def test_a_log_as_the_model_reads_it_passes_even_where_its_values_are_threefold_off(cart, values):
    own, log = cart
    y = run(slider(), log, **values) if values else log.outputs
    refuse_miswired(own, replace(log, outputs=y))


@pytest.mark.parametrize("word", [w for w, (si, factor) in UNITS.items() if si == "m" != w])
def test_another_unit_is_named(cart, word):
    own, log = cart
    said = refused(own, replace(log, outputs=log.outputs / UNITS[word][1]))
    assert f'position = "{word}"' in said
    assert "robot.toml" in said


def test_a_turned_sign_is_named(cart, two_joints):
    own, log = cart
    assert "turn the sign of position" in refused(own, replace(log, outputs=-log.outputs))
    own, log = two_joints
    refuse_miswired(own, log)
    turned = replace(log, outputs=log.outputs * [1, -1])
    assert "turn the sign of b: write b = -1 under [factors]" in refused(own, turned)
    said = refused(own, replace(turned, factors={"b": -1.0}))
    assert "; turn the sign of the factor -1 of b that the log's TOML gives, or give" in said


def test_exchanged_columns_are_named(two_joints):
    own, log = two_joints
    said = refused(own, replace(log, outputs=log.outputs[:, ::-1]))
    assert "exchange a and b under [columns]" in said


def test_inputs_that_are_turned_or_exchanged_are_told(hanging, two_joints):
    own, log = hanging
    said = refused(own, replace(log, inputs=-log.inputs))
    assert "turn the sign of pos, ang, or of push" in said  # which of them, none can tell
    own, log = two_joints
    said = refused(own, replace(log, inputs=log.inputs[:, ::-1]))
    assert "exchange up and low under [columns]" in said
    assert "turn the sign of up" in refused(own, replace(log, inputs=log.inputs * [-1, 1]))


def test_a_pendulum_that_feedback_balances_is_not_refused(tmp_path):
    log = crane(0.3, np.array([40.0, 250.0, 30.0, 50.0]))
    assert np.abs(log.outputs[:, 1]).max() < 0.5
    refuse_miswired(*robot(tmp_path, CRANE.format(z=0.3), log))


def test_the_commands_refuse_it_for_the_log_and_for_its_records(cart, tmp_path, capsys):
    own, log = cart
    wrong = tmp_path / "mm.csv"
    write_log(replace(log, outputs=1e3 * log.outputs, units={}), wrong)
    right = own.file.path.with_name("log.csv")
    for logs in ([wrong], [right, "--confirm", wrong]):
        assert main(["discover", str(own.file.path), *map(str, logs)]) == 2
        assert "log 'mm'" in capsys.readouterr().err


@pytest.mark.parametrize(("said", "true"), [("cm", "mm"), ("mm", "m"), ("m", "cm")])
def test_the_unit_that_is_told_mends_a_log_whose_unit_was_said_wrongly(cart, tmp_path, said, true):
    own, log = cart
    (name,) = log.output_names
    wrong, size = tmp_path / "wrong.csv", UNITS[true][1]
    write_log(replace(log, outputs=log.outputs / size, units={}), wrong)
    head, rows = wrong.read_text().split("\n", 1)
    wrong.write_text(head.replace(name, f"{name} [{said}]") + "\n" + rows)
    wrong.with_suffix(".toml").unlink(missing_ok=True)
    with pytest.raises(InputError, match="of the log's TOML") as refusal:
        read_robot(own.file.path, wrong)
    wrong.with_suffix(".toml").write_text(advised(str(refusal.value)))
    mended = read_robot(own.file.path, wrong).log
    np.testing.assert_allclose(mended.outputs, log.outputs, rtol=1e-6, atol=1e-9)


STEP, HELD = 0.01, 20  # [s], and samples for which a torque is held


def chain_of(joints, mass, stiffness):
    """Bodies that hang on each other, with a motor and an encoder at each joint."""
    axes = ("0 1 0", "1 0 0")
    bodies = "".join(
        f"""<body pos="0 0 {-0.15 if k else 0}"><joint name="j{k}" axis="{axes[k % 2]}"
        damping="0.1" stiffness="{stiffness}" armature="0.01"/>
        <inertial pos="0 0 -.07" mass="{mass}" diaginertia="4e-4 4e-4 2e-4"/>"""
        for k in range(joints)
    )
    motors = "".join(f'<motor name="u{k}" joint="j{k}"/>' for k in range(joints))
    sensors = "".join(f'<jointpos name="y{k}" joint="j{k}"/>' for k in range(joints))
    return (
        f'<mujoco><option timestep="{STEP / 2}" integrator="RK4"><flag contact="disable"/></option>'
        f"<worldbody>{bodies}{'</body>' * joints}</worldbody><actuator>{motors}</actuator>"
        f"<sensor>{sensors}</sensor></mujoco>"
    )


def measured(model, samples, torque, noise, still=0):
    """A right log of a chain: torques by chance, after some samples without, and noise."""
    rng, joints = np.random.default_rng(7), model.nv
    u = np.repeat(torque * rng.standard_normal((samples // HELD + 1, joints)), HELD, axis=0)
    u[:still] = 0.0
    y = stepped(model, u[:samples]) + noise * rng.standard_normal((samples, joints))
    return Log(
        time=STEP * np.arange(samples), inputs=u[:samples], outputs=y,
        input_names=[f"u{k}" for k in range(joints)],
        output_names=[f"y{k}" for k in range(joints)],
        units={f"y{k}": "rad" for k in range(joints)},
    )  # fmt: skip


def test_noise_is_no_missing_force_of_a_long_chain():
    model = mujoco.MjModel.from_xml_string(chain_of(16, 0.3, 2.0))
    log = measured(model, 600, 0.5, 5e-4)
    left = unbalanced_share(model, log)
    assert left is None or left.max() < NEEDED
    same = {n: n for n in (*log.input_names, *log.output_names)}
    assert rescaled(model, Doubt.of(log, same)) is None


def test_a_short_chain_keeps_its_balance_in_any_unit():
    model = mujoco.MjModel.from_xml_string(chain_of(4, 0.3, 2.0))
    log = measured(model, 600, 0.5, 5e-4)
    assert unbalanced_share(model, log).max() < 0.05
    in_degrees = replace(log, outputs=np.rad2deg(log.outputs))
    assert unbalanced_share(model, in_degrees).max() > NEEDED


@pytest.mark.parametrize("still", [0, 500])
def test_of_a_long_log_a_beginning_that_moves_is_judged(tmp_path, monkeypatch, still):
    monkeypatch.setattr(judge, "MOST_SAMPLES", 200)
    seen, plain = set(), judge.first_error

    def counted(plant, log, *others):
        seen.add(len(log))
        return plain(plant, log, *others)

    monkeypatch.setattr(judge, "first_error", counted)
    text = chain_of(2, 0.3, 2.0)
    right = measured(mujoco.MjModel.from_xml_string(text), 1000, 0.5, 1e-3, still)
    own, log = robot(tmp_path, text, right)
    refuse_miswired(own, log)
    assert max(seen) < len(log) if not still else min(seen) > still
    with pytest.raises(InputError, match="exchange"):
        refuse_miswired(own, replace(log, outputs=log.outputs[:, ::-1]))
