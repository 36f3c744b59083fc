"""What the documents show works: examples import public names only, and the quick ones run."""

import ast
import re
from importlib import import_module
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PACKAGES = ("identification", "inca_mj", "inca_mj.kinematics", "identification.sweep")
# Searches, drawing, and what reads the result of a search (`test_results_read_alike.py` and
# `test_results_are_written_alike.py` run it).
SLOW = {"discover", "fit", "identify", "trials", "film", "crosscheck", "found", "load",
        "design_experiment"}  # fmt: skip
BLOCKS = [
    pytest.param(text, id=f"{path.relative_to(ROOT)}-{number}")
    for path in (ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md")))
    for number, text in enumerate(
        re.findall(r"^```python\n(.*?)^```", path.read_text(encoding="utf-8"), re.M | re.S), 1
    )
]
QUICK = [
    block
    for block in BLOCKS
    if "..." not in block.values[0]
    and not SLOW & {n.id for n in ast.walk(ast.parse(block.values[0])) if isinstance(n, ast.Name)}
]


def refuse_private(source):
    """Every name of ours that is imported must be in a public list."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.ImportFrom) and node.module.split(".")[0] in PACKAGES:
            assert node.module in PACKAGES, node.module
            names = {alias.name for alias in node.names}
            assert names <= set(import_module(node.module).__all__)
        if isinstance(node, ast.Import):
            ours = [a.name for a in node.names if a.name.split(".")[0] in PACKAGES]
            assert set(ours) <= set(PACKAGES)


@pytest.mark.parametrize("source", BLOCKS)
def test_documents_use_public_names(source):
    refuse_private(source)


@pytest.mark.parametrize("path", sorted((ROOT / "examples").glob("*.py")), ids=lambda p: p.name)
def test_examples_use_public_names(path):
    refuse_private(path.read_text(encoding="utf-8"))


@pytest.mark.parametrize("source", QUICK)
def test_quick_examples_of_documents_run(source, monkeypatch):
    monkeypatch.chdir(ROOT)
    names = {}
    exec(compile(source, "example", "exec"), names)
    assert names
