"""Forces alone tell a wrong unit, sign or order of columns of an arm, and accuse no right log."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from plain_logs import plain_log
from tracked_cases import ARM, MOTION, friction, heavy, no_gravity, nothing, payload, robot, tracked

from identification import InputError
from identification.refusals.by_forces import balanced_otherwise
from identification.refusals.columns import Doubt, input_unit_readings, turned, unit_readings
from identification.refusals.same_units import drive_units
from identification.refusals.wiring import refuse_unbalanced


def a_log(world=payload):
    model = mujoco.MjModel.from_xml_string(ARM)
    world(model)
    return tracked(model, MOTION[ARM])


def in_millinewton(log):
    return replace(log, inputs=1000 * log.inputs)


def motor_turned(log):
    return replace(log, inputs=turned(log.inputs, [0]))


def motors_exchanged(log):
    return replace(log, inputs=log.inputs[:, ::-1])


def angles_exchanged(log):
    return replace(log, outputs=log.outputs[:, ::-1])


@pytest.mark.parametrize(
    ("mistake", "cure", "word"),
    [
        (in_millinewton, r'write u1 = "mN m" and u2 = "mN m" .* under \[units\]', "units"),
        (motor_turned, r"write u1 = -1 under \[factors\]", "wiring"),
        (motors_exchanged, 'write u1 = "u2" and u2 = "u1"', "wiring"),
        (angles_exchanged, 'write q1 = "q2" and q2 = "q1"', "wiring"),
    ],
    ids=lambda x: getattr(x, "__name__", ""),
)
def test_a_mistake_is_refused_with_its_cure(tmp_path, mistake, cure, word):
    own, log = robot(tmp_path, ARM, mistake(a_log()), "horizon = 0.2")
    with pytest.raises(InputError, match=cure) as refusal:
        refuse_unbalanced(own, log)
    assert f'trust = ["{word}"]' in str(refusal.value)
    refuse_unbalanced(replace(own, file=replace(own.file, trust=(word,))), log)


@pytest.mark.parametrize(
    "world", [nothing, payload, no_gravity, friction, heavy], ids=lambda f: f.__name__
)
def test_a_right_log_is_never_refused(tmp_path, world):
    refuse_unbalanced(*robot(tmp_path, ARM, a_log(world), "horizon = 0.2"))


SLIDER = """<mujoco><option timestep="0.01"/><worldbody><body><joint name="x" type="slide"
axis="1 0 0" damping="4"/><geom size="0.1" mass="2"/></body></worldbody><actuator>
<motor name="u" joint="x"/></actuator><sensor><jointpos name="x" joint="x"/></sensor></mujoco>"""


@pytest.mark.parametrize("seed", range(3))
def test_a_unit_that_explains_next_to_nothing_is_no_cure(seed):
    """Force and position in each other's column: in millimetres 3 % of nothing were explained."""
    model, rng = mujoco.MjModel.from_xml_string(SLIDER), np.random.default_rng(seed)
    time, data, x = 0.01 * np.arange(800), mujoco.MjData(model), []
    rates, phases = rng.uniform(1.0, 9.0, 5), rng.uniform(0.0, 6.3, 5)
    force = 2.5 * np.sin(rates * time[:, None] + phases).sum(axis=1)
    for u in force:
        x.append(data.qpos[0] + 2e-5 * rng.standard_normal())
        data.ctrl[0] = u
        mujoco.mj_step(model, data)
    log = plain_log(np.array(x)[:, None], force[:, None], "u", "x", time=time)
    doubt = Doubt.of(log, {"u": "u", "x": "x"})
    readings = [*input_unit_readings(doubt, drive_units(model, log)), *unit_readings(doubt)]
    assert balanced_otherwise(model, doubt, readings) is None
