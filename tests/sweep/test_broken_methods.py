"""A method that raises or exits costs its own tasks only, and its line is told."""

import json

import pytest
from sweep_cases import read

from identification.__main__ import main
from identification.commands.program import STOPPED

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


def test_a_worker_goes_on_too(tmp_path):
    assert sweep(tmp_path, "processes", run="raise SystemExit(7)") == 0
    assert [bool(json.loads(row)["error"]) for row in read(tmp_path / "out")] == [
        False,
        True,
        False,
    ]


@pytest.mark.parametrize(("part", "what"), [
    ("top", "cannot be imported"), ("settings", "refuses its settings"),
    ("summary", "has no summary of its records"),
])  # fmt: skip
@pytest.mark.parametrize("code", ["raise KeyError('no key')", "raise SystemExit(7)"])
def test_code_around_the_tasks_is_told_with_its_line(tmp_path, capsys, part, what, code):
    assert sweep(tmp_path, **{part: code}) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert what in said
    assert f"(own.py, line {line_of(tmp_path, code)})" in said


def test_a_method_that_is_no_python_is_told(tmp_path, capsys):
    assert sweep(tmp_path, top="def") == 2
    assert "SyntaxError" in capsys.readouterr().err


def test_a_ctrl_c_in_a_method_ends_the_sweep(tmp_path):
    assert sweep(tmp_path, run="raise KeyboardInterrupt") == STOPPED
