"""Workspaces: lockstep with linear programs, monotonic, symmetric, and a volume with its error."""

import numpy as np
import pytest
from statics_cases import ROBOT, possible, random_poses

from inca_mj.kinematics.cables import inverse
from inca_mj.rendering.workspace_picture import surface
from inca_mj.robot.geometry import INCA
from inca_mj.statics.closure import split, wrench_margin
from inca_mj.statics.workspace import NAMES, DriveLimits, margin, tension_limits, workspace

LIMITS = DriveLimits()


def test_one_wrench_is_feasible_exactly_where_a_linear_program_says_so():
    poses = random_poses(150)
    at = inverse(poses, INCA)
    low, high = tension_limits(ROBOT, at.lengths, LIMITS)
    found = wrench_margin(*split(at.W), low, high, ROBOT.weight)
    clear = np.flatnonzero(np.abs(found) > 1e-6)
    assert 10 < (found > 0).sum() < 130
    for k in clear:
        assert possible(at.W[k], ROBOT.weight, low[k], high[k]) == (found[k] > 0)


def test_the_margin_of_a_set_is_the_least_over_its_wrenches():
    rng = np.random.default_rng(1)
    directions = rng.normal(size=(6000, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    for pose in random_poses(4, across=0.5):
        at = inverse(np.tile(pose, (1, 1)), INCA)
        parts = split(at.W)
        whole = wrench_margin(*parts, 0.5, 12.0, ROBOT.weight, force=2.0)[0]
        each = [
            wrench_margin(*parts, 0.5, 12.0, ROBOT.weight + np.r_[2.0 * u, 0, 0, 0])[0]
            for u in directions[:600]
        ]
        assert whole <= min(each) + 1e-9
        assert min(each) - whole < 0.05 * 2.0 * 3  # the nearest of 600 directions is that near


def test_wider_limits_and_smaller_loads_make_larger_workspaces():
    poses = random_poses(2000)
    wide = DriveLimits(current=(-3.0, 3.0), taut=0.2)
    light = DriveLimits(force=0.5, torque=0.01)
    for kind in ("feasible", "static"):
        usual = margin(kind, ROBOT, poses, LIMITS)
        assert (margin(kind, ROBOT, poses, wide) >= usual - 1e-9).all()
        assert (margin(kind, ROBOT, poses, light) >= usual - 1e-9).all()
    closed, static, feasible = (margin(k, ROBOT, poses, LIMITS) > 0 for k in
                                ("closure", "static", "feasible"))  # fmt: skip
    assert (static[feasible]).all()  # the set contains the weight alone
    bound = DriveLimits(current=(-1e4, 1e4), taut=0.0)
    assert (margin("feasible", ROBOT, poses, bound)[closed] > 0).mean() > 0.99


@pytest.mark.parametrize("kind", NAMES)
def test_a_symmetric_robot_has_a_symmetric_workspace(kind):
    field = workspace(kind, ROBOT, cells=10).margin
    for axis in (0, 1):  # the layout is its own mirror image in x and in y
        np.testing.assert_allclose(np.flip(field, axis), field, atol=1e-7)
    turned = [workspace(kind, ROBOT, (0, 0, yaw), cells=10).margin for yaw in (0.2, -0.2)]
    np.testing.assert_allclose(np.flip(turned[0], 0), turned[1], atol=1e-7)


def test_the_volume_is_right_to_its_standard_error():
    coarse = [workspace("closure", ROBOT, cells=8, seed=k) for k in range(12)]
    fine = workspace("closure", ROBOT, cells=20)
    volumes, errors = np.array([w.volume for w in coarse]), np.array([w.std for w in coarse])
    assert np.abs(volumes.mean() - fine.volume) < 4 * np.hypot(errors.mean() / 12**0.5, fine.std)
    # std of twelve values, which itself is known to 21 %
    assert 0.4 < volumes.std(ddof=1) / errors.mean() < 1.8


def test_poses_of_a_workspace_are_those_inside():
    found = workspace("static", ROBOT, (0.1, 0, 0.05), cells=8)
    assert len(found.poses) == found.inside.sum() > 0
    assert (margin("static", ROBOT, found.poses, LIMITS) > 0).all()


def _ball(points):
    axis = np.linspace(-1.2, 1.2, points)
    x, y, z = np.meshgrid(axis, axis, axis, indexing="ij")
    vertices, faces = surface((axis, axis, axis), 1 - np.sqrt(x**2 + y**2 + z**2))
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return vertices, faces, float((a * np.cross(b, c)).sum() / 6)


def test_the_surface_of_a_ball_is_closed_looks_outwards_and_converges():
    errors = []
    for points in (12, 23):
        vertices, faces, volume = _ball(points)  # by Gauss, so a hole or a turned face would show
        errors.append(abs(volume - 4 / 3 * np.pi))
        edges = np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
        forth = {tuple(edge) for edge in edges.tolist()}
        assert len(forth) == len(edges)
        assert all((b, a) in forth for a, b in forth)
        assert np.abs(np.linalg.norm(vertices, axis=1) - 1).max() < 2.4 / points
    assert errors[1] < errors[0] / 2.5
    assert errors[1] < 0.02 * 4 / 3 * np.pi
