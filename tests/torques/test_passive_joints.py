"""A joint without a drive tells ratios of its numbers: zero for all of them explains nothing."""

import mujoco
import numpy as np
import pytest
from plain_logs import model_log

from identification import fit_torques, read_robot
from identification.robot.turned_drives import plain
from identification.torques.equations.base import find_base
from identification.torques.equations.equations import Equations, list_passive
from identification.torques.equations.others import Others
from identification.torques.equations.rows import make_rows
from identification.torques.fits import base_fit
from identification.torques.passive import with_expected_motion

STEP, EVERY, LASTS = 0.001, 10, 15.0
TRUE = {"first": 1.15, "pole": 0.26, "d": 0.007}
HANGING = (
    '<body name="{0}" pos="0 0 {3}"><joint name="{0}" axis="0 1 0" damping="{2}"/>'
    '<inertial pos="0 0 -0.2" mass="{1}" diaginertia="{4} {4} 0.001"/>{5}</body>'
)
KINDS = ("cart", "two", "arm")


def robot_of(kind, first, pole, d):
    """A cart with one pendulum, or with two behind each other; or a driven link with a pendulum."""
    tip = HANGING.format("tip", pole / 2, d, -0.4, pole * 0.005, "") if kind == "two" else ""
    hangs = HANGING.format("pole", pole, d, -0.3 if kind == "arm" else 0, pole * 0.02, tip)
    joint = 'axis="0 1 0"' if kind == "arm" else 'type="slide" axis="1 0 0"'
    joints = ["driven", "pole", *["tip"] * (kind == "two")]
    sensors = "".join(f'<jointpos name="q_{j}" joint="{j}"/>' for j in joints)
    return (
        f'<mujoco><option timestep="{STEP}" integrator="implicitfast"/><worldbody>'
        f'<body name="first"><joint name="driven" {joint} damping="0.8"/>'
        f'<inertial pos="0 0 -0.1" mass="{first}" diaginertia="0.02 0.02 0.02"/>{hangs}</body>'
        '</worldbody><actuator><motor name="u" joint="driven"/></actuator>'
        f"<sensor>{sensors}</sensor></mujoco>"
    )


def record(kind, seed, name="log", noise=1e-4, extra=None, **numbers):
    """A record with noise of the positions; a force of position and rate acts at the last joint."""
    model = mujoco.MjModel.from_xml_string(robot_of(kind, **{**TRUE, **numbers}))
    data, rng = mujoco.MjData(model), np.random.default_rng(seed)
    f, p = rng.uniform(0.2, 1.2, 6), rng.uniform(0, 6.28, 6)
    u, q = [], []
    for k in range(round(LASTS / STEP)):
        if k % EVERY == 0:
            data.ctrl[0] = np.sin(2 * np.pi * f * k * STEP + p).sum()
            data.ctrl[0] -= 3 * data.qpos[0] + data.qvel[0]
            u.append(data.ctrl.copy())
            q.append(data.qpos + noise * rng.standard_normal(model.nq))
        if extra is not None:
            data.qfrc_applied[-1] = extra(data.qpos[-1], data.qvel[-1])
        mujoco.mj_step(model, data)
    return model_log(model, np.array(u), np.array(q), EVERY * STEP, name=name)


def read(folder, kind, logs, confirm=(), free=("body/first.mass",), **numbers):
    given = {"first": 1.0, "pole": 0.26, "d": 0.01, **numbers}
    (folder / "robot.xml").write_text(robot_of(kind, **given))
    names = ", ".join(f'"{name}"' for name in free)
    (folder / "robot.toml").write_text(f'model = "robot.xml"\nfree = [{names}]\nhorizon = 0.2\n')
    return read_robot(folder / "robot.toml", logs, confirm, ("wiring", "units", "steps"))


def fitted(kind, log, factor=1.0):
    """The fit of all numbers; the model's masses and inertias are a factor too large."""
    model = mujoco.MjModel.from_xml_string(robot_of(kind, **TRUE))
    model.body_mass *= factor
    model.body_inertia *= factor
    measured = Equations.of(make_rows(plain(model), [log]))
    base, others = find_base(model), Others.of((), measured, [log])
    equations = with_expected_motion(model, measured, base, others)
    return measured, equations, base, base_fit(model, equations, base, others)


@pytest.fixture(scope="module", params=KINDS)
def fit(request):
    log = record(request.param, 1)
    return (request.param, log, *fitted(request.param, log))


def test_numbers_are_those_of_the_truth_and_not_zero(fit):
    *_, base, found = fit
    truth = base.values
    r = len(truth)
    off = (found.fit.θ[:r] - truth) / np.hypot(found.fit.std[:r], 0.02 * np.abs(truth))
    assert np.abs(off).max() < 5
    told = found.fit.std[:r] < np.abs(truth) / 4  # inertia and moment of what hangs are told
    assert told.sum() >= 2


def test_zero_for_all_numbers_explains_none_of_a_joint_without_a_drive(fit):
    """Where all numbers are zero, as much is left of it as by the fit itself."""
    _, _, measured, equations, _, found = fit
    used = equations.stacked("used")
    by_zero = np.where(used, equations.stacked("y"), 0.0)
    passive = np.flatnonzero(~measured.stacked("drives").any(axis=(0, 2)))
    left = np.where(used, found.base.y - found.predicted(), 0.0)
    for j in passive:
        zero, least = np.linalg.norm(by_zero[:, j]), np.linalg.norm(left[:, j])
        assert zero > 0.9 * least


def test_residuals_do_not_depend_on_the_scale_of_the_model(fit):
    kind, log, _, _, _, found = fit
    *_, other = fitted(kind, log, 1.1)
    passive = [j for j in range(len(found.fit.σ)) if j > 0]
    assert other.fit.σ[0] == pytest.approx(found.fit.σ[0], rel=0.02)
    assert other.fit.σ[passive] == pytest.approx(1.1 * found.fit.σ[passive], rel=0.02)


@pytest.mark.parametrize("kind", KINDS)
def test_where_nothing_is_missing_nothing_is_named(kind, tmp_path):
    logs = record(kind, 2, "a"), record(kind, 3, "b")
    found = fit_torques(read(tmp_path, kind, logs[:1], logs[1:]))
    assert found.named == ()
    final, model = found.found.unseen[2], found.found.unseen[1]
    assert (final <= 1.05 * model).all()
    assert (final < 3 * found.found.noise).all()


def test_a_spring_at_a_joint_without_a_drive_is_named_with_its_size(tmp_path):
    logs = [record("cart", s, n, extra=lambda q, v: -0.1 * q) for s, n in ((4, "a"), (5, "b"))]
    found = fit_torques(read(tmp_path, "cart", logs[:1], logs[1:]))
    first = found.named[0]
    among = {s.missing.name for s in found.found.scores if s.is_proven and s.is_like(first)}
    assert {"stiffness", "gravity_force"} & {first.missing.name, *among}


def test_a_joint_with_a_drive_is_measured_as_it_is(fit):
    _, _, measured, equations, _, _ = fit
    for name in ("bodies", "y", "a"):
        assert np.array_equal(measured.stacked(name)[:, 0], equations.stacked(name)[:, 0])
    model = mujoco.MjModel.from_xml_string(robot_of(fit[0], **TRUE))
    assert list_passive(model, measured).tolist() == [False, *[True] * (measured.joints - 1)]
