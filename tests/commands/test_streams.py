"""Closed and full streams, strict encodings and warnings change no exit code and end no program."""

import json
import os
import subprocess
import sys

import pytest
from robot_cases import write_slider

pytestmark = pytest.mark.skipif(os.name != "posix", reason="streams of POSIX")
STRICT = {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0",
          "PYTHONIOENCODING": "ascii:strict"}  # fmt: skip


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with a robot that reads quickly, and a log of it."""
    folder = tmp_path_factory.mktemp("robot")
    write_slider(folder)
    return folder


def shell(folder, line, **environment):
    """What a line of a shell says on stdout and stderr, and its exit code; `P` is the program."""
    program = f"{sys.executable} -m identification"
    done = subprocess.run(
        ["sh", "-c", line.replace("P ", f"{program} ", 1)], cwd=folder, capture_output=True,
        env=os.environ | environment, check=False,
    )  # fmt: skip
    return done.returncode, done.stdout, done.stderr


BAD, GOOD = "P fit nope.toml log.csv", "P fit robot.toml log.csv"


@pytest.mark.parametrize(("line", "code"), [
    (f"{BAD} >&- 2>&-", 2), (f"{GOOD} 2>/dev/full", 0),
])  # fmt: skip
def test_the_exit_code_is_that_of_the_work(folder, line, code):
    ended, _, said = shell(folder, line)
    assert ended == code, said
    assert b"Traceback" not in said


def test_what_is_written_goes_into_no_closed_stream(folder):
    """Else the first file that is opened gets the number of a stream, and what is said to it."""
    code, _, said = shell(folder, f"{GOOD} --quiet --out out >&- 2>&- <&-")
    assert (code, said) == (0, b"")
    assert json.loads((folder / "out" / "result.json").read_text())["status"] == "converged"


def test_letters_that_an_encoding_lacks_end_nothing(folder):
    name = os.fsdecode(b"n\xff.csv")
    (folder / name).write_bytes((folder / "log.csv").read_bytes())
    line = f"{GOOD.replace('log.csv', name)} --quiet --out strict"
    code, out, said = shell(folder, line, **STRICT)
    assert (code, said) == (0, b"")
    assert out.isascii()
    assert b"n\\xff" in out.replace(b"\\\\", b"\\")
    text = (folder / "strict" / "result.json").read_text(encoding="utf-8")
    assert "\\ud" not in text.replace("\\\\", "")  # half a letter, which other readers refuse
