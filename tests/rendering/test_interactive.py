"""The viewer where there is a screen, and the sentence where there is none."""

from contextlib import nullcontext

import mujoco
import numpy as np
import pytest

from inca_mj.cli import main
from inca_mj.rendering.interactive import play


class Window:
    """Stands in for the handle of MuJoCo's viewer: open for so many frames."""

    def __init__(self, data, frames):
        self.data, self.left, self.shown = data, frames, []

    def is_running(self):
        self.left -= 1
        return self.left >= 0

    def lock(self):
        return nullcontext()

    def sync(self):
        self.shown.append((self.data.time, self.data.qpos.copy(), self.data.ten_length.copy()))


def test_a_run_is_played_in_time_and_again(short_run):
    """At half speed, 0.4 s a frame: samples 0, 20, 40, 60, 80, and from the start again."""
    now = iter(np.arange(20) * 0.4 + 100.0)
    data = mujoco.MjData(short_run.twin.model)
    window = Window(data, 7)
    play(short_run, data, window, 0.5, clock=lambda: float(next(now)), sleep=lambda _: None)
    times = [time for time, _, _ in window.shown]
    assert times[:4] == pytest.approx([0.2, 0.4, 0.6, 0.8], abs=0.0101)
    assert times[5] < times[4] or times[4] < times[3]
    for time, qpos, length in window.shown:
        k = round(100 * time)
        np.testing.assert_array_equal(qpos, short_run.qpos[k])
        np.testing.assert_allclose(length, short_run.length[k], rtol=1e-12)


@pytest.fixture
def no_screen(monkeypatch):
    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)


def test_without_a_screen_it_says_so_in_one_sentence(no_screen, capsys):
    for arguments in ([], ["--plain"], ["examples/log.csv"]):
        assert main(["view", *arguments]) == 2
        said = capsys.readouterr()
        assert said.out == ""
        (line,) = said.err.splitlines()
        assert "no screen for the viewer" in line
        assert "inca film draws without a screen" in line
