"""The document of the folders names every folder of the packages, and none that is not there."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("package", ["identification", "inca_mj"])
def test_every_folder_is_told(package):
    text = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    tree = text.split(f"\n    {package}/\n")[1].split("\n\n")[0]
    folders = [p.parent.name for p in (ROOT / package).glob("**/__init__.py")]
    folders.remove(package)
    assert sorted(re.findall(r"^ +(\w+)/ ", tree, re.M)) == sorted(folders)


GUIDES = ("CONTRIBUTING.md", "docs/architecture.md", "docs/glossary.md", "README.md")
FOLDERS = ("identification", "inca_mj", "docs", "tests", "examples", "models", "benchmarks")
THERE = [f"/{p.relative_to(ROOT)}" for folder in FOLDERS for p in (ROOT / folder).glob("**/*.*")]
THERE += [f"/{p.name}" for p in ROOT.glob("*.*")]


@pytest.mark.parametrize("guide", GUIDES)
def test_every_link_and_every_file_that_a_guide_names_is_there(guide):
    text = (ROOT / guide).read_text(encoding="utf-8")
    links = re.findall(r"\]\((?!http)([^)#]+)", text)
    files = re.findall(r"`([a-z0-9_./]+\.(?:py|md|toml|xml))`", text)
    missing = [link for link in links if not (ROOT / guide).parent.joinpath(link).exists()]
    missing += [f for f in files if not any(there.endswith(f"/{f}") for there in THERE)]
    assert links
    assert not missing
