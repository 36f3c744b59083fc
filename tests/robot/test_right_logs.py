"""No right log is refused: not with a payload, gravity, friction or mass that the model lacks."""

from dataclasses import replace
from functools import cache

import mujoco
import numpy as np
import pytest
from plain_logs import model_log, plain_log, stepped
from tracked_cases import (
    ARM,
    MOTION,
    PENDULUM,
    friction,
    no_gravity,
    nothing,
    payload,
    robot,
    tracked,
)

from identification import InputError, Log
from identification.refusals.balance import unbalanced
from identification.refusals.by_forces import NEEDED, rescaled
from identification.refusals.columns import Doubt
from identification.refusals.same_units import different_units
from identification.refusals.wiring import refuse_different_units, refuse_miswired

pytestmark = pytest.mark.usefixtures("few_effects")


@pytest.mark.parametrize(
    ("xml", "horizon"), [(PENDULUM, ""), (ARM, "horizon = 0.2")], ids=["pendulum", "arm"]
)
@pytest.mark.parametrize(("world", "lacking"), [
    (payload, nothing), (nothing, no_gravity), (friction, nothing),
], ids=lambda f: f.__name__)  # fmt: skip
def test_a_right_log_is_not_refused(tmp_path, xml, horizon, world, lacking):
    spec = mujoco.MjSpec.from_string(xml)
    truth = spec.compile()
    world(truth)
    known = spec.compile()
    lacking(known)
    own, log = robot(tmp_path, xml, tracked(truth, MOTION[xml]), horizon)
    for field in ("body_mass", "body_inertia", "dof_damping", "dof_frictionloss"):
        getattr(own.plant.model, field)[:] = getattr(known, field)
    own.plant.model.opt.gravity[:] = known.opt.gravity
    refuse_miswired(own, log)


DEG = 180 / np.pi
HOLDING = PENDULUM.replace(
    '<motor name="u1" joint="q1"/>', '<position name="u1" joint="q1" kp="40" kv="4"/>'
)
BOTH = PENDULUM.replace("</sensor>", '<jointvel name="v1" joint="q1"/></sensor>')


@cache
def log_of(xml, world):
    model = mujoco.MjModel.from_xml_string(xml)
    world(model)
    return tracked(model, MOTION[xml])


def test_a_unit_is_told_whatever_the_model_lacks(tmp_path):
    log = log_of(ARM, payload)
    wrong = replace(log, outputs=1e3 * log.outputs)
    own, read = robot(tmp_path, ARM, wrong, "horizon = 0.2")
    with pytest.raises(InputError, match='q1 = "mrad"') as refused:
        refuse_miswired(own, read)
    assert 'or write trust = ["units"] into' in str(refused.value)
    refuse_miswired(replace(own, file=replace(own.file, trust=("units", "wiring"))), read)


@pytest.mark.parametrize(("late", "step"), [(0, 1.5e-3), (6, 2e-2)])
@pytest.mark.parametrize("world", [nothing, payload, friction], ids=lambda f: f.__name__)
def test_a_right_log_of_a_coarse_encoder_or_a_late_torque_passes(world, late, step):
    log = log_of(ARM, world)
    y = step * np.round(log.outputs / step) if step else log.outputs
    u = np.roll(log.inputs, late, axis=0)
    read = replace(log, outputs=y, inputs=u, units=dict.fromkeys(log.output_names, "rad"))
    same = {n: n for n in (*log.input_names, *log.output_names)}
    assert rescaled(mujoco.MjModel.from_xml_string(ARM), Doubt.of(read, same)) is None


def swung(model, idle, seed=0):
    """A log of an arm whose last drive swings it, while the others give `idle` [N m] rms."""
    rng = np.random.default_rng(seed)
    size = np.where(np.arange(model.nu) == model.nu - 1, 1.0, idle)
    u = np.repeat(size * rng.standard_normal((30, model.nu)), 20, axis=0)
    y = stepped(model, u)
    return model_log(model, u, y + 2e-4 * rng.standard_normal(y.shape))


def test_a_drive_that_rests_beside_others_is_no_reason_to_doubt_a_unit():
    truth = mujoco.MjModel.from_xml_string(ARM)
    truth.dof_frictionloss[:] = 0.2
    known, log = mujoco.MjModel.from_xml_string(ARM), swung(truth, 1e-3)
    left = unbalanced(known, log, springs=True)
    assert left.of_outputs[0] > NEEDED > 4 * left.whole
    same = {n: n for n in (*log.input_names, *log.output_names)}
    assert rescaled(known, Doubt.of(log, same)) is None
    turned = replace(log, outputs=log.outputs * DEG, units=dict.fromkeys(log.output_names, "rad"))
    reading, _ = rescaled(known, Doubt.of(turned, same))
    assert 'q1 = "deg"' in reading.cure


def moved(samples=400, step=0.01, seed=0):
    """Position and rate of a joint under random forces."""
    rng = np.random.default_rng(seed)
    a = np.repeat(rng.uniform(-4, 4, samples // 20), 20)
    v = np.cumsum(a) * step
    v -= np.linspace(0, 1, samples) * v[-1]
    return np.cumsum(v) * step, v, a


def read_as(q, other, name, of):
    """A log with a position and one column more, an output or an input."""
    u = other if of == "input" else np.zeros(len(q))
    outputs = np.stack([q, other], axis=1) if of == "output" else q[:, None]
    names = ("q1", name) if of == "output" else ("q1",)
    return Log(time=0.01 * np.arange(len(q)), inputs=u[:, None], outputs=outputs,
               input_names=("u1",), output_names=names,
               units=dict(zip(names, ("rad", "rad/s"), strict=False)))  # fmt: skip


def test_a_rate_in_another_unit_than_its_position_is_told():
    model, names = mujoco.MjModel.from_xml_string(BOTH), {n: n for n in ("u1", "q1", "v1")}
    q, v, _ = moved()
    assert different_units(model, read_as(q, v + 0.3, "v1", "output"), names) is None
    said = different_units(model, read_as(DEG * q, v + 0.3, "v1", "output"), names)
    assert 'q1 = "deg"' in said


@pytest.mark.parametrize("share", [1, 0.2])
def test_a_position_that_follows_the_wanted_one_late_or_in_part_has_its_unit(share):
    model = mujoco.MjModel.from_xml_string(HOLDING)
    q, *_ = moved()
    late = np.concatenate([q[:1].repeat(5), q[:-5]])
    log = read_as(share * (late + 0.1), q, "u1", "input")
    assert different_units(model, log, {n: n for n in ("u1", "q1")}) is None


def test_a_wanted_position_in_degrees_is_refused_by_the_robot(tmp_path):
    model = mujoco.MjModel.from_xml_string(HOLDING)
    q = moved()[0][:, None]
    log = plain_log(q, stepped(model, q), "u1", "q1")
    own, read = robot(tmp_path, HOLDING, log, "horizon = 0.2")
    refuse_different_units(own, read)
    with pytest.raises(InputError, match='write u1 = "deg" under'):
        refuse_different_units(own, replace(read, inputs=DEG * read.inputs))


@pytest.mark.parametrize("late", [0, 4, 15])
def test_a_wanted_position_in_degrees_is_told_however_late_the_servo_follows(late):
    model, t = mujoco.MjModel.from_xml_string(HOLDING), 0.01 * np.arange(400)
    q = 0.5 * np.sin(9 * t) + 0.2 * np.sin(23 * t)
    y = np.concatenate([q[:1].repeat(late), q[: len(q) - late]])
    names = {n: n for n in ("u1", "q1")}
    assert different_units(model, read_as(y, q, "u1", "input"), names) is None
    said = different_units(model, read_as(y, DEG * q, "u1", "input"), names)
    assert 'u1 = "deg"' in said
