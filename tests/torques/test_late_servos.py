"""Arms with position servos: setpoints that come late, a clock for each record, and a wrong kp."""

import re
from dataclasses import replace
from functools import cache

import mujoco
import numpy as np
import pytest

from identification import InputError, Log, fit_torques, read_robot
from identification.refusals.wiring import refuse_unbalanced
from identification.torques import clock
from identification.torques.equations.drives import input_at
from identification.torques.equations.rows import make_rows

ARM = """
<mujoco><compiler angle="radian"/><option timestep="0.002" integrator="implicitfast"/><worldbody>
<body name="upper"><joint name="j0" axis="0 1 0" armature="0.05" damping="0.1"/>
<inertial pos="0.02 0 -0.17" mass="1.5" diaginertia="0.02 0.02 0.004"/>
<body name="fore" pos="0 0 -0.35"><joint name="j1" axis="0 1 0" armature="0.02" damping="0.05"/>
<inertial pos="0.02 0 -0.14" mass="0.7" diaginertia="0.006 0.006 0.001"/></body></body></worldbody>
<actuator><position name="u0" joint="j0" kp="{0}" kv="3"/>
<position name="u1" joint="j1" kp="{1}" kv="1.5"/></actuator>
<sensor><jointpos name="q0" joint="j0"/><jointpos name="q1" joint="j1"/></sensor></mujoco>
"""
KP, OFF = np.array([60.0, 25.0]), 1.15  # of the model, and factor of the true ones
H, STEP, NOISE = 0.01, 0.001, 2e-5  # of the log [s], of the simulation [s], of the encoders [rad]
SECONDS = 12.0
HELD = 'model = "arm.xml"\nfree = [{}]\nhorizon = 0.2\n'
KNOWN = '[parameters."{}"]\nknown = 0.3\n'
SERVOS = ("actuator/u0.kp", "actuator/u1.kp")


@cache
def record(seed, late=0.0, factor=1.0, hardening=0.0):
    """A record of the arm, whose setpoints act some time later than their stamps say."""
    model = mujoco.MjModel.from_xml_string(ARM.format(*(factor * KP)))
    # Other integrators add a step of the damping to each inertia, and half a step to each clock.
    model.opt.timestep, model.opt.integrator = STEP, mujoco.mjtIntegrator.mjINT_RK4
    data, rng = mujoco.MjData(model), np.random.default_rng(seed)
    ω = 2 * np.pi * 0.15 * np.arange(1, 7)
    a = rng.uniform(0.1, 0.3, (2, 6)) / np.sqrt(np.arange(1, 7))
    p = rng.uniform(0, 2 * np.pi, (2, 6))
    every, n = round(H / STEP), round(SECONDS / H)
    goals = np.array([(a * np.sin(ω * H * k + p)).sum(axis=1) for k in range(n)])
    data.qpos, data.qvel = goals[0], (a * ω * np.cos(p)).sum(axis=1)
    measured = []
    for k in range(n * every):
        if k % every == 0:
            measured.append(data.qpos + NOISE * rng.standard_normal(2))
        data.ctrl = goals[max(0, k - round(late / STEP)) // every]
        data.qfrc_applied = -hardening * data.qpos**3 * [1.0, 0.5]
        mujoco.mj_step(model, data)
    names = ("u0", "u1"), ("q0", "q1")
    return Log(
        time=H * np.arange(n), inputs=goals, outputs=np.array(measured), input_names=names[0],
        output_names=names[1], name=f"r{seed}", units=dict.fromkeys((*names[0], *names[1]), "rad"),
    )  # fmt: skip


def read(folder, logs, confirm=(), free=("joint/j0.armature",)):
    (folder / "arm.xml").write_text(ARM.format(*KP))
    names = ", ".join(f'"{name}"' for name in free)
    known = "".join(KNOWN.format(name) for name in free)
    (folder / "arm.toml").write_text(HELD.format(names) + known)
    return read_robot(folder / "arm.toml", logs, confirm, ("wiring", "units", "steps"))


@pytest.mark.parametrize("late", [(0.0, 0.0), (0.01, 0.01), (0.02, 0.02), (0.003, 0.014)])
def test_late_setpoints_are_a_clock_of_each_record_and_nothing_else(tmp_path, late):
    logs = [record(k, x) for k, x in enumerate(late)]
    found = fit_torques(read(tmp_path, logs[:1], logs[1:]))
    assert found.named == ()
    assert found.found.clocks.shift == pytest.approx(np.array(late), abs=2e-4)
    final = found.found.unseen[2]
    assert (final < 3 * found.found.noise).all()  # nothing is left of the record that confirms


def test_a_spring_that_hardens_is_told_beside_late_setpoints(tmp_path):
    logs = [record(k, 0.01, hardening=1.5) for k in range(2)]
    found = fit_torques(read(tmp_path, logs[:1], logs[1:]))
    assert {s.missing.name for s in found.named} == {"hardening"}
    assert found.found.clocks.shift == pytest.approx(0.01, abs=2e-4)


@pytest.mark.parametrize("hardening", [0.0, 1.5])
def test_the_masses_tell_a_free_kp_and_nothing_collapses(tmp_path, hardening):
    logs = [record(k, 0.01, OFF, hardening) for k in range(2)]
    found = fit_torques(read(tmp_path, logs[:1], logs[1:], ("joint/j0.armature", *SERVOS)))
    final, whole = found.found.final, found.found.whole
    kp = final.fit.θ[[final.names.index(name) for name in SERVOS]]
    assert kp == pytest.approx(OFF * KP, rel=0.005)
    assert {s.missing.name for s in found.named} == ({"hardening"} if hardening else set())
    # the fit of all numbers holds the gains, and says so
    assert found.found.gains == SERVOS
    assert not {*SERVOS} & {*whole.names}
    if not hardening:
        told = whole.fit.std[: len(found.found.base.names)] < 0.01 * np.abs(found.found.base.values)
        ratio = whole.fit.θ[: len(told)] / found.found.base.values
        assert ratio[told] == pytest.approx(1 / OFF, rel=0.03)


@pytest.mark.parametrize("hardening", [0.0, 3.0])  # what is missing is smaller by smaller numbers
def test_what_was_known_of_masses_is_the_scale_where_these_are_free_too(tmp_path, hardening):
    logs = [record(k, 0.0, OFF, hardening) for k in range(2)]
    free = ("joint/j0.armature", "joint/j1.armature", "body/upper.mass", "body/fore.mass", *SERVOS)
    found = fit_torques(read(tmp_path, logs[:1], logs[1:], free)).found
    nominal = found.model.fit.θ[[found.model.names.index(name) for name in SERVOS]]
    assert (nominal > 0.7 * OFF * KP).all()
    final = found.final
    truth = np.array([0.05, 0.02, 1.5, 0.7, *(OFF * KP)])
    at = [final.names.index(name) for name in free]
    assert (np.abs(final.fit.θ[at] - truth) < 3 * np.hypot(final.fit.std[at], 0.01 * truth)).all()


@pytest.mark.parametrize("shift", [0.0, 0.0037, 0.01, -0.0062])
@pytest.mark.parametrize("is_held", [True, False])
def test_a_slow_input_comes_as_late_and_as_smooth_as_a_robot_feels_it(shift, is_held):
    ω, t = 2 * np.pi * 1.5, H * np.arange(400)
    middle, size = (H / 2, np.sinc(ω * H / (2 * np.pi))) if is_held else (0.0, 1.0)
    moved = input_at(np.sin(ω * t)[:, None], H, shift, is_held)[10:-10, 0]
    wanted = size * np.sin(ω * (t - shift - middle))[10:-10]
    np.testing.assert_allclose(moved, wanted, atol=1e-5)  # of fourth order: (ωh)⁴/8


def test_setpoint_and_position_of_a_servo_go_through_the_filter_once():
    """Its force is a small difference of both, and a narrow band leaves out some of each."""
    rng, servo = np.random.default_rng(1), ARM.format(*KP)
    log = record(0)
    log = replace(log, outputs=log.outputs + 1e-3 * rng.standard_normal(log.outputs.shape))
    motor = re.sub('position (name="u.") (joint="j.") kp="([^"]*)" kv="[^"]*"',
                   r'motor \1 \2 gear="\3"', servo)  # fmt: skip
    of_servo, of_setpoint = (
        make_rows(mujoco.MjModel.from_xml_string(text), [log])[0] for text in (servo, motor)
    )
    force = of_setpoint.drives.sum(axis=2) - KP * of_servo.q - [3, 1.5] * of_servo.v
    off = of_servo.drives.sum(axis=2) - force
    assert np.sqrt(np.mean(off**2)) < 1e-4 * np.sqrt(np.mean((KP * of_servo.q) ** 2))


def test_setpoints_and_positions_in_degrees_are_refused_and_radians_are_not(tmp_path):
    log = record(0, 0.01, OFF, 1.5)
    own = read(tmp_path, [log])
    own = replace(own, file=replace(own.file, trust=()))
    refuse_unbalanced(own, log)
    degrees = replace(log, inputs=np.rad2deg(log.inputs), outputs=np.rad2deg(log.outputs))
    with pytest.raises(InputError, match='q0 = "deg" and q1 = "deg" and u0 = "deg" and u1 = "deg"'):
        refuse_unbalanced(own, degrees)


def test_clocks_are_found_where_another_shift_feels_fewer_numbers(tmp_path, monkeypatch):
    """Whether kp is a gain is told by its column, and that by where the inputs stand."""
    fitted = []

    def fit_base(model, equations, base, others, **how):
        if not any(rows.shift for rows in equations.rows):
            others = replace(others, shares=np.zeros_like(others.shares))
        fitted.append(clock_fit(model, equations, base, others, **how))
        return fitted[-1]

    clock_fit = clock.fit_base
    monkeypatch.setattr(clock, "fit_base", fit_base)
    logs = [record(k, 0.02) for k in range(2)]
    found = fit_torques(read(tmp_path, logs[:1], logs[1:], ("joint/j0.armature", SERVOS[0])))
    assert len(fitted[0][1].names) > len(fitted[-1][1].names)
    assert found.found.clocks.shift == pytest.approx(np.full(2, 0.02), abs=5e-4)
