"""The guides for those who change the code name what is there: folders, layers and files."""

import re
import tomllib
from collections import Counter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PACKAGES = ("identification", "inca_mj")
ARCHITECTURE = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
GUIDES = [ROOT / "CONTRIBUTING.md", *(ROOT / "docs").rglob("*.md"), ROOT / "README.md"]


def section(title):
    return ARCHITECTURE.split(f"\n## {title}\n")[1].split("\n## ")[0]


@pytest.mark.parametrize("package", PACKAGES)
def test_the_tree_shows_every_folder_and_none_that_is_not_there(package):
    tree = section("The folders").split(f"\n    {package}/\n")[1].split("\n\n")[0]
    shown, above = set(), ""
    for indent, name in re.findall(r"^( +)(\w+)/ ", tree, re.M):
        above = name if len(indent) == 6 else above
        shown.add(name if len(indent) == 6 else f"{above}/{name}")
    there = {p.parent.relative_to(ROOT / package) for p in (ROOT / package).rglob("__init__.py")}
    assert shown == {folder.as_posix() for folder in there} - {"."}


@pytest.mark.parametrize("package", PACKAGES)
def test_no_folder_has_more_than_20_files(package):
    files = [p for p in (ROOT / package).rglob("*") if p.is_file() and "__pycache__" not in p.parts]
    sizes = Counter(p.parent.relative_to(ROOT).as_posix() for p in files)
    assert len(sizes) > 10
    assert {folder: size for folder, size in sizes.items() if size > 20} == {}


@pytest.mark.parametrize("package", PACKAGES)
def test_the_layers_are_those_that_lint_checks(package):
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    contracts = settings["tool"]["importlinter"]["contracts"]
    (layers,) = [c["layers"] for c in contracts if c.get("containers") == [package]]
    blocks = section("Which folder may import from which").split("\n\n")
    (table,) = [b.splitlines() for b in blocks if b.startswith("    identification ")]
    at = [table[0].index(p) for p in PACKAGES]
    cut = (lambda s: s[: at[1]]) if package == PACKAGES[0] else (lambda s: s[at[1] :])
    assert [cut(line).strip() for line in table[1:] if cut(line).strip()] == layers


@pytest.mark.parametrize("guide", GUIDES, ids=lambda p: p.name)
def test_links_lead_to_files(guide):
    text = guide.read_text(encoding="utf-8")
    links = re.findall(r"\]\((?!https?:)([^)#]+)", text)
    assert [link for link in links if not (guide.parent / link).exists()] == []


def test_files_to_change_are_there():
    rows = re.findall(r"^\| [^|]+ \| (.*) \|$", section("Where to change what"), re.M)
    missing = []
    for row in rows:
        folder = ROOT
        for name in re.findall(r"`([\w/]+(?:/|\.\w+))`", row):  # a file alone is beside the last
            path = ROOT / name if "/" in name else folder / name
            folder = path if name.endswith("/") else path.parent
            missing += [] if path.exists() else [name]
    assert rows
    assert missing == []
