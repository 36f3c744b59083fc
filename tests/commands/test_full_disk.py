"""What a command found is said even where it cannot be kept."""

import json

import pytest

from identification import InputError, write_log
from inca_mj.cli import main
from inca_mj.twin.logs import read_inca_log

LOG = "examples/log.csv"


@pytest.fixture
def full(monkeypatch):
    """A disk on which nothing more can be written."""

    def refused(path, *_):
        raise InputError(f"cannot write {path}: No space left on device")

    monkeypatch.setattr("identification.commands.common.write_result", refused)


@pytest.mark.parametrize("arguments", [(), ("--json",)], ids=["text", "json"])
def test_the_result_is_said_where_the_disk_is_full(full, tmp_path, capsys, arguments):
    log = tmp_path / "log.csv"
    write_log(read_inca_log(LOG).between(0.0, 1.0), log)
    assert main(["compare", str(log), *arguments]) == 0
    expected = capsys.readouterr().out
    assert main(["compare", str(log), "--out", str(tmp_path / "out"), *arguments]) == 2
    said, error = capsys.readouterr()
    assert said == expected
    assert json.loads(said)["rms"] if arguments else "mean fit" in said
    assert "No space left on device" in error.splitlines()[-1]
    assert not (tmp_path / "out").exists()
