"""A film of a run that was asked to follow a path, and of two robots side by side."""

import json
from dataclasses import replace

import mujoco
import numpy as np
import pytest
from PIL import Image

from identification.errors import InputError
from inca_mj.cli import main
from inca_mj.rendering.film import film, stills
from inca_mj.rendering.legend import ASKED, TRACE
from inca_mj.rendering.overlay import LAST, MAGNIFY, Eye, Line, overlay, trace_of
from inca_mj.rendering.scene import make_scene
from inca_mj.rendering.view import view
from inca_mj.twin.run import save_run

SIZE = (320, 240)
PAIR = (2 * SIZE[0], SIZE[1])


def pixels(path):
    with Image.open(path) as picture:
        return np.asarray(picture, int)


def asked(run, error):
    """The run, asked to be elsewhere by an error of shape (3,) or (N, 3) [m]."""
    return replace(run, asked=run.position - error)


def of(lines, colour):
    return [line.corners for line in lines if line.colour == colour]


def test_the_trace_of_a_run_that_follows_exactly_lies_on_the_asked_path(short_run):
    trace = trace_of(asked(short_run, np.zeros(3)))
    lines = trace.lines(0.8, 1.0)
    (path,) = of(lines, ASKED)
    assert trace.distance(0.8) == 0
    for corners in of(lines, TRACE):
        for corner in corners:
            begin, along = path[:-1], np.diff(path, axis=0)
            part = np.einsum("ij,ij->i", corner - begin, along) / np.sum(along**2, axis=1)
            foot = begin + np.clip(part, 0, 1)[:, None] * along
            assert np.linalg.norm(corner - foot, axis=1).min() < 1e-12
    assert trace_of(short_run) is None


def test_the_trace_is_off_the_path_by_the_error_as_often_as_is_said(short_run):
    magnify = MAGNIFY
    error = np.array([0.001, -0.002, 0.002])
    trace = trace_of(asked(short_run, error), magnify)
    now, back = of(trace.lines(0.5, 1.0), TRACE)[::-1]
    np.testing.assert_allclose(now[1] - now[0], magnify * error, atol=1e-15)
    np.testing.assert_array_equal(back[-1], now[1])
    assert trace.distance(0.123) == pytest.approx(0.003, rel=1e-12)


def test_a_trace_is_of_the_last_seconds(short_run):
    stretched = replace(asked(short_run, np.zeros(3)), time=20 * short_run.time)
    trace = trace_of(stretched)
    (corners, _) = of(trace.lines(12.0, 1.0), TRACE)
    first = np.searchsorted(stretched.time, 12.0 - LAST - 1e-9)
    np.testing.assert_array_equal(corners[0], stretched.position[first])


@pytest.mark.usefixtures("opengl")
def test_a_point_is_drawn_where_mujoco_draws_a_ball(short_run):
    camera = "handle"
    qpos, white = short_run.qpos[60], np.ones((8, 4))
    point = qpos[:3] + [0.02, 0.03, 0.06]
    with view(short_run.twin.model, camera, 200, 150, cable=0.001) as seen:
        without = seen.begin(qpos, white).result().astype(int)
        scene = seen.draws.scene
        ball = scene.geoms[scene.ngeom]
        mujoco.mjv_initGeom(
            ball, mujoco.mjtGeom.mjGEOM_SPHERE, np.full(3, 0.02 if camera == "handle" else 0.06),
            point, np.eye(3).ravel(), np.array([0, 1, 0, 1.0]),
        )  # fmt: skip
        scene.ngeom += 1
        with_ball = seen.thread.submit(seen.draws.render).result()
        changed = np.abs(with_ball.astype(int) - without).max(axis=2) > 60
        ((column, row),) = seen.eye().pixels(point[None], (200, 150))
    rows, columns = np.nonzero(changed)
    assert len(rows) > 10
    assert columns.mean() + 0.5 == pytest.approx(column, abs=1.0)
    assert rows.mean() + 0.5 == pytest.approx(row, abs=1.0)


def test_what_is_behind_the_camera_is_not_drawn_and_the_rest_is():
    eye, blank = Eye(np.zeros(3), np.eye(3), 1.0), np.zeros((60, 80, 3), np.uint8)
    before, behind = np.array([-0.1, 0.0, -1.0]), np.array([0.1, 0.0, 1.0])
    right = np.array([0.1, 0.0, -1.0])

    def drawn(*corners):
        return np.flatnonzero(
            overlay(blank, [Line(np.array(corners), "#FFFFFF", 2)], eye).max((0, 2))
        )

    assert not len(drawn(behind, before))
    both = drawn(before, right)
    np.testing.assert_array_equal(drawn(behind, before, right, behind, before), both)
    f = 60 / (2 * np.tan(0.5))
    assert both[0] == pytest.approx(40 - 0.1 * f, abs=1)
    assert both[-1] == pytest.approx(40 + 0.1 * f, abs=1)


@pytest.mark.usefixtures("opengl")
def test_two_pictures_are_the_single_ones_side_by_side(tmp_path, short_run):
    """To the pixel, where both have the tensions of the scale that they share."""
    one, two = asked(short_run, np.array([0.001, 0, 0])), short_run
    size = (220, 320)
    single = {"size": size, "plots": False}
    both = {**single, "size": (2 * size[0], size[1])}
    (pair,) = stills(one, tmp_path, [0.5], beside=two, titles=("one", "two"), **both)
    pair = pixels(pair)
    for k, (run, title) in enumerate(((one, "one"), (two, "two"))):
        (alone,) = stills(run, tmp_path, [0.5], titles=(title,), **single)
        np.testing.assert_array_equal(pair[:, k * size[0] :][:, : size[0]], pixels(alone))
    assert not np.array_equal(pair[:, : size[0]], pair[:, size[0] :])


@pytest.mark.parametrize(
    ("how", "says"),
    [({"later": True}, "no common time"), ({"size": (300, 240)}, "300 pixels for two")],
)
def test_a_pair_that_makes_no_sense_is_refused(tmp_path, short_run, how, says):
    how = dict(how)
    later = how.pop("later", False)
    beside = replace(short_run, time=short_run.time + 1.0) if later else short_run
    with pytest.raises(InputError, match=says):
        film(short_run, tmp_path / "pair.mp4", beside=beside, **{"size": PAIR, **how})
    assert list(tmp_path.iterdir()) == []


@pytest.mark.usefixtures("opengl")
def test_the_command_films_two_runs_under_the_names_of_their_folders(tmp_path, capsys, short_run):
    sources = []
    for name, end in (("nominal", 0.02), ("found", 0.04)):
        (tmp_path / name).mkdir()
        run = asked(short_run.between(0.0, end), np.zeros(3))
        sources.append(str(save_run(run, tmp_path / name / "run.npz")))
    out, look = tmp_path / "film", ("--camera", "handle")
    assert main(["film", *sources, "--still", "0", *look, "--json", "--out", str(out)]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["titles"] == ["nominal", "found"]
    assert said["seconds"] == pytest.approx(0.02)
    made = [said["film"], *said["stills"]]
    assert made == [str(out / "film.mp4"), str(out / "handle_0.00s.png")]
    assert pixels(made[1]).shape == (720, 1280, 3)
    kept = json.loads((out / "result.json").read_text())
    assert (kept["film"], kept["stills"]) == ("film.mp4", ["handle_0.00s.png"])
    assert (kept["seconds"], kept["titles"]) == (said["seconds"], said["titles"])
    assert kept["configuration"]["camera"] == "handle"
    assert main(["film", *sources, "--still", "0.03"]) == 2
    assert "the film is of 0 to 0.02 s" in capsys.readouterr().err


def test_a_scene_of_a_saved_run_keeps_what_was_asked(tmp_path, short_run):
    run = asked(short_run, np.array([0.001, 0.0, 0.0]))
    scene = make_scene(save_run(run, tmp_path / "run.npz"), 0.25)
    np.testing.assert_array_equal(scene.run.asked, run.asked[:26])
