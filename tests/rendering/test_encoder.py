"""What is said of a film that ends before its first frame."""

import subprocess
import sys

import pytest

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


@pytest.mark.parametrize(("room", "is_enough"), [(50_000, False), (50_000_000, True)])
def test_a_disk_that_is_full_behind_the_last_frame_is_told(tmp_path, room, is_enough):
    line = [sys.executable, "-c", FULL, str(tmp_path / "film.mp4"), str(room)]
    done = subprocess.run(line, capture_output=True, text=True, check=False)
    assert (done.returncode == 0) is is_enough
    assert ("ffmpeg cannot write the film" in done.stderr) is not is_enough
