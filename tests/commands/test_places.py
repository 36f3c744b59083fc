"""No command replaces a file that it did not make, or loses what it found.

What else is in a folder of results stays as it is, and a folder that cannot be is named.
"""

import errno
import json
import os

import numpy as np
import pytest
from folder_cases import content, list_foreign, made

from identification import write_log
from identification.__main__ import main as identification
from identification.errors import InputError
from identification.report.discovery.figures import gap_figure, rms_figure
from identification.report.page.figures import compare_figure
from identification.report.page.media import svg
from identification.storage import folders
from identification.storage.folders import MADE, whole_folder
from inca_mj.cli import main as inca
from inca_mj.twin.logs import read_inca_log

LOG = "time,i1\n0,1\n"


@pytest.fixture
def mine(tmp_path):
    """A folder of the user with a log that was measured."""
    folder = tmp_path / "mine"
    folder.mkdir()
    (folder / "log.csv").write_text(LOG)
    return folder


@pytest.mark.parametrize(("program", "arguments"), [
    (inca, ["simulate", "--input", "{}/log.csv"]), (inca, ["identify", "{}/log.csv"]),
    (inca, ["film", "{}/log.csv"]), (identification, ["fit", "{}/robot.toml", "{}/log.csv"]),
])  # fmt: skip
def test_a_folder_with_files_of_the_user_is_refused_before_anything_is_done(
    mine, capsys, program, arguments
):
    line = [a.format(mine) for a in arguments]
    assert program([*line, "--out", str(mine)]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "log.csv" in said
    assert "--out" in said
    assert {p.name: p.read_text() for p in mine.iterdir()} == {"log.csv": LOG}


def test_what_was_made_is_made_again_and_what_the_user_changed_is_kept(tmp_path):
    out = tmp_path / "out"
    made(out, a="first", b="first")
    made(out, a="second")
    assert content(out) == {"a": "second"}  # the old b would lie beside an a of another run
    made(out, a="second", b="second")
    (out / "b").write_text("edited")
    with pytest.raises(InputError, match=r"holds b, not made there by this program or changed"):
        made(out, a="third")
    assert content(out) == {"a": "second", "b": "edited"}
    (out / "b").unlink()
    (out / "notes").mkdir()  # no file, and never replaced
    made(out, a="third")
    assert content(out) == {"a": "third"}
    (out / MADE).write_text("{")  # then nothing is known to be made by the program
    assert list_foreign(out) == ["a"]


def test_what_comes_into_the_folder_meanwhile_is_kept_and_so_are_the_results(tmp_path):
    out, after = tmp_path / "out", tmp_path / "out-3"
    (tmp_path / "out-2").mkdir()

    def run():
        with whole_folder(out) as draft:
            (draft / "a").write_text("found")
            out.mkdir()  # by another program
            (out / "a").write_text("of the user")

    with pytest.raises(InputError, match=rf"nothing of it was replaced.*{after}"):
        run()
    assert content(out) == {"a": "of the user"}
    assert content(after) == {"a": "found"}
    made(after, a="found again")


def test_two_runs_into_one_folder_keep_their_drafts_and_dead_ones_are_removed(tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    dead, old = out / ".draft-999999999-x", out / ".draft-x"
    for left in (dead, old):
        left.mkdir()
    os.utime(old, (0, 0))
    with whole_folder(out) as first:
        (first / "a").write_text("1")
        with whole_folder(out) as second:
            assert first.is_dir()
            (second / "b").write_text("2")
        assert first.is_dir()
    assert content(out) == {"a": "1"}  # the results of the run that ended last, and of no other
    assert [p.name for p in out.iterdir() if p.name.startswith(".")] == [MADE]


def test_a_name_that_looks_like_a_formula_is_drawn_letter_by_letter():
    names, rng = ("$\\bad{$", "$5"), np.random.default_rng(0)
    e, time = rng.normal(size=(50, 2)), 0.01 * np.arange(50)
    for figure in (
        gap_figure(time, e, 0.5 * e, 0.1 * np.ones(2), names, ("$", "$")),
        rms_figure(np.ones(2), 0.5 * np.ones(2), 0.1, names, "$"),
        compare_figure(time, e, 0.9 * e, np.array([90.0, 80.0]), names, "$"),
    ):
        assert "svg" in svg(figure)


def stopped(out):
    with whole_folder(out) as draft:
        (draft / "half.txt").write_text("half")
        raise KeyboardInterrupt


def test_a_folder_that_a_stopped_command_made_does_not_stay(tmp_path):
    own = tmp_path / "own"
    own.mkdir()
    for out, stays in ((tmp_path / "new", False), (own, True)):
        with pytest.raises(KeyboardInterrupt):
            stopped(out)
        assert out.exists() == stays
        assert not stays or not list(out.iterdir())


def test_a_file_that_comes_at_the_last_moment_stays(tmp_path, monkeypatch):
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
    assert inca(["simulate", "--out", str(out)]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert str(tmp_path.parent) in said  # very long names are cut in their middle
    assert reason in said
    assert "another" in said
    assert sorted(tmp_path.rglob("*")) == before


def test_a_folder_that_a_command_reads_is_not_that_of_its_results(tmp_path, capsys):
    made(tmp_path / "robot", **{"effects.json": "{}", "model.xml": "<mujoco/>"})
    line = ["film", "examples/log.csv", "--model", str(tmp_path / "robot")]
    assert inca([*line, "--out", str(tmp_path / "robot")]) == 2
    assert "is read by this command" in capsys.readouterr().err
    assert {*content(tmp_path / "robot")} == {"effects.json", "model.xml"}


@pytest.fixture
def full(monkeypatch):
    """A disk on which nothing more can be written."""

    def refused(path, *_):
        raise InputError(f"cannot write {path}: No space left on device")

    monkeypatch.setattr("identification.commands.common.write_result", refused)


def test_the_result_is_said_where_the_disk_is_full(full, tmp_path, capsys):
    log = tmp_path / "log.csv"
    write_log(read_inca_log("examples/log.csv").between(0.0, 1.0), log)
    assert inca(["compare", str(log), "--json"]) == 0
    expected = capsys.readouterr().out
    assert inca(["compare", str(log), "--out", str(tmp_path / "out"), "--json"]) == 2
    said, error = capsys.readouterr()
    assert said == expected
    assert json.loads(said)["rms"]
    assert "No space left on device" in error.splitlines()[-1]
    assert not (tmp_path / "out").exists()
