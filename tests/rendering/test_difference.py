"""The close view of two films draws how far the measured robot is off so many times as it says."""

from math import inf

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image
from scipy.spatial.transform import Rotation

from identification.report.style import MEASURED
from inca_mj.rendering.film import stills
from inca_mj.rendering.ghost import ROOM, Difference, common_factor
from inca_mj.rendering.legend import ROBOT
from inca_mj.rendering.scene import Scene

TURN = np.array([0.004, -0.01, 0.02])


def positions(place, turn=(0.0, 0.0, 0.0)):
    quaternion = Rotation.from_rotvec(turn).as_quat(scalar_first=True)
    return np.hstack([place, quaternion, np.zeros(8)])[None]


def moved_by(*distances):
    begin = positions(np.zeros(3))
    return [Difference(begin, begin, positions([d, 0.0, 0.0])) for d in distances]


def test_a_difference_is_enlarged_in_place_and_in_turn():
    simulated = positions([0.1, 0.2, 1.4], [0.3, 0.1, -0.2])
    measured = positions([0.101, 0.2, 1.398])
    measured[:, 3:7] = (
        Rotation.from_rotvec(TURN) * Rotation.from_quat(simulated[:, 3:7], scalar_first=True)
    ).as_quat(scalar_first=True)
    off = Difference(simulated, simulated, measured)
    np.testing.assert_allclose(off.enlarged(0.0)[:, :7], simulated[:, :7], atol=1e-12)
    np.testing.assert_allclose(off.enlarged(1.0)[:, :7], measured[:, :7], atol=1e-12)
    far = Difference(simulated, simulated, off.enlarged(20.0))
    np.testing.assert_allclose(far.moved, 20 * off.moved, atol=1e-12)
    np.testing.assert_allclose(far.turned, 20 * TURN[None], atol=1e-9)


def test_what_both_poses_neglect_is_no_difference():
    """Poses from angles neglect that cables stretch; so do both that are compared."""
    simulated, own = positions([0.0, 0.0, 1.4]), positions([0.0, 0.0, 1.41])
    same = Difference(simulated, own, own)
    np.testing.assert_allclose(same.enlarged(100.0)[:, :7], simulated[:, :7], atol=1e-12)


@given(st.lists(st.floats(0, 1) | st.floats(1e-6, 1e-2), min_size=1, max_size=3))
def test_the_factor_is_round_and_the_largest_that_has_room(distances):
    k, largest = common_factor(moved_by(*distances)), max(distances)
    assert f"{k:g}".rstrip("0") in ("1", "2", "5")
    assert k == 1 or k * largest <= ROOM * (1 + 1e-12)
    larger = {"1": 2.0, "2": 2.5, "5": 2.0}[f"{k:g}"[0]] * k
    assert larger > 1000 or larger * largest > ROOM or largest == inf


@pytest.mark.usefixtures("opengl")
def test_a_millimetre_is_seen_in_the_close_view_of_two_films(tmp_path, short_run):
    pose = np.hstack([short_run.position, short_run.angles])
    right = Scene(short_run, short_run.motor_angle, pose)
    left = Scene(short_run, short_run.motor_angle, pose + [0, 0, 0.001, 0, 0, 0])
    (path,) = stills(left, tmp_path, [0.5], beside=right)
    with Image.open(path) as picture:
        low = np.asarray(picture, int)[450:]  # the close view, under its caption
    is_outline = np.abs(low - [int(MEASURED[k : k + 2], 16) for k in (1, 3, 5)]).sum(axis=2) < 40
    halves = np.split(is_outline, 2, axis=1)
    rows = [np.nonzero(half[:, 280:360])[0] for half in halves]  # without drums far behind
    assert min(map(len, rows)) > 100
    assert np.max(rows[1]) - np.max(rows[0]) > 30  # a millimetre itself is one pixel


def test_the_legend_names_every_colour_of_the_robot(short_run):
    model = short_run.twin.model
    solid = model.geom_type != int(mujoco.mjtGeom.mjGEOM_PLANE)
    drawn = {tuple(c) for c in np.round(255 * model.geom_rgba[solid, :3]).astype(int).tolist()}
    named = {tuple(bytes.fromhex(c[1:])) for entry in ROBOT for c in entry.colours}
    assert named == drawn
