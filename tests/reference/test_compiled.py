"""Machine code of the oracle's equations is kept until any of their files changes."""

import subprocess
import sys

from inca_mj.reference import compiled

RUN = """
import sys
from inca_mj.reference import compiled
compiled.FOLDERS = (sys.argv[1],)
compiled._sources.cache_clear()  # of the equations that are imported with it
sys.path.insert(0, sys.argv[1])
from outer import outer
print(outer(1.0), sum(outer.stats.cache_hits.values()))
"""
INNER = """
from inca_mj.reference.compiled import compiled

@compiled
def inner(x):
    return x + {}
"""
OUTER = """
from inca_mj.reference.compiled import compiled
from inner import inner

@compiled
def outer(x):
    return 2 * inner(x)
"""


def test_machine_code_is_kept_until_a_file_of_a_function_inside_it_changes(tmp_path):
    def said():
        line = [sys.executable, "-c", RUN, str(tmp_path)]
        return subprocess.run(line, capture_output=True, text=True, check=True).stdout.split()

    (tmp_path / "outer.py").write_text(OUTER)
    (tmp_path / "inner.py").write_text(INNER.format(1))
    assert said() == ["4.0", "0"]
    assert said() == ["4.0", "1"]
    (tmp_path / "inner.py").write_text(INNER.format(3))
    assert said() == ["8.0", "0"]


def test_the_folders_of_all_equations_are_watched(monkeypatch):
    each = set()
    for folder in compiled.FOLDERS:
        monkeypatch.setattr(compiled, "FOLDERS", (folder,))
        each.add(compiled._sources.__wrapped__())
    assert len(each) == 3
