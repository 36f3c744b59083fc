"""What else is in a folder of results stays as it is, and a folder that cannot be is named."""

import errno
import json
import os

import pytest
from folder_cases import content, made

from identification import write_log
from identification.errors import InputError
from inca_mj.cli import main
from inca_mj.twin.logs import read_inca_log


def test_a_file_that_comes_at_the_last_moment_stays(tmp_path, monkeypatch):
    from identification import folders

    out, exchange = tmp_path / "out", folders.exchange
    made(out, a="old")

    def late(one, other):
        if not (one / "mine").exists() and not (other / "mine").exists():
            (other / "mine").write_text("of the user")
        exchange(one, other)

    monkeypatch.setattr(folders, "exchange", late)
    made(out, a="new")
    assert content(out) == {"a": "new", "mine": "of the user"}


def test_what_is_in_the_folder_beside_results_stays_what_it_is(tmp_path):
    out = tmp_path / "out"
    made(out, a="old", b="old")
    out.chmod(0o750)
    (out / ".hidden").write_text("of the user")
    number = (out / ".hidden").stat().st_ino
    made(out, a="new")
    assert content(out) == {"a": "new"}
    assert (out / ".hidden").stat().st_ino == number
    assert out.stat().st_mode & 0o777 == 0o750
    (out / "notes").mkdir()
    folder = out.stat().st_ino
    made(out, a="newer")
    assert content(out) == {"a": "newer"}
    assert (out / "notes").is_dir()
    assert out.stat().st_ino == folder  # a folder in it cannot be in two places at once


def test_a_link_to_a_folder_stays_a_link(tmp_path):
    (tmp_path / "real").mkdir()
    (tmp_path / "link").symlink_to("real")
    made(tmp_path / "link", a="1")
    made(tmp_path / "link", a="2")
    assert (tmp_path / "link").is_symlink()
    assert content(tmp_path / "real") == {"a": "2"}


def test_a_file_system_without_the_step_is_filled_file_by_file(tmp_path, monkeypatch):
    from identification import folders

    out = tmp_path / "out"
    made(out, a="old", b="old")

    def no_step(one, other):
        raise OSError(errno.EXDEV, os.strerror(errno.EXDEV))

    monkeypatch.setattr(folders, "exchange", no_step)
    made(out, a="new")
    assert content(out) == {"a": "new"}
    names = sorted(p.name for p in (*out.iterdir(), *tmp_path.iterdir()))
    assert names == [".made.json", "a", "out"]


def deep_long_name(folder):
    return folder / "new" / (300 * "b") / "out"


def result_is_a_folder(folder):
    (folder / "out" / "result.json").mkdir(parents=True)
    return folder / "out"


def loop_of_links(folder):
    (folder / "out").symlink_to("other")
    (folder / "other").symlink_to("out")
    return folder / "out"


@pytest.mark.parametrize(("place", "reason"), [
    (deep_long_name, "File name too long"), (result_is_a_folder, "result.json is a folder"),
    (loop_of_links, "leads nowhere"),
])  # fmt: skip
def test_a_folder_that_cannot_be_is_named_before_any_work(
    tmp_path, capsys, monkeypatch, place, reason
):
    monkeypatch.setattr("inca_mj.commands.simulate.Simulate.run", lambda _: pytest.fail("works"))
    out = place(tmp_path)
    before = sorted(tmp_path.rglob("*"))
    assert main(["simulate", "--out", str(out)]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert str(tmp_path.parent) in said  # very long names are cut in their middle
    assert reason in said
    assert "another" in said
    assert sorted(tmp_path.rglob("*")) == before


def test_a_folder_that_a_command_reads_is_not_that_of_its_results(tmp_path, capsys):
    made(tmp_path / "robot", **{"effects.json": "{}", "model.xml": "<mujoco/>"})
    line = ["film", "examples/log.csv", "--model", str(tmp_path / "robot")]
    assert main([*line, "--out", str(tmp_path / "robot")]) == 2
    assert "is read by this command" in capsys.readouterr().err
    assert {*content(tmp_path / "robot")} == {"effects.json", "model.xml"}


LOG = "examples/log.csv"


@pytest.fixture
def full(monkeypatch):
    """A disk on which nothing more can be written."""

    def refused(path, *_):
        raise InputError(f"cannot write {path}: No space left on device")

    monkeypatch.setattr("identification.commands.common.write_result", refused)


def test_the_result_is_said_where_the_disk_is_full(full, tmp_path, capsys):
    log = tmp_path / "log.csv"
    write_log(read_inca_log(LOG).between(0.0, 1.0), log)
    assert main(["compare", str(log), "--json"]) == 0
    expected = capsys.readouterr().out
    assert main(["compare", str(log), "--out", str(tmp_path / "out"), "--json"]) == 2
    said, error = capsys.readouterr()
    assert said == expected
    assert json.loads(said)["rms"]
    assert "No space left on device" in error.splitlines()[-1]
    assert not (tmp_path / "out").exists()
