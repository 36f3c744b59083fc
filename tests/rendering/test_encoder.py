"""What is said of a film that ends before its first frame."""

import subprocess
import sys

END = """
import sys
from pathlib import Path
from inca_mj.rendering.encoder import encoder
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
