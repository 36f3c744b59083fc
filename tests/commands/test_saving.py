"""Results are there whole, the old ones or the new ones, whatever ends the program."""

import json
import os
import signal
import subprocess
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

import fake_discovery
import pytest
from folder_cases import content, list_foreign, made

from identification.commands.common import Output, conclude
from identification.storage.folders import refuse_foreign, try_folder
from inca_mj.commands import filmed
from inca_mj.commands.discover import Discover

DRIVER = Path(__file__).parents[1] / "cases" / "saving_cases.py"
POSIX = pytest.mark.skipif(os.name != "posix", reason="forks")
CHANGES = {"open", "os.mkdir", "os.link", "os.rename", "os.fsync"}


@dataclass(frozen=True)
class Command:
    output: Output = field(default_factory=Output)


def driven(*arguments, before=()):
    """What the driver found: each call, the exit code, what the folder then held."""
    line = [*before, sys.executable, str(DRIVER), *map(str, arguments)]
    done = subprocess.run(line, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@POSIX
@pytest.mark.parametrize("case", ["new", "hidden"])
def test_a_kill_at_any_call_leaves_the_old_results_or_the_new_ones(tmp_path, case):
    found = driven("kill", case, tmp_path)
    assert {call for call, _, _ in found} >= CHANGES
    states = [state for _, _, state in found]
    assert states == sorted(states, reverse=True)  # old until one call, and new from then on
    assert {*states} == {"old", "new"}


@POSIX
def test_a_kill_where_no_step_exchanges_folders_is_finished_by_the_next_run(tmp_path):
    found = driven("kill", "folders", tmp_path)  # which checks what the next run finds
    assert [call for call, _, state in found if state == "part"] == 4 * ["os.rename"]


@POSIX
def test_a_call_that_fails_leaves_the_old_results_and_exit_code_2(tmp_path):
    found = driven("ENOSPC", "older", tmp_path)  # which checks that nothing was written or touched
    assert {call for call, code, _ in found if code == 2} >= CHANGES
    assert all(state == ("old" if code == 2 else "new") for _, code, state in found)
    assert found[-1][1] == 0  # what cannot be removed or drawn costs no result


def without_root(*line):
    """A line that may mount disks in a world of its own; skipped where there is none."""
    alone = ["unshare", "-rm"]
    try:
        subprocess.run([*alone, "true"], check=True, capture_output=True)
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("no mount of its own can be made here")
    return [*alone, *line]


@POSIX
def test_a_full_disk_leaves_the_old_results_or_the_new_ones(tmp_path):
    found = driven("full", "older", tmp_path, before=without_root())
    assert found[0] == [2, False]  # of few pages; the driver checks that the old ones are there
    assert found[-1] == [0, True]
    assert sorted(found, key=lambda each: (each[0] == 0, each[1])) == found


READ_ONLY = """
import subprocess, sys
from pathlib import Path
from identification.storage.folders import try_folder
subprocess.run(["mount", "-t", "tmpfs", "-o", "ro", "none", sys.argv[1]], check=True)
try_folder(Path(sys.argv[1]) / sys.argv[2])
"""


@POSIX
def test_a_disk_that_is_only_read_is_named_before_anything_is_done(tmp_path):
    line = without_root(sys.executable, "-c", READ_ONLY, str(tmp_path), "out")
    done = subprocess.run(line, capture_output=True, text=True, check=False)
    said = done.stderr.splitlines()[-1]
    assert "Read-only file system" in said
    assert str(tmp_path / "out") in said


# what is drawn after the results are saved


def test_an_interrupt_while_figures_are_drawn_costs_the_figures_only(tmp_path, capsys):
    out = tmp_path / "out"

    def keep(folder):
        (folder / "robot.toml").write_text("found")

    def draw(folder):
        (folder / "half.png").write_text("half")
        assert {*content(out)} == {"result.json", "robot.toml"}  # saved before anything is drawn
        raise KeyboardInterrupt

    made(out, **{"film.mp4": "old"})
    with pytest.raises(KeyboardInterrupt):
        conclude(Command(Output(out=out)), {"value": 1}, "the verdict", keep, draw)
    said = capsys.readouterr()
    assert said.out == "the verdict\n"
    assert said.err == f"left out: figures and report; the results are kept in {out}\n"
    assert {*content(out)} == {"result.json", "robot.toml"}
    assert [p.name for p in tmp_path.iterdir()] == ["out"]
    refuse_foreign(out)


def save_one(sections, folder):
    """In place of the figures, which take seconds to draw."""
    (folder / "figure.png").write_bytes(b"")
    return []


def test_an_interrupt_in_the_film_costs_the_film_only(tmp_path, capsys, monkeypatch):
    out = tmp_path / "out"

    told = []

    def interrupted(found, folder, progress):
        (folder / ".half.mp4").write_text("half")
        while not any("--no-film" in line for line in told):  # the report is drawn meanwhile
            time.sleep(0.01)
            progress(1, 91)
        raise KeyboardInterrupt

    monkeypatch.setattr(Output, "tell", lambda _, line: told.append(line))
    monkeypatch.setattr("identification.report.page.page_files.save_figures", save_one)
    monkeypatch.setattr(filmed, "film_discovery", interrupted)
    monkeypatch.setattr("inca_mj.commands.discover.cannot_draw", lambda: "")
    monkeypatch.setattr(
        "inca_mj.workflows.discovery.discover", lambda *_, **__: fake_discovery.found()
    )
    with pytest.raises(KeyboardInterrupt):
        Discover((Path("examples/log.csv"),), output=Output(out=out, json=True)).run()
    said = capsys.readouterr()
    assert said.err.endswith(f"left out: film; the results are kept in {out}\n")
    assert {"result.json", "model.xml", "effects.json", "report.html"} <= {*content(out)}
    assert any(name.endswith(".png") for name in content(out))
    assert "<video" not in (out / "report.html").read_text()
    assert list_foreign(out) == []
    assert json.loads(said.out)["model"] == str(out / "model.xml")


WAIT = """
import time
from pathlib import Path
from dataclasses import dataclass, field
from identification.commands.common import Output, conclude, say_json
from identification.commands.stopping import STOPPED, at_end, stoppable

@dataclass(frozen=True)
class Command:
    output: Output = field(default_factory=lambda: Output(out=Path("out")))

def draw(folder):
    print("drawing", flush=True)
    {}

try:
    with stoppable("robot"):
        conclude(Command(), {{"value": 1}}, "", draw=draw)
except KeyboardInterrupt:
    at_end(STOPPED)
"""


BUSY = "import hashlib; hashlib.pbkdf2_hmac('sha256', b'', b'', 2**31 - 1)"


@POSIX
def test_the_sentence_is_said_once_whoever_ends_the_program(tmp_path):
    process = subprocess.Popen(
        [sys.executable, "-c", WAIT.format(BUSY)], cwd=tmp_path, stdout=subprocess.PIPE,
        stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    while process.stdout.readline() != "drawing\n":
        assert process.poll() is None
    process.send_signal(signal.SIGINT)
    said = process.communicate(timeout=60)[1]
    assert process.returncode == 130
    assert sorted(said.splitlines()) == [
        "left out: figures and report; the results are kept in out", "robot: stopping …",
    ]  # fmt: skip
    assert {*content(tmp_path / "out")} == {"result.json"}
    try_folder(tmp_path / "out")
