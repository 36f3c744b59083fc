"""What mkdocs.yml cannot say of the site of docs/: a hook of MkDocs, which `make docs` runs.

- Links that leave docs/ work in a folder of files, and on a site they would lead nowhere. Those to
  CONTRIBUTING.md and CHANGELOG.md lead to pages made of these files; any other shows its path.
- The public names of a package, with the headings of its own list, become an API reference.
- Notebooks are executed, and each becomes a page. One that fails stops the build. NOTEBOOKS=off in
  the environment shows them without results, for those who write pages.
- The finished site is searched for scripts, styles, fonts and pictures of another computer.
"""

from __future__ import annotations

import os
import posixpath
import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any, ClassVar

from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File, Files

ROOT = Path(__file__).parents[1]
PAGES = {"CONTRIBUTING.md": "contributing.md", "CHANGELOG.md": "changelog.md"}
LINK = re.compile(r"(!?)\[([^\]]*)\]\(([^)\s]+)\)")
RECORDS = {"as_built.md", "benchmarks.md", "changelog.md", "measured.md"}  # long lists of names
SECONDS = 600  # that a cell may take on a busy machine


def on_files(files: Files, *, config: Any) -> Files:
    """Add the pages that do not lie in docs/ as Markdown."""
    for source, page in PAGES.items():
        text = (ROOT / source).read_text(encoding="utf-8")
        files.append(File.generated(config, page, content=text))
    for notebook in sorted(Path(config.docs_dir).glob("notebooks/*.ipynb")):
        for name, content in run_notebook(notebook).items():
            files.append(File.generated(config, f"notebooks/{name}", content=content))
    return files


def on_page_markdown(markdown: str, *, page: Any, config: Any, files: Files) -> str:
    """Turn links that leave docs/, and list the public names of a package."""
    here = next((s for s, p in PAGES.items() if p == page.file.src_uri), None)
    folder = "" if here else posixpath.join("docs", posixpath.dirname(page.file.src_uri))
    if page.file.src_uri in RECORDS:
        page.meta["search"] = {"boost": 0.2}  # found after the pages that explain
    wanted = r"<!-- public names: ([\w.]+) -->"
    markdown = re.sub(wanted, lambda found: public_names(found[1]), markdown)
    return LINK.sub(lambda found: turned(found, folder, page.file.src_uri), markdown)


def turned(found: re.Match[str], folder: str, page: str) -> str:
    """A link of a file in a folder of the repository, as it must be on a page of the site."""
    picture, text, target = found.groups()
    if re.match(r"[a-z]+:|#", target):
        return found[0]
    path, _, anchor = target.partition("#")
    place = posixpath.normpath(posixpath.join(folder, path))
    inside = PAGES.get(place) or (place[5:] if place.startswith("docs/") else None)
    if inside is None:
        bare = text.strip("`")
        return f"`{place}`" if place.endswith(bare) else f"{text} (`{place}`)"
    way = posixpath.relpath(inside, posixpath.dirname(page) or ".")
    return f"{picture}[{text}]({way}{'#' + anchor if anchor else ''})"


def public_names(package: str) -> str:
    """Headings and directives of mkdocstrings for every public name of a package."""
    source = ROOT / package.replace(".", "/") / "__init__.py"
    block = source.read_text(encoding="utf-8").split("if TYPE_CHECKING:")[1]
    lines = []
    for line in block.splitlines():
        if heading := re.match(r"    # (?!isort)(.*)", line):
            lines.append(f"## {heading[1][0].upper()}{heading[1][1:]}\n")
        elif entry := re.match(r"    from ([\w.]+) import (\w+)", line):
            lines.append(f"::: {entry[1]}.{entry[2]}\n")
    return "\n".join(lines)


def run_notebook(path: Path) -> dict[str, str | bytes]:
    """The page of an executed notebook, and its pictures, by their names in docs/notebooks."""
    import nbformat
    from nbclient import NotebookClient
    from nbconvert import MarkdownExporter
    from traitlets.config import Config

    notebook = nbformat.read(path, as_version=4)
    where = {"metadata": {"path": str(ROOT)}}
    if os.environ.get("NOTEBOOKS") != "off":
        private = Config(KernelManager={"transport": "ipc"})  # sockets in files, no open ports
        NotebookClient(notebook, timeout=SECONDS, resources=where, config=private).execute()
    files = {"output_files_dir": ".", "unique_key": path.stem}
    text, more = MarkdownExporter().from_notebook_node(notebook, resources=files)
    pictures = {Path(name).name: content for name, content in more["outputs"].items()}
    note = (
        f"\n\nThis page is a notebook, [{path.name}]({path.name}), run when the site was built.\n"
    )
    title, _, rest = text.strip().partition("\n")
    return {f"{path.stem}.md": f"{title}{note}{rest}\n", **pictures}


class Sources(HTMLParser):
    """Addresses that a browser asks for when it shows a page.

    Attributes:
        found: those of another computer.
    """

    ASKED: ClassVar = {
        "script": "src",
        "img": "src",
        "link": "href",
        "iframe": "src",
        "source": "src",
    }

    def __init__(self) -> None:
        super().__init__()
        self.found: set[str] = set()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Note what a tag asks for."""
        value = dict(attrs).get(self.ASKED.get(tag, ""))
        if value and re.match(r"(https?:)?//", value):
            self.found.add(value)


def outside(site: Path) -> dict[str, set[str]]:
    """What the pages and styles of a site would ask of other computers, by the file's path."""
    asked = {}
    for path in sorted(site.rglob("*.html")):
        page = Sources()
        page.feed(path.read_text(encoding="utf-8"))
        asked[path.relative_to(site).as_posix()] = page.found
    for path in sorted(site.rglob("*.css")):
        text = path.read_text(encoding="utf-8")
        asked[path.relative_to(site).as_posix()] = {
            found[0] for found in re.findall(r"url\([\"']?((https?:)?//[^)\"']+)", text)
        }
    return {path: found for path, found in asked.items() if found}


def on_post_build(*, config: Any) -> None:
    """Refuse a site that needs a network to be read."""
    if asked := outside(Path(config.site_dir)):
        raise PluginError(f"the site would ask other computers for {asked}")
