"""The share of one actuator moves the rates as an evaluation of the whole model does."""

from dataclasses import replace
from unittest import mock

import numpy as np
import pytest
from effect_cases import full
from test_points import drawn, one_by_one

from identification.linear import points as of_points
from identification.linear.points import Change, Points
from identification.model.paths import Slot
from identification.model.protocol import list_differences
from identification.model.rollout import without_sensors
from identification.native.installer import owners_of
from inca_mj.robot import law
from inca_mj.robot.geometry import DRIVES

ALONE = {
    "actuator_user", "actuator_gear", "tendon_user", "dof_damping", "site_pos", "qpos", "qvel"
}  # fmt: skip


@pytest.fixture(scope="module")
def robot():
    return full()


def states(robot, seed=0):
    state = robot.state()
    return drawn(without_sensors(robot.model), state.qpos, state.act, count=5, seed=seed)


def agrees(at, changes):
    """Each change is taken by shares, and moves the rates as the slow way says."""
    points, unmoved = Points(at), one_by_one(at, Change())
    last_digits = 1e-12 * np.abs(unmoved).max(axis=0)
    for change, rates in zip(changes, points.each(changes), strict=True):
        assert points._actuators(change)
        moved = one_by_one(at, change)
        far = np.abs(moved - unmoved).max(axis=0)
        assert (np.abs(rates - moved) <= 1e-9 * far + last_digits).all()


def test_each_number_of_each_drive(robot):
    at = states(robot)
    own = robot.parameters.values()
    # A platform's effects and the armatures, which are in the mass matrix, are no share of a drive.
    names = [n for n in own if not n.startswith(("external_force", "air_drag", "I_"))]
    names = [n for n in names if n not in {"J", "m"}]
    values = np.tile([own[n] for n in names], (1 + len(names), 1))
    values[1:] += np.diag([1e-3 * v or 1e-3 for v in values[0]])
    numbers = robot.settings(names, values)[1]
    entries = list_differences(numbers, 0, range(1, 1 + len(names)))
    changes = [Change({}, some) for some in entries if some]
    assert len(changes) > 300
    agrees(at, changes)


def test_each_end_of_a_cable_each_rotor_and_each_activation(robot):
    at = states(robot)
    model = at.model
    ends = [Slot("site_pos", (int(site),), j) for site in model.wrap_objid for j in range(3)]
    changes = [Change({}, [(s, model.site_pos[s.rows[0], s.column] + 1e-3)]) for s in ends]
    for k in range(DRIVES):
        joint = model.joint(f"motor_{k + 1}")
        for field, i in (("qpos", joint.qposadr), ("qvel", joint.dofadr)):
            moved = getattr(at, field).copy()
            moved[:, i] += 1e-2
            changes.append(Change({field: moved}))
    changes += [Change({"act": at.act + 1e-4 * unit}) for unit in np.eye(model.na)]
    changes.append(Change({"act": at.act * 1.001}, changes[0].numbers))
    agrees(at, changes)


def test_courses_multiply_what_shares_add(robot):
    at = states(robot)
    courses = np.random.default_rng(2).uniform(size=(3, 5))
    changes = [Change({"act": at.act + 1e-4 * unit}, (), courses) for unit in np.eye(at.model.na)]
    over = of_points.Intervals(np.array([0, 2]), np.array([0.5, 0.5, 0.2, 0.3, 0.5]))
    by_shares = np.array(list(Points(at).each(changes, over)))
    with mock.patch.object(of_points, "owners_of", return_value={}):
        whole = np.array(list(Points(at).each(changes, over)))
    np.testing.assert_allclose(by_shares, whole, rtol=1e-9, atol=1e-9 * np.abs(whole).max())


def test_what_no_drive_reads_alone_is_evaluated_whole(robot):
    at = states(robot)
    points, position = Points(at), at.qpos.copy()
    position[:, 0] += 1e-3
    body = robot.model.body("platform").id
    for change in (
        Change({"qpos": position}),
        Change({"ctrl": at.inputs + 0.1}),  # crosstalk reads the currents of the drives beside it
        Change({}, [(Slot("body_mass", (body,), None), 0.2)]),
        Change({}, [(Slot("actuator_user", (0,), law.R), 0.05),
                    (Slot("dof_armature", (6,), None), 1e-3)]),
        Change(),
    ):  # fmt: skip
        assert points._actuators(change) == ()
    assert Points(at, ("qacc",))._actuators(Change({"act": at.act + 1e-3})) == ()


@pytest.mark.parametrize(("field", "value"), [
    ("actuator_forcelimited", 1), ("actuator_gainprm", 1.0), ("dof_dampingpoly", 1e-3),
    ("actuator_damping", 1e-3),
])  # fmt: skip
def test_a_force_that_mujoco_limits_or_adds_to_is_evaluated_whole(robot, field, value):
    model = without_sensors(robot.model)
    assert {name for name, _ in owners_of(model)} == ALONE
    getattr(model, field)[0] = value
    assert owners_of(model) == {}


def test_where_a_law_begins_anew_it_is_evaluated_whole(robot):
    at = states(robot)
    first = at.model.actuator_actadr[0]
    begun = at.act.copy()
    begun[1, first] = 0.0
    number = [(Slot("actuator_user", (0,), law.R), 0.05)]
    changes = [Change({"act": begun}), Change({}, number)]
    assert Points(at)._actuators(changes[0]) == ()
    at = replace(at, act=begun)
    for change, rates in zip(changes[1:], Points(at).each(changes[1:]), strict=True):
        np.testing.assert_array_equal(rates, one_by_one(at, change))
