import threading
from dataclasses import replace
from math import inf
from pathlib import Path

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image, ImageChops, ImageDraw, ImageFilter
from scipy.spatial.transform import Rotation

from identification.errors import InputError
from identification.report.page.style import MEASURED
from inca_mj.kinematics import stiff
from inca_mj.kinematics.cables import cables_at
from inca_mj.kinematics.forward import find
from inca_mj.kinematics.rotations import euler_of, rotation
from inca_mj.kinematics.stiff import poses_with_stiff_cables
from inca_mj.rendering.film import _in_turn, stills
from inca_mj.rendering.ghost import ROOM, Difference, common_factor, ghost_positions
from inca_mj.rendering.legend import ROBOT
from inca_mj.rendering.outline import Outline, draw_outline
from inca_mj.rendering.scene import Scene, make_scene
from inca_mj.rendering.stage import Look, stage
from inca_mj.robot.geometry import INCA
from inca_mj.twin.logs import read_inca_log
from inca_mj.workflows.comparison import compare


def test_the_ghost_of_simulated_angles_is_the_simulated_robot(short_run):
    robot = short_run.twin
    R, begin = robot.parameters.values()["R"], np.array(robot.start.pose)
    poses = poses_with_stiff_cables(short_run.motor_angle, R, begin, robot.geometry)
    # A millimetre: the strain that the ghost neglects is a tenth of that.
    np.testing.assert_allclose(poses[:, :3], short_run.position, atol=1e-3)
    np.testing.assert_allclose(poses[:, 3:], short_run.angles, atol=1e-2)
    assert np.ptp(short_run.position[:, 2]) > 0.02


def test_a_measured_pose_is_used_as_it_is(short_run):
    poses = np.hstack([short_run.position, short_run.angles])
    positions = ghost_positions(short_run.twin, short_run.motor_angle, poses)
    turns = np.abs((positions[:, 3:7] * short_run.qpos[:, 3:7]).sum(axis=1))
    np.testing.assert_allclose(turns, 1, atol=1e-12)
    np.testing.assert_allclose(positions[:, :3], short_run.position, atol=0)
    np.testing.assert_allclose(positions[:, 7:], short_run.motor_angle, atol=0)


def test_angles_that_no_pose_comes_near_are_refused_at_their_first_sample(short_run):
    """Each sample would take all steps of the search: of 4700 rad a film never ended."""
    angles = 200.0 * short_run.motor_angle
    angles[-1] = 4700.0
    with pytest.raises(InputError, match=r"of sample \d+ give: .* check the unit of the angles"):
        ghost_positions(short_run.twin, angles, None)


LOG = Path(__file__).parents[2] / "examples" / "log.csv"


def same(one, two):
    np.testing.assert_array_equal(one.run.qpos, two.run.qpos)
    np.testing.assert_array_equal(one.angles, two.angles)


def test_a_log_its_file_and_its_comparison_are_one_scene():
    log = read_inca_log(LOG)
    short = log.between(0.0, 0.5)
    from_log = make_scene(short)
    same(from_log, make_scene(compare(short)))
    same(make_scene(log, 0.3), make_scene(LOG, 0.3))
    same(make_scene(log, 0.3), from_log.between(0.0, float(from_log.run.time[29])))
    assert make_scene(from_log) is from_log


def test_a_log_that_is_wired_in_another_way_is_drawn_as_it_is():
    log = read_inca_log(LOG).between(0.0, 4.0)
    wrong = replace(log, outputs=-log.outputs)
    with pytest.raises(InputError, match="turn the sign"):
        compare(wrong)
    np.testing.assert_array_equal(make_scene(wrong).angles, wrong.outputs)


START = np.array([0.02, -0.01, 1.3, 0.05, -0.02, 0.3])


def angles_along(samples, speed, rng):
    """Angles of a platform that moves and turns smoothly, and poses; stiff cables, R of 0.02 m."""
    t = np.linspace(0.0, 1.0, samples)[:, None]
    waves = np.sin(2 * np.pi * (speed * t + rng.uniform(size=6))) - np.sin(
        2 * np.pi * rng.uniform(size=6)
    )
    poses = START + 0.06 * (waves - waves[0])
    at = [cables_at(p[:3], rotation(*p[3:]), INCA).lengths for p in poses]
    return (at[0] - np.array(at)) / 0.02, poses


@pytest.mark.parametrize(("samples", "speed"), [(1, 1.0), (17, 2.0), (60, 9.0)])
def test_poses_of_all_samples_at_once_are_those_of_one_search_after_the_other(samples, speed):
    angles, poses = angles_along(samples, speed, np.random.default_rng(samples))
    found = stiff.poses_with_stiff_cables(angles, 0.02, START, INCA)
    at = START[:3], rotation(*START[3:])
    lengths = cables_at(*at, INCA).lengths - 0.02 * angles
    for k in range(samples):
        position, turned, last = find(lengths[k], INCA, at, np.ones(8), tolerance=stiff.FINE)
        at = position, turned
        assert last < stiff.FINE
        # The last step is below 1e-7, and a step of Newton's method squares what is left.
        np.testing.assert_allclose(found[k], [*position, *euler_of(turned)], atol=1e-7)
    np.testing.assert_allclose(found, poses, atol=1e-7)


def test_an_outline_in_parts_is_that_of_the_whole_picture():
    """Larger less smaller of all shapes together, by the filters of Pillow."""
    width = 1.5
    rng, size = np.random.default_rng(1), (90, 70)
    centres = rng.uniform(-10, 100, (12, 2))
    shapes = tuple(c + rng.uniform(-9, 9, (4, 2)) for c in centres)
    picture = rng.integers(0, 255, (*size[::-1], 3), np.uint8)
    drawn = draw_outline(picture, Outline(shapes, ()), "#0072B2", width)
    fine = Image.new("L", (3 * size[0], 3 * size[1]))
    pen = ImageDraw.Draw(fine)
    for shape in shapes:
        pen.polygon([*map(tuple, (3 * shape).tolist())], fill=255)
    window = 2 * max(1, round(3 * width / 2)) + 1
    wide, thin = (
        fine.filter(ImageFilter.MaxFilter(window)),
        fine.filter(ImageFilter.MinFilter(window)),
    )
    expected = Image.fromarray(picture)
    expected.paste("#0072B2", (0, 0), ImageChops.subtract(wide, thin).reduce(3))
    right = np.asarray(expected).astype(int)
    # A corner on the border of two pixels may fall to either, as rounding has it.
    apart = np.abs(drawn.astype(int) - right).max(axis=2) > 0
    assert apart.mean() < 0.005
    assert (np.abs(right - picture).max(axis=2) > 0).mean() > 0.03


@pytest.mark.usefixtures("opengl")
def test_frames_drawn_ahead_are_those_drawn_alone(short_run):
    scenes = [Scene(short_run, short_run.motor_angle + 0.01), Scene(short_run)]
    look = Look(camera="front", size=(400, 240), plots=False, titles=(), magnify=20.0)
    times = [0.1, 0.5, 0.9]
    with stage(scenes, look) as begin:
        ahead = [*_in_turn(begin, times)]
        alone = [begin(time)() for time in times]
        assert threading.active_count() > 1
    np.testing.assert_array_equal(ahead, alone)
    assert np.abs(ahead[0].astype(int) - ahead[1]).max() > 0
    assert not [t for t in threading.enumerate() if t.name.startswith("drawing")]


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
