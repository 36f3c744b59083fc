"""Records: whole or not at all, read by anyone, of one sweep in a folder, errors kept as rows."""

import json
import shutil
from importlib.metadata import version

import pyarrow.parquet as parquet
import pytest
from sweep_cases import GRID, read, run, write

from identification.__main__ import main
from identification.commands.program import STOPPED
from identification.sweep import store as module
from identification.sweep.config import read_sweep
from identification.sweep.run import Serial, run_sweep
from identification.sweep.store import Store
from identification.sweep.work import code


class Stopped(Exception):
    pass


class Some:
    """A backend that stops after some tasks, as a kill would."""

    def __init__(self, count):
        self.count = count

    def outcomes(self, work, tasks):
        for n, task in enumerate(tasks):
            if n == self.count:
                raise Stopped
            yield work(task)


BAD = "this task is bad (sweep_method.py, line 42)"


def begun(path, folder, count, **how):
    with pytest.raises(Stopped):
        run(path, folder, Some(count), **how)


def test_one_file_at_the_end_in_the_order_of_tasks(tmp_path):
    whole = run(write(tmp_path), tmp_path / "out")
    (file,) = (tmp_path / "out" / "records").iterdir()
    table = parquet.read_table(file)
    assert table["task"].to_pylist() == [*range(12)]
    assert read(tmp_path / "out") == whole
    assert table.schema.field("found").metadata[b"about"] == b"heads"
    first = json.loads(whole[1])
    assert first["set.size"] == 0.5
    assert first["names"] == ["x", "a"]
    assert first["error"] is None
    assert first["threads"] == "1"
    assert len(first["values"]) == 3
    assert not any(name.startswith("run.") for name in first)
    assert {"run.seconds", "run.host", "run.memory"} <= set(table.column_names)
    assert {*table["run.code"].to_pylist()} == {code()}
    assert code().startswith(version("inca-mj"))


def test_resumed_records_are_those_of_one_run(tmp_path, monkeypatch):
    path = write(tmp_path)
    whole = run(path, tmp_path / "whole")
    monkeypatch.setattr(module, "TOGETHER", 3)  # files are put together on the way
    out = tmp_path / "out"
    begun(path, out, 5)
    assert read(out) == whole[:5]
    begun(path, out, 4, resume=True)
    assert read(out) == whole[:9]
    assert run(path, out, resume=True) == whole


def test_a_half_written_file_is_no_record(tmp_path):
    path, out = write(tmp_path), tmp_path / "out"
    whole = run(path, tmp_path / "whole")
    begun(path, out, 4)
    files = sorted((out / "records").glob("*.parquet"))
    data = files[0].read_bytes()
    files[0].write_bytes(data[: len(data) // 2])
    other = bytearray(files[1].read_bytes())
    other[-40] ^= 1  # one bit, near the end, where the names of columns are
    files[1].write_bytes(other)
    files[2].write_bytes(b"")
    (out / "records" / ".part-000000007.tmp").write_bytes(data)
    with Store(read_sweep(path, {}), out) as store:
        assert store.done == {3}
        assert not [*(out / "records").glob(".*")]
    assert run(path, out, resume=True) == whole


def test_records_that_are_there_twice_count_once(tmp_path):
    path, out = write(tmp_path), tmp_path / "out"
    begun(path, out, 4)
    kept = tmp_path / "kept"
    shutil.copytree(out / "records", kept)
    with Store(read_sweep(path, {}), out) as store:
        store.finish()
    for file in kept.iterdir():  # killed before the single files were removed
        shutil.copy(file, out / "records")
    with Store(read_sweep(path, {}), out) as store:
        assert store.done == {0, 1, 2, 3}
        assert len([*store.rows()]) == 4
        assert len([*store.records.iterdir()]) == 1


def test_errors_are_rows_and_run_again_on_demand(tmp_path):
    path, out = write(tmp_path, "[study.grid]\nbad = [false, true]\n", 2), tmp_path / "out"
    rows = [json.loads(text) for text in run(path, out)]
    assert [row["error"] for row in rows] == [None, None, *[f"ValueError: {BAD}"] * 2]
    assert rows[2]["total"] is None
    with Store(read_sweep(path, {}), out) as store:
        assert store.drop_errors() == 2
        assert store.done == {0, 1}
        assert run_sweep(store, Serial(), resume=True) == 2
        assert store.done == {0, 1, 2, 3}


def test_another_sweep_in_the_folder_is_refused(tmp_path, refusal):
    out = tmp_path / "out"
    path = write(tmp_path)
    run(path, out)
    assert "write --resume to go on" in refusal(run, path, out)
    changed = write(tmp_path, GRID, 3)
    assert "holds the records of another sweep" in refusal(run, changed, out, resume=True)
    (out / ".sweep.json").unlink()
    assert "does not say whose" in refusal(run, changed, out, resume=True)
    (out / ".sweep.json").write_text("{")
    assert "cannot be read" in refusal(run, changed, out, resume=True)


def test_two_programs_do_not_write_at_once(tmp_path, refusal):
    path, out = write(tmp_path), tmp_path / "out"
    with Store(read_sweep(path, {}), out):
        assert "another sweep writes into" in refusal(run, path, out)
    run(path, out)


BROKEN = {
    "raise KeyError('no key')": "KeyError: 'no key'",
    "raise SystemExit(7)": "SystemExit: 7",
    "exit()": "SystemExit: None",
    "import numpy; numpy.linalg.inv(numpy.zeros((2, 2)))": "LinAlgError: Singular matrix",
    "class Mute(Exception):\n        __str__ = None\n    raise Mute": "Mute: without a message",
}
FILE = """
from dataclasses import dataclass
from identification.sweep.method import Column, Findings, Method

{top}

@dataclass(frozen=True)
class Settings:
    size: int = 0

    def __post_init__(self):
        {settings}

def own(settings, seed):
    if settings.size != 1:
        return {{"a": 1.0}}
    {run}

def summary(records):
    {summary}

OWN = Method(about="one", settings=Settings, columns={{"a": Column(float, "one")}}, run=own,
             summary=summary)
"""
GOOD = {"top": "", "settings": "pass", "run": "pass", "summary": "return Findings()"}


def sweep(folder, backend="serial", **parts):
    (folder / "own.py").write_text(FILE.format(**GOOD | parts))
    (folder / "sweep.toml").write_text(
        '[[study]]\nmethod = "own.py:OWN"\n[study.grid]\nsize = [0, 1, 2]\n'
    )
    line = ["sweep", folder / "sweep.toml", "--out", folder / "out", "--backend", backend]
    return main([*map(str, line), "--jobs", "1", "--quiet"])


def line_of(folder, word):
    lines = (folder / "own.py").read_text().splitlines()
    return next(k for k, line in enumerate(lines, 1) if word.splitlines()[-1].strip() in line)


@pytest.mark.parametrize("run", BROKEN)
def test_a_task_that_raises_or_exits_costs_no_other(tmp_path, capsys, run):
    assert sweep(tmp_path, run=run) == 0
    errors = [json.loads(row)["error"] for row in read(tmp_path / "out")]
    place = f"(own.py, line {line_of(tmp_path, run)})"
    assert errors == [None, f"{BROKEN[run]} {place}", None]
    assert "Traceback" not in capsys.readouterr().err


def test_a_ctrl_c_in_a_method_ends_the_sweep(tmp_path):
    assert sweep(tmp_path, run="raise KeyboardInterrupt") == STOPPED
