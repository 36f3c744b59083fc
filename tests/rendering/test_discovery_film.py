"""The film of a discovery shows seconds that no fit has seen."""

import subprocess
import sys
from dataclasses import replace

import fake_discovery
import numpy as np
import pytest
from PIL import Image
from statics_cases import ROBOT

from identification.errors import InputError
from identification.runtime.progress import duration
from inca_mj.commands.film import FIRST, FilmProgress
from inca_mj.commands.filmed import FILMED, film_discovery, filmed_seconds
from inca_mj.rendering.workspace_picture import workspace_picture
from inca_mj.robot.geometry import INCA
from inca_mj.robot.parameters import parameter_set
from inca_mj.statics.workspace import DriveLimits, workspace


@pytest.mark.parametrize(
    ("splits", "seconds"),
    [({}, (0.5, 0.99)), ({"estimation": (0.0, 0.3), "validation": (0.3, 1.0)}, (0.3, 0.99))],
)
def test_the_first_unseen_seconds_are_filmed(splits, seconds):
    log = replace(fake_discovery.log(), splits=splits)
    long = replace(
        log,
        time=10 * log.time,
        splits={name: (10 * a, 10 * b) for name, (a, b) in splits.items()},
    )  # fmt: skip
    begin, end = filmed_seconds(long)
    assert begin == pytest.approx(10 * seconds[0], abs=0.11)
    assert end <= long.time[-1]
    assert end - begin <= FILMED
    fitted = (long.splits or {"estimation": (0.0, 5.0)})["estimation"]
    assert begin >= fitted[1] - 1e-9


@pytest.mark.usefixtures("opengl")
def test_both_models_are_filmed_and_the_section_says_when(tmp_path, monkeypatch):
    monkeypatch.setattr("inca_mj.commands.filmed.FPS", 4)
    section = film_discovery(fake_discovery.found(), tmp_path)
    assert section.video.exists()
    assert section.first
    assert "which was fitted" in section.text  # half a second is left, too little for a film
    begin, end = filmed_seconds(fake_discovery.log())
    assert f"{begin:.4g} to {end:.4g}" in section.title
    with Image.open(section.poster) as picture:
        pixels = np.asarray(picture, int)
    left, right = pixels[:, :640], pixels[:, 640:]
    assert np.abs(left - right).max() > 60  # two models, two pictures


def told(frames, seconds, begin=60.0, lines=True):
    """The lines of a film whose first frame takes `begin` and every other `seconds`."""
    said, now = [], [0.0]
    progress = FilmProgress(said.append, 30.0, lines, lambda: now[0])
    for done in range(1, frames + 1):
        now[0] += begin if done == 1 else seconds
        progress(done, frames)
    return said


def test_it_says_the_length_first_and_then_the_time_by_the_first_frames():
    first, second, *_ = told(600, 0.5)
    assert first == "film: 600 frames, 20 s of film"
    left = 0.5 * (600 - FIRST - 1)  # [s]; what the renderer took to begin is not counted
    assert second == f"film: 600 frames, about {duration(left)} to draw"


END = """
import sys
from pathlib import Path
from inca_mj.rendering.film import encoder
try:
    with encoder(Path(sys.argv[1]), (64, 64), 30.0):
        raise KeyboardInterrupt
except KeyboardInterrupt:
    print("ended")
"""


def test_an_interrupt_before_the_first_frame_says_nothing_of_the_library(tmp_path):
    line = [sys.executable, "-c", END, str(tmp_path / "film.mp4")]
    done = subprocess.run(line, capture_output=True, text=True, check=False)
    assert (done.stdout, done.stderr) == ("ended\n", "")


FULL = """
import resource, signal, sys
from pathlib import Path
import numpy as np
from inca_mj.rendering.film import encoder
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[2]), int(sys.argv[2])))
rng = np.random.default_rng(0)
with encoder(Path(sys.argv[1]), (320, 180), 30) as send:
    for _ in range(10):
        send(rng.integers(0, 255, (180, 320, 3), np.uint8))
"""


def test_a_disk_that_is_full_behind_the_last_frame_is_told(tmp_path):
    line = [sys.executable, "-c", FULL, str(tmp_path / "film.mp4"), "50_000"]
    done = subprocess.run(line, capture_output=True, text=True, check=False)
    assert done.returncode != 0
    assert "ffmpeg cannot write the film" in done.stderr


TRIAL = parameter_set("trial")
SIZE = (240, 180)


def _blue(path):
    """How many pixels are much bluer than red."""
    with Image.open(path) as image:
        assert image.size == SIZE
        picture = np.asarray(image.convert("RGB"), int)
    return ((picture[..., 2] - picture[..., 0]) > 40).sum()


def test_a_larger_workspace_covers_more_of_the_picture(opengl, tmp_path):
    large = workspace("closure", ROBOT, cells=8)
    small = workspace("feasible", ROBOT, cells=8, limits=DriveLimits(force=3.0, torque=0.1))
    pixels = [
        _blue(workspace_picture(w, tmp_path / f"{w.kind}.png", TRIAL, INCA, size=SIZE))
        for w in (large, small)
    ]
    assert pixels[0] > 1.5 * pixels[1] > 0


def test_an_empty_workspace_is_refused(tmp_path):
    nothing = workspace("feasible", ROBOT, cells=8, limits=DriveLimits(force=500.0))
    assert nothing.volume == 0
    with pytest.raises(InputError, match="no point of the grid lies in the wrench-feasible"):
        workspace_picture(nothing, tmp_path / "a.png", TRIAL, INCA)
    assert not (tmp_path / "a.png").exists()
