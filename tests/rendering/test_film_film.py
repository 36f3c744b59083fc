from dataclasses import replace

import imageio_ffmpeg
import numpy as np
import pytest
from PIL import Image

from identification.errors import InputError
from identification.report.page.style import MEASURED
from inca_mj.rendering.film import film, stills
from inca_mj.rendering.ghost import ghost_difference, ghost_positions
from inca_mj.rendering.legend import tension_scale
from inca_mj.rendering.view import view

pytestmark = pytest.mark.usefixtures("opengl")
SMALL = (320, 180)


def pixels(path):
    with Image.open(path) as picture:
        return np.asarray(picture, int)


def between(run, start, end):
    rows = slice(round(start * 100), round(end * 100) + 1)
    names = ("time", "currents", "qpos", "qvel", "act", "tension", "length")
    return replace(run, **{name: getattr(run, name)[rows] for name in names})


@pytest.mark.filterwarnings("ignore:unclosed file:ResourceWarning")  # imageio-ffmpeg's reader
def test_a_film_has_its_frames_its_size_and_its_rate(tmp_path, short_run):
    fps = 20
    frames = 13
    seen = []
    path = film(
        between(short_run, 0.2, 0.5), tmp_path / "run.mp4", size=SMALL, fps=fps, speed=0.5,
        progress=lambda done, total: seen.append((done, total)),
    )  # fmt: skip
    reader = imageio_ffmpeg.read_frames(path)
    about = next(reader)
    assert about["size"] == SMALL
    assert about["fps"] == fps
    assert sum(1 for _ in reader) == frames
    assert seen == [(k, frames) for k in range(1, frames + 1)]
    assert [p.name for p in tmp_path.iterdir()] == ["run.mp4"]


def test_cables_have_the_colour_of_their_tension(pulled_run):
    scale = tension_scale(pulled_run.tension)
    tension = pulled_run.tension[40].copy()
    tension[3] = 0.0
    colours = scale(tension)
    with view(pulled_run.twin.model, "front", 64, 48, cable=0.006) as seen:
        seen.begin(pulled_run.qpos[40], colours, pulled_run.qpos[0]).result()
        geoms = seen.draws.scene.geoms[: seen.draws.scene.ngeom]
        cables = [g for g in geoms if g.objtype == 18]
        assert len(cables) == 8
        np.testing.assert_allclose([g.rgba for g in cables], colours, atol=1e-6)


def test_the_measured_robot_is_an_outline_that_hides_nothing(pulled_run):
    apart = pulled_run.qpos[40].copy()
    apart[0] += 0.02
    with view(pulled_run.twin.model, "handle", 320, 240, cable=0.002) as seen:
        colours = np.ones((8, 4))
        alone = seen.begin(pulled_run.qpos[40], colours).result().astype(int)
        both = seen.begin(pulled_run.qpos[40], colours, apart).result().astype(int)
    changed = np.abs(both - alone).max(axis=2) > 30
    # It is a line: some of the picture changes, and nearly all of the orange handle is still seen.
    assert 0.002 < changed.mean() < 0.1
    orange = (alone[..., 0] > 150) & (alone[..., 0] - alone[..., 2] > 80)
    assert orange.sum() > 100
    assert changed[orange].mean() < 0.4
    blue = np.array([int(MEASURED[k : k + 2], 16) for k in (1, 3, 5)])
    strongest = both[changed][np.abs(both[changed] - blue).sum(axis=1).argmin()]
    np.testing.assert_allclose(strongest, blue, atol=12)


def test_the_readout_is_the_distance_of_the_two_robots(short_run):
    moved = short_run.qpos.copy()
    moved[:, 0] += 3e-3
    moved[:, 7:] += 0.01
    distance, turned = ghost_difference(short_run.twin, short_run.qpos, moved, True).errors.T
    np.testing.assert_allclose(distance, 3e-3, atol=1e-12)
    np.testing.assert_allclose(turned, 0.01, atol=1e-12)
    ghost = ghost_positions(short_run.twin, short_run.motor_angle, None)
    distance, turned = ghost_difference(short_run.twin, short_run.qpos, ghost, False).errors.T
    np.testing.assert_allclose(distance, 0, atol=1e-12)  # the same angles: the same pose
    np.testing.assert_allclose(turned, 0, atol=1e-12)


def test_drawing_leaves_the_twin_as_it_was(tmp_path, short_run):
    model = short_run.twin.model
    before = model.tendon_rgba.copy(), model.tendon_width.copy(), model.vis.global_.offwidth
    stills(short_run, tmp_path, [0.1], size=SMALL, plots=False)
    np.testing.assert_array_equal(model.tendon_rgba, before[0])
    np.testing.assert_array_equal(model.tendon_width, before[1])
    assert model.vis.global_.offwidth == before[2]


def test_a_film_that_fails_leaves_nothing(tmp_path, short_run):
    def stop(done, total):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        film(short_run, tmp_path / "run.mp4", size=SMALL, plots=False, progress=stop)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.filterwarnings("ignore:unclosed file:ResourceWarning")  # imageio-ffmpeg's pipes
def test_an_ffmpeg_that_does_not_work_is_one_sentence(tmp_path, short_run, monkeypatch):
    monkeypatch.setenv("IMAGEIO_FFMPEG_EXE", "/no/such/ffmpeg")
    with pytest.raises(InputError, match=r"ffmpeg cannot write the film.*IMAGEIO_FFMPEG_EXE"):
        film(short_run, tmp_path / "run.mp4", size=SMALL, plots=False)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("how", "says"),
    [
        ({"path": "nowhere/run.mp4"}, "no such folder"),
        ({"camera": "frunt"}, "did you mean 'front'"),
        ({"size": (321, 180)}, "even numbers"),
        ({"fps": 0}, "positive"),
    ],
)
def test_a_film_that_makes_no_sense_is_refused(tmp_path, short_run, how, says):
    how = {"size": SMALL, **how}
    with pytest.raises(InputError, match=says):
        film(short_run, tmp_path / how.pop("path", "run.mp4"), **how)
    assert list(tmp_path.iterdir()) == []
