"""Effects of position servos: analytic cases, another integration, fits, and a search."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from joint_cases import run
from scipy.linalg import expm
from servo_cases import DAMPING, STEP, WEIGHT, J, Servo, lever, servo_log, setpoints

from identification import discover, fit, read_robot
from identification.effects.axes import Axis, axes
from identification.effects.catalogue import all_effects
from identification.effects.laws.joint_group import groups
from identification.effects.laws.servos import rate_limits
from identification.effects.values import changed_inputs
from identification.effects.variables import variables
from identification.model.rollout import State, rollout

RATE, BAND, GAIN = "rate_limit.w@aim", "dead_band.d@pivot", "integral_part.k_i@pivot"
OTHER = "servo_gain.gamma@pivot"
SERVO = Servo()
MANY = 400  # small steps in one of a slow integration
AT_REST = replace(SERVO, weight=0.0)
EACH = [
    ({RATE: 0.4}, {"w": 0.4}),
    ({BAND: 0.03}, {"band": 0.03}),
    ({GAIN: 25.0}, {"k_i": 25.0}),
    ({RATE: 0.3, BAND: 0.02, GAIN: 15.0}, {"w": 0.3, "band": 0.02, "k_i": 15.0}),
]
SINGLE = EACH[:3]


def limited(u, w):
    """A setpoint (N,) behind a limit of 1/w on its rate, a step of the simulation each."""
    (effect,) = rate_limits(groups([Axis("pivot", "hinge", 1.0, 1.0, 1.0, servo="aim")])[0])
    return changed_inputs([effect], ("aim",), {RATE: w}, u[:, None], STEP, 1).reshape(len(u))


@pytest.mark.parametrize("w", [0.003, 0.02, 0.11, 5.0])
def test_a_limited_setpoint_has_impulse_and_moment_of_a_slow_integration(w):
    u = np.repeat(np.random.default_rng(1).normal(0.0, 1.0, 12), 7)
    x, most, mean, moment = u[0], STEP / MANY / w, [], []
    middle = (np.arange(MANY) + 0.5) / MANY - 0.5
    for target in u:
        way = []
        for _ in range(MANY):
            step = max(-most, min(most, target - x))
            way.append(x + step / 2)
            x += step
        mean.append(np.mean(way))
        moment.append(np.mean(middle * way))
    expected = np.array(mean) - moment + np.concatenate([[0.0], moment[:-1]])
    np.testing.assert_allclose(limited(u, w), expected, atol=1e-4)
    np.testing.assert_array_equal(limited(u, 0.0), u)


def test_a_step_becomes_a_ramp_and_a_slow_ramp_passes():
    u = np.repeat([0.0, 1.0], [3, 60])
    ramp = np.concatenate([[0.0, 0.0], np.minimum(1.0, (np.arange(61) + 0.5) * STEP / 0.4)])
    shifted = limited(u, 0.4)
    np.testing.assert_allclose(shifted[4:40], ramp[3:39], atol=1e-12)  # in the middle of a step
    assert shifted.sum() == pytest.approx(u.sum() - 0.4 / 2 / STEP)  # the area that a ramp lacks
    slow = np.cumsum(np.full(50, 0.01))
    late = slow - limited(slow, 0.5)  # reaches each level within its step
    assert 0 < late[1:].max() < 0.01


@pytest.mark.parametrize(("gear", "timeconst"), [(1.0, 0.0), (-2.0, 0.0), (-2.0, 0.05)])
def test_a_load_rests_behind_the_dead_band_and_no_load_rests_anywhere_within(gear, timeconst):
    """Torque balance: γ² k_p (|e| - d) holds m g l cos q."""
    d, servo = 0.05, replace(SERVO, gear=gear, kp=20.0, timeconst=timeconst)
    u = np.full(600, gear * 0.3)
    q = run(lever(servo), servo_log(u), **{BAND: d})[-1, 0]
    e = 0.3 - q
    assert e > d
    balance = gear**2 * servo.kp * (e - d)
    assert balance == pytest.approx(WEIGHT * np.cos(q), abs=1e-6)
    free = replace(AT_REST, gear=gear)
    still = run(lever(free), servo_log(np.full(100, gear * 0.9 * d)), **{BAND: d})
    np.testing.assert_array_equal(still, 0.0)
    assert (
        np.abs(run(lever(free), servo_log(np.full(100, gear * 1.1 * d)), **{BAND: d})).max() > 1e-4
    )


@pytest.mark.parametrize("gamma", [0.3, -0.2])
@pytest.mark.parametrize(
    "more", [{}, {"gear": -1.5, "most": 2.5}, {"timeconst": 0.05}, {"timeconst": 0.02, "most": 2.5}]
)
def test_another_gain_is_that_of_another_servo(gamma, more):
    servo, u = replace(SERVO, **more), setpoints(4, 150)
    got = run(lever(servo), servo_log(u), **{OTHER: gamma})
    other = replace(servo, kp=(1 + gamma) * servo.kp)
    np.testing.assert_allclose(got, run(lever(other), servo_log(u)), atol=1e-12)
    assert np.abs(got - run(lever(servo), servo_log(u))).max() > 0.02


def test_a_filter_of_the_setpoint_hides_no_candidate_and_its_force_is_known():
    """Laws of the drive's force need it, and `<position timeconst>` filters its setpoint."""
    servo = replace(SERVO, timeconst=0.05)
    plant, u = lever(servo), setpoints(3, 300)
    assert {e.name for e in plant.effects} == {e.name for e in lever(SERVO).effects}
    log = servo_log(u, run(plant, servo_log(u)))
    model = mujoco.MjModel.from_xml_string(servo.text())
    data, largest, steps = mujoco.MjData(model), 0.0, round(STEP / model.opt.timestep)
    data.act[:] = u[0]
    for target in u:
        data.ctrl[:] = target
        for _ in range(steps):
            mujoco.mj_step(model, data)
            largest = max(largest, abs(float(data.qfrc_actuator[0])))
    (axis,) = axes(model, log)
    assert axis.servo == "aim"
    assert axis.force == pytest.approx(largest, rel=0.05)
    (unfiltered,) = axes(mujoco.MjModel.from_xml_string(SERVO.text()), log)
    assert unfiltered.force > 1.3 * largest


def test_an_actuator_that_acts_by_the_next_activation_has_no_known_force():
    early = mujoco.MjModel.from_xml_string(replace(SERVO, timeconst=0.05).text())
    early.actuator_actearly[:] = True
    (axis,) = axes(early, servo_log(setpoints(3, 100)))
    assert not axis.plain
    assert not axis.servo


def test_a_dead_band_takes_nothing_from_a_servo_at_its_limit():
    servo = replace(AT_REST, most=1.0)
    u = np.full(12, 3.0)  # an error of 3 rad asks for 24 N m
    banded = run(lever(servo), servo_log(u), **{BAND: 0.1})
    np.testing.assert_array_equal(banded, run(lever(servo), servo_log(u)))


def test_an_integral_part_answers_a_step_as_the_linear_equations_do():
    k_i, u, log = 30.0, 0.4, servo_log(np.full(150, 0.4))
    A = np.array([[0, 1, 0], [-8.0 / J, -(DAMPING + 0.3) / J, k_i / J], [-1, 0, 0]])
    whole = np.zeros((4, 4))
    whole[:3, :3], whole[:3, 3] = A, [0, 8.0 * u / J, u]
    expected = [(expm(whole * t) @ [0, 0, 0, 1])[0] for t in log.time]
    plant = lever(AT_REST).with_states_of([GAIN])
    got = run(plant, log, **{GAIN: k_i})[:, 0]
    np.testing.assert_allclose(got, expected, atol=1e-6)
    assert np.abs(got - run(plant, log)[:, 0]).max() > 0.05


def test_an_integral_part_leaves_no_error_under_a_load_and_keeps_the_servo_s_limit():
    plant = lever(SERVO).with_states_of([GAIN])
    q = run(plant, servo_log(np.full(800, 0.4)), **{GAIN: 25.0})[-1, 0]
    assert q == pytest.approx(0.4, abs=1e-6)
    assert run(plant, servo_log(np.full(800, 0.4)))[-1, 0] < 0.35
    weak = replace(SERVO, most=0.9 * WEIGHT)  # it cannot lift the lever, however long it tries
    wound = run(lever(weak).with_states_of([GAIN]), servo_log(np.full(800, 0.0)), **{GAIN: 25.0})
    np.testing.assert_allclose(np.cos(wound[-1, 0]), 0.9, atol=0.02)


@pytest.mark.parametrize(("values", "truth"), EACH)
@pytest.mark.parametrize("more", [{}, {"gear": -1.5, "most": 2.5}])
def test_each_is_that_of_another_integration(values, truth, more):
    u = setpoints(4, 150)
    servo = replace(SERVO, **more)
    expected = replace(servo, **truth).moved(u)
    got = run(lever(servo).with_states_of(values), servo_log(u), **values)
    np.testing.assert_allclose(got, expected, atol=3e-4)
    assert np.abs(run(lever(servo), servo_log(u)) - expected).max() > 0.01


def test_sizes_of_zero_keep_the_plain_model_to_the_bit():
    log = servo_log(setpoints(2, 300))
    spec = mujoco.MjSpec.from_string(SERVO.text())
    start = State(np.zeros(1), np.zeros(1), np.zeros(0))
    bare = rollout(spec.compile(), start, log.inputs, STEP, record=("qpos",))["qpos"][0]
    every = lever(SERVO).with_states_of([GAIN])
    assert every.model.na == 1
    for plant in (lever(SERVO), every):
        np.testing.assert_array_equal(run(plant, log), bare)
    zeros = {RATE: 0.0, BAND: 0.0, GAIN: 0.0}
    np.testing.assert_array_equal(run(every, log, **zeros), bare)


@pytest.mark.parametrize(("values", "truth"), SINGLE)
def test_what_tends_to_zero_tends_to_the_model_without_it(values, truth):
    (name, size), log = next(iter(values.items())), servo_log(setpoints(3, 200))
    plant = lever(SERVO).with_states_of(values)
    plain = run(plant, log)
    far = np.abs(run(plant, log, **{name: 1e-4 * size}) - plain).max()
    assert 0 < far < 1e-3
    assert np.abs(run(plant, log, **{name: 1e-6 * size}) - plain).max() < 0.03 * far


def test_they_are_candidates_at_position_servos_only():
    text = SERVO.text()
    where = {
        text: {"joint pivot", "input aim"},
        text.replace("<position", "<velocity").replace('kp="8.0"', ""): set(),
        text.replace("</actuator>", '<position name="two" joint="pivot" kp="3"/></actuator>'):
            set(),
    }  # fmt: skip
    for model, expected in where.items():
        spec = mujoco.MjSpec.from_string(model)
        log = servo_log(setpoints(0, 100))
        if "two" in model:
            log = replace(log, inputs=np.repeat(log.inputs, 2, 1), input_names=("aim", "two"))
        every = all_effects(spec, axes(spec.copy().compile(), log), log)
        mine = [
            e for e in every if e.name in ("rate_limit", "servo_gain", "dead_band", "integral_part")
        ]
        assert {w for e in mine for w in e.places} == expected
    law = next(e for e in lever(SERVO).effects if e.name == "dead_band")
    assert variables(law) >= {"e", "f_u"}


def recorded(folder, truth, seed):
    """A robot's file and its log of 4 s, with noise."""
    u, rng = setpoints(seed, 400), np.random.default_rng(seed)
    q = truth.moved(u, q=u[0])
    y = np.round(q + 2e-4 * rng.standard_normal(q.shape), 6)
    table = np.column_stack([np.arange(len(u)) * STEP, u, y])
    path = folder / f"log_{seed}.csv"
    np.savetxt(path, table, "%.8g", ",", header="time,aim,angle", comments="")
    return path


def robot_file(folder, said, more):
    """The robot's file of a model that says a servo."""
    (folder / "lever.xml").write_text(said.text(), encoding="utf-8")
    path = folder / "robot.toml"
    path.write_text(f'model = "lever.xml"\nhorizon = 0.3\n{more}', encoding="utf-8")
    return path


@pytest.mark.parametrize(("values", "truth"), SINGLE)
def test_a_fit_recovers_the_size_beside_a_gain(tmp_path, values, truth):
    ((name, size),) = values.items()
    toml = robot_file(
        tmp_path,
        SERVO,
        f"""free = ["actuator/aim.kp", "{name}"]
[parameters."{name}"]
value = {0.7 * size}
""",
    )
    log = recorded(tmp_path, replace(SERVO, kp=9.5, **truth), 7)
    found = fit(read_robot(toml, log))
    assert found.values[name] == pytest.approx(size, rel=0.02)
    assert found.values["actuator/aim.kp"] == pytest.approx(9.5, rel=0.02)


def test_a_search_names_a_limit_of_the_rate_of_a_servo_whose_gain_was_wrong(tmp_path):
    toml = robot_file(
        tmp_path,
        SERVO,
        """free = ["actuator/aim.kp", "joint/pivot.damping"]
[effects]
only = ["rate_limit", "dead_band", "delay", "lag", "coulomb_friction"]
""",
    )
    truth = replace(SERVO, kp=9.5, w=0.45)
    first, second = (recorded(tmp_path, truth, seed) for seed in (1, 2))
    found = discover(read_robot(toml, first, confirm=[second]))
    (named,) = found.named
    assert named.name == "rate_limit"
    assert named.where == "input aim"
    assert named.parameters["w"][0] == pytest.approx(0.45, rel=0.02)
