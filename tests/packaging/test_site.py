"""The site of the documents: every page is reached, every link and every command is right."""

import json
import re
import shlex
from itertools import chain
from pathlib import Path

import pytest
import yaml
from test_doc_examples import refuse_private
from test_public_names import PACKAGES

import identification.commands.cli
import inca_mj.cli
from identification.commands.arguments import parsed

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
SITE = yaml.safe_load((ROOT / "mkdocs.yml").read_text(encoding="utf-8"))
NAV = {group: pages for entry in SITE["nav"] for group, pages in entry.items()}
MADE = {"contributing.md", "changelog.md"}  # of files that lie outside docs/
PAGES = sorted(path.relative_to(DOCS).as_posix() for path in DOCS.rglob("*.md"))
NOTEBOOKS = sorted(DOCS.rglob("*.ipynb"))
WITH_WORDS = {"command_line.md"}  # that stand for arguments
TUTORIALS = [page for page in [*NAV["My robot"], NAV["The INCA"][0], NAV["How it works"][0]]
             if page in PAGES and page not in WITH_WORDS]  # fmt: skip
PATHS = ("My robot", "The INCA", "How it works")
PROGRAMS = {
    "inca": (inca_mj.cli.Command, "inca"),
    "identification": (identification.commands.cli.Command, "identification"),
}
HERE = {"LOG": "examples/log.csv", "DIR": "out", "NAME=SIZE": "cogging.a=1e-3"}


def test_every_page_is_in_the_navigation_once_and_no_other():
    shown = [*chain(*NAV.values())]
    from_notebooks = {path.relative_to(DOCS).with_suffix(".md").as_posix() for path in NOTEBOOKS}
    assert sorted(shown) == sorted({*PAGES, *MADE, *from_notebooks})


def test_the_pages_are_three_paths_and_the_first_page_leads_to_each():
    assert [*NAV] == ["Start", *PATHS]
    first = (DOCS / "index.md").read_text(encoding="utf-8")
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    for path in PATHS:
        assert f"]({NAV[path][0]})" in first
        assert f"](docs/{NAV[path][0]})" in readme


def anchors(text):
    """What the headings of a page are called in its address."""
    headings = re.findall(r"^#+ (.*)$", re.sub(r"```.*?```", "", text, flags=re.S), re.M)
    plain = (re.sub(r"[^\w\s-]", "", re.sub(r"\[(.*?)\]\(.*?\)", r"\1", h)) for h in headings)
    return {re.sub(r"[-\s]+", "-", h.strip().lower()) for h in plain}


@pytest.mark.parametrize("page", PAGES)
def test_links_lead_to_files_and_headings(page):
    path = DOCS / page
    text = path.read_text(encoding="utf-8")
    made = {p.with_suffix(".md") for p in NOTEBOOKS}
    for link, anchor in re.findall(r"\]\((?![a-z]+:)([^)#\s]*)#?([^)\s]*)\)", text):
        target = (path.parent / link).resolve() if link else path
        assert target.exists() or target in made, link
        if anchor and target.suffix == ".md":
            assert anchor in anchors(target.read_text(encoding="utf-8")), f"{link}#{anchor}"


def names(commands):
    """The commands of a program."""
    return {command.__metadata__[0].name for command in commands.__args__}


def quoted(page):
    """Command lines of ours that a page shows, in blocks and in sentences."""
    text = (DOCS / page).read_text(encoding="utf-8")
    lines = [*re.findall(r"^ {4}(\S.*)$", text, re.M), *re.findall(r"`([^`\n]+)`", text)]
    for line in lines:
        for program in PROGRAMS:
            if line.startswith(f"{program} ") and "|" not in line:
                yield program, line.removeprefix(program).split("#")[0].strip()


@pytest.mark.parametrize("page", TUTORIALS)
def test_commands_of_tutorials_exist_with_their_options(page):
    for program, rest in quoted(page):
        commands, name = PROGRAMS[program]
        words = [HERE.get(word, word) for word in shlex.split(rest)]
        assert words[0] in names(commands)
        if len(words) > 1:  # else a sentence speaks of the command
            parsed(commands, name, "", words, ())  # refuses what it does not know


@pytest.mark.parametrize("page", TUTORIALS)
def test_scripts_of_tutorials_are_there(page):
    text = (DOCS / page).read_text(encoding="utf-8")
    scripts = re.findall(r"python (examples/\S+\.py)", text)
    assert [name for name in scripts if not (ROOT / name).exists()] == []


def test_the_page_of_questions_names_every_command():
    told = {(program, rest.split()[0]) for program, rest in quoted("which_command.md")}
    there = {(program, n) for program, (commands, _) in PROGRAMS.items() for n in names(commands)}
    assert told == there


def test_every_package_with_public_names_has_a_page_of_them():
    pages = {page: (DOCS / page).read_text(encoding="utf-8") for page in PAGES}
    listed = chain(*(re.findall(r"<!-- public names: ([\w.]+) -->", t) for t in pages.values()))
    assert sorted(listed) == sorted(PACKAGES)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.name)
def test_notebooks_are_kept_without_results_and_use_public_names(path):
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    code = [cell for cell in cells if cell["cell_type"] == "code"]
    assert code
    assert all(not cell["outputs"] and cell["execution_count"] is None for cell in code)
    lines = chain(*(cell["source"] + ["\n"] for cell in code))
    refuse_private("".join(line for line in lines if not line.startswith("%")))
