import re
from html.parser import HTMLParser
from xml.etree import ElementTree

import pytest

from identification.errors import InputError
from identification.report import media
from identification.report.page import Section, Table, write_report
from inca_mj.report.figures import simulation_figures


@pytest.fixture(scope="module")
def pictures(short_run):
    return tuple(simulation_figures(short_run).items())


@pytest.fixture
def page(tmp_path, pictures):
    movie = tmp_path / "run.mp4"
    movie.write_bytes(b"not a film")
    sections = [
        Section("Motion", "First.\n\nSecond.", pictures, video=movie),
        Section("Values", table=Table(("name", "value"), (("b_c", 0.0051234567), ("k_s", None)))),
        Section("Motion again", figures=pictures),
    ]
    path = write_report(
        tmp_path / "report.html",
        "A <report>",
        ["All & well."],
        sections,
        good=True,
        footer="seed 1",
    )
    return path.read_text(encoding="utf-8")


def test_a_report_is_well_formed_and_its_names_are_unique(page):
    root = ElementTree.fromstring(page.replace("<!DOCTYPE html>", ""))
    names = [element.get("id") for element in root.iter() if element.get("id")]
    assert len(names) == len(set(names))
    used = set(re.findall(r'(?:url\(|href=")#([^)"]+)', page))
    assert used <= set(names)
    HTMLParser().feed(page)


def test_a_report_asks_nothing_of_the_network(page):
    without_names = re.sub(r'xmlns(:\w+)?="[^"]*"', "", page)
    assert "http://" not in without_names
    assert "https://" not in without_names
    sources = re.findall(r'\b(?:src|href|xlink:href)="([^"]*)"', page)
    assert sources
    assert all(source.startswith(("data:", "#")) for source in sources)
    assert "@import" not in page


def test_the_verdict_comes_first_and_text_is_escaped(page):
    assert "A &lt;report&gt;" in page
    assert page.index("All &amp; well.") < page.index("First.")
    assert page.count("<svg") == 10
    assert "data:video/mp4;base64," in page
    assert '<td class="number">0.0051235</td>' in page
    assert page.index("seed 1") > page.index("Motion again")


def test_a_figure_of_many_points_becomes_pixels(tmp_path, pictures, monkeypatch):
    monkeypatch.setattr(media, "_LARGEST_SVG", 100)
    path = write_report(tmp_path / "r.html", "t", [], [Section("s", figures=pictures[:1])])
    assert '<img src="data:image/png;base64,' in path.read_text()


def test_what_cannot_be_shown_is_refused(tmp_path):
    with pytest.raises(InputError, match="row of 1 cells"):
        Table(("a", "b"), ((1,),))
    missing = Section("film", video=tmp_path / "missing.mp4")
    with pytest.raises(InputError, match=r"no such file: .*missing\.mp4"):
        write_report(tmp_path / "r.html", "t", [], [missing])
    assert list(tmp_path.iterdir()) == []
