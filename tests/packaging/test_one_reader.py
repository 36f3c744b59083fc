"""Every file is read by `identification.storage.files`, which waits for no pipe and has a bound."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
# What opens files for reading, by the last name of a call. MuJoCo, pyarrow and Python's importer
# open files by themselves: those places first let the reader look at the file.
READERS = {
    "open", "fdopen", "read_text", "read_bytes", "load", "loadtxt", "genfromtxt",
    "fromfile", "memmap", "mmap", "loadmat", "read_table", "read_csv", "from_file",
    "from_xml_path", "from_binary_path", "dataset", "spec_from_file_location", "imread", "parse",
    "copyfile", "copy2", "exec_module",
}  # fmt: skip
LOADERS = ("np", "numpy", "json", "tomllib", "pickle", "yaml")
OURS = ("read_text", "read_bytes")
WRITES = frozenset("wxa")
ALLOWED = {
    "inca_mj/rendering/film.py: open": "a film that the program wrote just now",
    "identification/storage/files.py: fdopen": "the reader",
    "identification/storage/exchange.py: open": "a folder, to lock it",
    "identification/storage/files.py: open": "the reader; a file or folder, to bring to the disk",
    "identification/storage/folders.py: copy2": "a file that the program wrote just now",
    "identification/storage/files.py: load": "the bytes that the reader has read",
    "identification/commands/streams.py: open": "the file that takes everything and holds nothing",
    "identification/commands/streams.py: fdopen": "the file that takes everything",
    "identification/native/cache_folder.py: open": "bounded, and no links or pipes either",
    "identification/native/cache_folder.py: fdopen": "bounded, and no links or pipes either",
    "identification/runtime/kept_code.py: read_bytes": "the program's own files",
    "identification/logs/formats/csv_files.py: loadtxt": "lines that the reader has read",
    "identification/logs/formats/read_mat.py: load": "the bytes that another process wrote",
    "identification/runtime/child.py: loadmat": "the bytes of its input",
    "identification/effects/plant/rows.py: from_file": "MuJoCo, after the reader has looked",
    "identification/runtime/child.py: from_file": "MuJoCo, after the reader has looked",
    "identification/sweep/store.py: read_table": "pyarrow, after the digest was read",
    "identification/sweep/store.py: dataset": "pyarrow, after the digest was read",
    "identification/sweep/store.py: open": "the lock and a folder, of which nothing is read",
    "identification/sweep/method.py: spec_from_file_location": "after the reader has looked",
    "identification/sweep/method.py: exec_module": "after the reader has looked",
}


def mode_of(call):
    """The mode of a call of `open`, "r" where it gives none."""
    place = 1 if isinstance(call.func, ast.Name) else 0  # of a path, the path comes before it
    words = [*call.args[place : place + 1], *(k.value for k in call.keywords if k.arg == "mode")]
    return next((w.value for w in words if isinstance(w, ast.Constant)), "r")


def reads(tree):
    """The names of the calls in a module that open a file for reading."""
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call):
            continue
        own = isinstance(node.func, ast.Name)
        name = node.func.id if own else getattr(node.func, "attr", "")
        if (own and name in OURS) or name not in READERS:
            continue
        if name == "load" and (own or getattr(node.func.value, "id", "") not in LOADERS):
            continue  # of a number in machine code
        if name != "open" or not set(str(mode_of(node))) & WRITES:
            yield name


FOUND = {
    f"{path.relative_to(ROOT)}: {name}"
    for package in ("identification", "inca_mj")
    for path in sorted((ROOT / package).rglob("*.py"))
    for name in reads(ast.parse(path.read_text()))
}


def test_nothing_else_opens_a_file_for_reading():
    assert FOUND - set(ALLOWED) == set()


def test_every_exception_is_one():
    assert set(ALLOWED) - FOUND == set()


@pytest.mark.parametrize(("text", "found"), [
    ("open('a')", ["open"]), ("open('a', 'w')", []), ("p.read_bytes()", ["read_bytes"]),
    ("json.load(p)", ["load"]),
])  # fmt: skip
def test_what_counts_as_reading(text, found):
    assert [*reads(ast.parse(text))] == found
