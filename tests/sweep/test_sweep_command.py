"""`inca sweep` and `python -m identification sweep` as a user meets them."""

import json
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from sweep_cases import read, run, write

from identification.__main__ import main as identification
from identification.sweep.config import read_sweep
from inca_mj.cli import main as inca
from inca_mj.studies import METHODS

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "json.md").read_text(encoding="utf-8")
KEYS = set(re.findall(r"`(\w+)`", PAGE.split("## sweep\n")[1].split("\n## ")[0]))
SLOW = "[study.settings]\nseconds = 0.15\n"
NAMED = ("errors", "settings", "rates", "quantiles", "summary")  # what these hold has other names
LINE = [sys.executable, "-m", "identification", "sweep"]


def keys_of(value, inside=""):
    if isinstance(value, list):
        return set().union(*(keys_of(v, inside) for v in value))
    if not isinstance(value, dict):
        return set()
    own = set() if inside in NAMED else set(value)
    return own.union(*(keys_of(v, k) for k, v in value.items() if inside != "summary"))


def test_a_sweep_prints_json_and_leaves_a_folder(tmp_path, capsys):
    path, out = write(tmp_path, count=8), tmp_path / "out"
    line = ["sweep", str(path), "--backend", "serial", "--out", str(out), "--json"]
    assert inca(line) == 0
    record = json.loads(capsys.readouterr().out)
    assert keys_of(record) == KEYS - {"null"}
    assert record["records"] == record["tasks"] == 48
    (study,) = record["studies"]
    shares = [group["rates"]["found"] for group in study["groups"]]
    assert sum(share["hits"] for share in shares) == study["summary"]["heads"]
    assert {curve["settings"]["word"] for curve in study["power"]} == {"a", "b"}
    names = {file.name for file in out.iterdir()}
    assert {"report.html", "result.json", "records"} <= names
    (figure,) = [name for name in names if name.endswith(".png")]
    assert figure.endswith("found-over-size.png")
    page = (out / "report.html").read_text(encoding="utf-8")
    assert "tossed." in page
    assert len(read(out)) == 48

    (out / "report.html").unlink()
    assert identification([*line, "--summary"]) == 0  # nothing runs
    assert json.loads(capsys.readouterr().out) == record | {"path": record["path"]}
    assert (out / "report.html").exists()


@pytest.mark.long
def test_killed_twice_and_resumed_it_has_the_records_of_one_run(tmp_path):
    path, out = write(tmp_path, SLOW, 14), tmp_path / "out"
    line = [*LINE, str(path), "--out", str(out), "--jobs", "1", "--quiet", "--resume"]
    for count in (3, 7):
        process = subprocess.Popen(line, cwd=tmp_path, start_new_session=True)
        kept = until(out / "records", count)
        process.send_signal(signal.SIGKILL)
        process.wait()
        assert kept <= len(read(out)) < 14
    done = subprocess.run(line, cwd=tmp_path, capture_output=True, text=True, check=True)
    assert "14 of 14 tasks have a record." in done.stdout
    assert read(out) == run(path, tmp_path / "whole")


def until(folder, count):
    """Wait for so many records; how many there are."""
    for _ in range(1200):
        if len(files := [*folder.glob("*.parquet")]) >= count:
            return len(files)
        time.sleep(0.05)
    raise AssertionError("no records came in a minute")


def test_ctrl_c_ends_with_130_and_keeps_the_records(tmp_path):
    path, out = write(tmp_path, SLOW, 15), tmp_path / "out"
    line = [*LINE, str(path), "--out", str(out), "--jobs", "1"]
    process = subprocess.Popen(line, cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    until(out / "records", 2)
    process.send_signal(signal.SIGINT)
    _, error = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "stopping" in error
    assert "Traceback" not in error
    kept = read(out)
    assert 2 <= len(kept) < 15
    assert kept == run(path, tmp_path / "whole")[: len(kept)]


@pytest.mark.parametrize("path", sorted((ROOT / "benchmarks" / "sweeps").glob("*.toml")),
                         ids=lambda path: path.stem)  # fmt: skip
def test_the_sweeps_of_the_project_are_right(path, tmp_path, monkeypatch):
    for folder in ("practice_prbs", "practice_multisine"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "log_000.csv").touch()
    for name in ("PRACTICE", "MEASURED"):
        monkeypatch.setenv(name, str(tmp_path))
    sweep = read_sweep(path, METHODS)
    assert len(sweep) > 0
    assert sweep.about != path.stem
