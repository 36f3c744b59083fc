"""Machine code of hidden robots' equations is kept until any of their files changes."""

import ast
import subprocess
import sys
from pathlib import Path

import inca_mj.reference
from inca_mj.reference.equations import FOLDERS

RUN = """
import sys
sys.path.insert(0, sys.argv[1])
from outer import outer
print(outer(1.0), sum(outer.stats.cache_hits.values()))
"""
INNER = """
from pathlib import Path
from identification.runtime.kept_code import kept_code

compiled = kept_code(Path(__file__).parent)

@compiled
def inner(x):
    return x + {}
"""
OUTER = """
from inner import compiled, inner

@compiled
def outer(x):
    return 2 * inner(x)
"""


def test_machine_code_is_kept_until_a_file_of_a_function_inside_it_changes(tmp_path):
    def said():
        line = [sys.executable, "-B", "-c", RUN, str(tmp_path)]  # no bytecode of an older second
        return subprocess.run(line, capture_output=True, text=True, check=True).stdout.split()

    (tmp_path / "outer.py").write_text(OUTER)
    (tmp_path / "inner.py").write_text(INNER.format(1))
    assert said() == ["4.0", "0"]
    assert said() == ["4.0", "1"]
    (tmp_path / "inner.py").write_text(INNER.format(3))
    assert said() == ["8.0", "0"]


def test_compiled_equations_import_from_watched_folders_only():
    watched = {f"inca_mj.{name.replace('/', '.')}" for name in FOLDERS}
    files = [
        f
        for f in Path(inca_mj.reference.__file__).parent.glob("*.py")
        if "@compiled" in f.read_text()
    ]
    assert files
    ours = ("inca_mj.", "joint_worlds.")
    for node in (node for file in files for node in ast.walk(ast.parse(file.read_text()))):
        name = str(node.module) if isinstance(node, ast.ImportFrom) else ""
        assert not name.startswith(ours) or name.startswith(tuple(watched)), name
