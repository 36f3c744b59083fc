"""Views, frames, outlines and poses that are made together are those that are made one by one."""

import threading

import numpy as np
import pytest
from PIL import Image, ImageChops, ImageDraw, ImageFilter

from identification.errors import GraphicsError
from inca_mj.kinematics import stiff
from inca_mj.kinematics.cables import cables_at
from inca_mj.kinematics.forward import find
from inca_mj.kinematics.rotations import euler_of, rotation
from inca_mj.rendering import graphics
from inca_mj.rendering.film import _in_turn
from inca_mj.rendering.outline import Outline, draw_outline
from inca_mj.rendering.scene import Scene
from inca_mj.rendering.stage import Look, stage
from inca_mj.robot.geometry import INCA

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


@pytest.mark.parametrize(
    ("samples", "speed"), [(1, 1.0), (16, 0.3), (17, 2.0), (150, 1.0), (60, 9.0)]
)
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


def test_samples_that_steps_at_once_do_not_reach_are_searched_for_in_turn(monkeypatch):
    angles, poses = angles_along(40, 0.4, np.random.default_rng(3))
    searched = []
    monkeypatch.setattr(stiff, "_settle", lambda lengths, *_: [*range(1, 40, 3)])
    whole = stiff._searched
    monkeypatch.setattr(
        stiff, "_searched", lambda lengths, k, *rest: searched.append(k) or whole(lengths, k, *rest)
    )
    found = stiff.poses_with_stiff_cables(angles, 0.02, START, INCA)
    assert searched == [0, 16, 32, *range(1, 40, 3)]
    np.testing.assert_allclose(found[1::3], poses[1::3], atol=1e-7)


@pytest.mark.parametrize("width", [1.0, 1.5, 3.0])
def test_an_outline_in_parts_is_that_of_the_whole_picture(width):
    """Larger less smaller of all shapes together, by the filters of Pillow."""
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


@pytest.mark.parametrize("backend", ["egl", "glfw"])
def test_an_error_of_the_drawing_thread_is_met_where_the_picture_is_asked_for(monkeypatch, backend):
    """A window may be used in the main thread only, so that there nothing has another thread."""
    monkeypatch.setattr(graphics, "choose_backend", lambda: backend)

    def fail():
        raise GraphicsError(threading.current_thread().name)

    with graphics.drawing_thread() as thread:
        assert thread.submit(divmod, 7, 2).result() == (3, 1)
        with pytest.raises(GraphicsError, match="drawing" if backend == "egl" else "MainThread"):
            thread.submit(fail).result()
