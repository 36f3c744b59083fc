import os
import subprocess
import sys

import pytest

from identification.errors import GraphicsError
from inca_mj.rendering import graphics

LINUX = sys.platform.startswith("linux")
pytestmark = pytest.mark.skipif(not LINUX, reason="backends are chosen on Linux only")

DRAW = """
import sys
from identification.errors import GraphicsError
from inca_mj.rendering.graphics import choose_backend, renderer
assert "mujoco" not in sys.modules
try:
    choose_backend()
    import mujoco
    model = mujoco.MjModel.from_xml_string("<mujoco/>")
    for again in range(2):
        try:
            with renderer(model, 16, 8) as draws:
                sys.stdout.write(f"{draws.render().shape}")
        except GraphicsError as error:
            sys.stdout.write(f"[{error}]")
except GraphicsError as error:
    sys.stdout.write(f"[{error}]")
"""


@pytest.fixture
def headless(monkeypatch):
    for name in ("MUJOCO_GL", "DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(graphics, "_rebind", lambda backend: None)
    monkeypatch.setattr(graphics, "_require", lambda *names: None)
    return monkeypatch


def draw(*before, code=DRAW, **environment):
    hidden = ("MUJOCO_GL", "DISPLAY", "WAYLAND_DISPLAY")
    clean = {k: v for k, v in os.environ.items() if k not in hidden}
    return subprocess.run(
        [sys.executable, *before, "-c", code], env={**clean, **environment}, capture_output=True,
        text=True, timeout=60, check=False,
    )  # fmt: skip


def test_without_a_display_the_backend_is_egl(headless):
    assert graphics.choose_backend() == "egl" == os.environ["MUJOCO_GL"]


def test_egl_without_opengl_is_refused_before_mujoco_dies_of_it(monkeypatch):
    monkeypatch.setenv("MUJOCO_GL", "egl")
    monkeypatch.setattr(
        "ctypes.util.find_library", lambda name: "libc.so.6" if name == "EGL" else None
    )
    with pytest.raises(GraphicsError, match=r"libOpenGL and libGL are missing.*libopengl0"):
        graphics.choose_backend()


def test_a_fresh_process_draws(opengl):
    done = draw()
    assert done.stdout == 2 * "(8, 16, 3)"
    assert (done.returncode, done.stderr) == (0, "")


def test_without_a_driver_every_try_gives_one_sentence(opengl):
    # A second try must not reach MuJoCo, which may abort the process then.
    done = draw(MUJOCO_GL="egl", __EGL_VENDOR_LIBRARY_FILENAMES="/nowhere.json")
    if "(8, 16, 3)" in done.stdout:
        pytest.skip("this machine's libEGL takes its driver from elsewhere")
    assert done.returncode == 0
    assert done.stdout.count("everything that does not draw still works") == 2
    assert "Traceback" not in done.stderr


def test_mujoco_imported_before_can_still_draw(opengl):
    done = draw("-W", "ignore", code="import mujoco\n" + DRAW.replace("assert", "0,"))
    assert done.stdout == 2 * "(8, 16, 3)"
