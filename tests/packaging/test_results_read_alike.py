"""What a search returns is read in one way, along a free run and over a horizon.

README's examples, those of `help(discover)` and the loops of the documents run on both: on the
INCA with a result that was made before, and on the elbow with a search of few effects.
"""

import inspect
import re
import textwrap
from pathlib import Path

import fake_discovery
import pytest
from elbow_cases import elbow
from page_text import text_of

import identification
import inca_mj
from identification import discovery_text
from identification.storage.shown import Shown, verdict_of

ROOT = Path(__file__).parents[2]
README, YOUR_ROBOT = ROOT / "README.md", ROOT / "docs" / "robot" / "index.md"


RESULTS = {
    "INCA, named": lambda: fake_discovery.found(several=True),
    "INCA, one of": lambda: fake_discovery.found(one_of=True, unexplained=True),
    "INCA, nothing": lambda: fake_discovery.found("nothing missing"),
    "INCA, unknown": lambda: fake_discovery.found("unknown effect"),
    "elbow": lambda: elbow()[1],
}


@pytest.fixture(params=RESULTS)
def found(request):
    return RESULTS[request.param]()


def blocks(path):
    return re.findall(r"^```python\n(.*?)^```", path.read_text(encoding="utf-8"), re.M | re.S)


def reading(path):
    """The blocks of a page that read what a search found."""
    return [b for b in blocks(path) if "for named in found.named" in b]


def example(function):
    """The example in a docstring."""
    text = inspect.cleandoc(function.__doc__)
    return textwrap.dedent(text[text.index("Examples:\n") + 10 : text.index("Args:\n")])


@pytest.fixture(autouse=True)
def beside_the_examples(tmp_path, monkeypatch):
    """A folder of its own, in which an example finds its logs and may write."""
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)


def run(source, monkeypatch, **names):
    """Run an example in which a search returns at once."""
    monkeypatch.setattr(inca_mj, "discover", lambda *a, **k: fake_discovery.found(several=True))
    monkeypatch.setattr(identification, "discover", lambda robot: elbow()[1])
    exec(compile(source, "example", "exec"), names)
    return names


def test_readme_reads_a_result_of_both_kinds(monkeypatch, capsys):
    kinds = set()
    for source in reading(README):
        names = run(source, monkeypatch)
        kinds.add(names["found"].horizon is None)
        said = capsys.readouterr().out
        for named in names["found"].named:
            assert f"{named.name} {named.where}" in said
    assert kinds == {True, False}


@pytest.mark.parametrize("source", [*reading(YOUR_ROBOT), *reading(README)])
def test_every_loop_of_the_documents_reads_every_result(source, found, monkeypatch):
    loop = re.split("\nrobot = |\nfound.report", source[source.index("for named in found") :])[0]
    names = {"discovery_text": discovery_text, "found": found}
    assert run(loop, monkeypatch, **names)["found"] is found


@pytest.mark.parametrize("package", [identification, inca_mj])
def test_help_has_an_example_that_runs_and_says_what_to_read_first(package, monkeypatch, capsys):
    function = package.discover
    names = run(example(function), monkeypatch)
    assert isinstance(names["found"], Shown)
    assert names["found"].verdict in capsys.readouterr().out
    assert "Read `found.verdict` first" in function.__doc__


def test_what_is_named_has_its_name_its_place_and_its_rivals(found):
    for named in (*found.named, *found.rejected):
        assert (named.name, named.where) == named.candidate.key
        assert all(len(told) == 3 for told in named.parameters.values())
    for named in found.named:
        assert 0 <= named.confidence <= 1
        for rival in named.rivals:
            assert (rival.name, rival.where) == rival.candidate.key
            assert 0 <= rival.confidence <= 1


def test_a_result_shows_its_verdict_and_not_its_numbers(found):
    first, *rest = verdict_of(found)
    assert repr(found) == str(found)
    assert first.startswith(repr(found))
    assert repr(found).count(". ") == 0
    assert repr(found).endswith(".")
    assert first in discovery_text(found)
    assert len(repr(found)) < 500
    box = found._repr_html_()
    assert box.count("<p ") == 1 + len(rest)
    said = " ".join(text_of(box).split())
    assert " ".join(first.split()) in said
    assert len(box) < 20_000


def test_words_of_a_verdict_are_escaped_in_the_box():
    class Odd(Shown):
        verdict, unexplained = "named", False

    @verdict_of.register
    def _(result: Odd) -> list[str]:
        return ["a < b & <script> in 0.2 s. Then more."]

    assert "a &lt; b &amp; &lt;script&gt;" in Odd()._repr_html_()
    assert repr(Odd()) == "a < b & <script> in 0.2 s."
