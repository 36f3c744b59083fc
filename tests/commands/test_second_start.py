"""A command imports what it needs, and draws what it is asked for."""

import json
import subprocess
import sys
from pathlib import Path

from inca_mj.files import example_path

WATCHED = """
import json, sys
from inca_mj.cli import main
for words in json.loads(sys.argv[1]):
    assert main([*words, "--quiet"]) == 0
sys.stderr.write(json.dumps(sorted(sys.modules)))
"""
SCIPY = ("stats", "special", "linalg", "optimize", "interpolate")
SLOW = ("matplotlib", "jinja2", *(f"scipy.{part}" for part in SCIPY))
SEARCH = "identification.innovations.discovery"
COMMANDS = (
    ("simulate", "--duration", "0.05"),
    ("compare", str(example_path())),
    ("sensitivity", "--duration", "0.05", "--free", "b_v"),
)


def modules_after(commands, folder):
    """The names of all modules that a process has imported after some commands."""
    words = json.dumps([*map(list, commands)])
    done = subprocess.run(
        [sys.executable, "-c", WATCHED, words],
        capture_output=True, text=True, cwd=folder, check=True,
    )  # fmt: skip
    return {*json.loads(done.stderr.splitlines()[-1])}


def test_commands_that_draw_nothing_import_neither_figures_nor_the_search(tmp_path):
    modules = modules_after(COMMANDS, tmp_path)
    assert "mujoco" in modules
    assert not {*SLOW, SEARCH} & modules


def test_commands_that_draw_runs_import_no_optimiser(tmp_path):
    drawn = [(*command, "--out", f"drawn{k}") for k, command in enumerate(COMMANDS)]
    modules = modules_after(drawn, tmp_path)
    assert "matplotlib" in modules
    assert not {"scipy.optimize", "scipy.special", SEARCH} & modules


ROOT = Path(__file__).parents[2]
LOG = str(ROOT / "examples" / "log.csv")
HEAVY = ("mujoco", "matplotlib", "numba", "scipy")
LINES = [
    ["film", "no.csv"],
    ["film", str(ROOT)],
    ["film", LOG, "--speed", "0"],
    ["film", LOG, "--seconds", "-1"],
    ["film", LOG, "--magnify", "0"],
    ["film", LOG, "--title", "a", "b"],
    ["film", LOG, "--param", "q=1"],
    ["film", LOG, "--model", "no"],
    ["linearize", "--pose", "9", "9", "9", "0", "0", "0"],
    ["linearize", "--log", "no.csv", "--time", "1"],
    ["linearize", "--log", LOG],
    ["linearize", "--grid", "x=1:2:1"],
    ["linearize", "--rate", "-4"],
    ["linearize", "--param", "q=1"],
    ["linearize", "--geometry", "no.toml"],
]
CODE = f"""
import json, sys
from inca_mj.cli import main
out = []
for line in json.loads(sys.argv[1]):
    out.append([main(line), sorted(m for m in {HEAVY!r} if m in sys.modules)])
print(json.dumps(out))
"""


def test_films_and_linear_models_refuse_before_heavy_imports(tmp_path):
    done = subprocess.run(
        [sys.executable, "-c", CODE, json.dumps(LINES)], cwd=tmp_path, capture_output=True,
        text=True, check=True,
    )  # fmt: skip
    for line, (code, heavy) in zip(LINES, json.loads(done.stdout), strict=True):
        assert (code, heavy) == (2, []), line
    assert len(done.stderr.splitlines()) == len(LINES)  # a sentence each
    assert not [*tmp_path.iterdir()]
