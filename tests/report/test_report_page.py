"""A report is one file: figures that can be read, zoomed and printed, contents, a foot."""

import json
import re
from base64 import b64encode
from hashlib import sha256
from html import unescape
from xml.etree import ElementTree

import fake_discovery
import numpy as np
import pytest
from matplotlib.figure import Figure

from identification.report.discovery.report import DiscoveryFiles
from identification.report.page import media
from identification.report.page.media import drawing, svg
from identification.report.page.page import Section, whole_quantities, write_report
from identification.report.page.style import SERIES, save_png

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    found = fake_discovery.found(several=True)
    path = DiscoveryFiles(found).write_page(tmp_path_factory.mktemp("report") / "report.html")
    return path.read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def root(page):
    return ElementTree.fromstring(page.replace("<!DOCTYPE html>", ""))


def test_a_report_is_small_and_asks_nothing_of_the_network(page):
    assert len(page) < 1_000_000
    without_names = re.sub(r'xmlns(:\w+)?="[^"]*"', "", page)
    assert "://" not in without_names
    sources = re.findall(r'\b(?:src|href)="([^"]*)"', page)
    assert all(s.startswith(("data:", "#")) for s in sources)


def test_every_figure_has_a_role_and_a_title(root):
    figures = [e for e in root.iter() if e.tag == f"{SVG}svg" or e.tag == "img"]
    assert len(figures) >= 5
    for figure in figures:
        assert figure.get("role") == "img"
        title = figure.find(f"{SVG}title")
        assert title is not None
        assert title.text
        assert figure.get("aria-labelledby") == title.get("id")


def test_every_entry_of_the_contents_has_its_part(root):
    nav = next(e for e in root.iter("nav"))
    wanted = [a.get("href").removeprefix("#") for a in nav.iter("a")]
    names = {e.get("id"): e for e in root.iter("section") if e.get("id")}
    assert len(wanted) == len(names) > 5
    for name, a in zip(wanted, nav.iter("a"), strict=True):
        assert names[name].find("h2").text == a.text


def test_a_value_is_never_coarser_than_its_std(page):
    pairs = re.findall(r"(-?\d+(?:\.(\d+))?) ± (\d+(?:\.(\d+))?)", page)
    assert len(pairs) > 8
    for value, of_value, std, of_std in pairs:
        assert len(of_value) == len(of_std), f"{value} ± {std}"


def test_a_drawing_tells_where_its_axes_and_lines_are():
    figure = Figure((4.0, 3.0), dpi=100)
    upper, lower = figure.subplots(2, sharex=True)
    upper.plot([0, 1, 2], [1, 10, 100], color=SERIES[0], label="grows")
    upper.set_yscale("log")
    lower.bar([0, 1, 2], [3, 2, 1])
    lower.set_xlabel("time [s]")
    lower.set_yticks([1, 2], ["one", "two"])
    drawn = svg(figure, "a_", "Two <panels>")
    root = ElementTree.fromstring(drawn)
    axes = json.loads(root.get("data-axes"))
    assert [a["y"][2] for a in axes] == ["log", "fixed"]
    assert axes[0]["sx"] == axes[1]["sx"]
    assert axes[0]["sy"] != axes[1]["sy"]
    assert axes[0]["names"][0] == axes[1]["names"][0] == "time [s]"
    assert root.find(f"{SVG}title").text == "Two <panels>"
    # A corner of the line stands where box and range say that its values are.
    of, (left, top, right, bottom) = axes[0], axes[0]["box"]
    group = next(e for e in root.iter() if e.get("id") == of["series"][0]["id"])
    corners = np.array(
        re.findall(r"(-?[\d.]+) (-?[\d.]+)", group.find(f"{SVG}path").get("d")), float
    )
    x = of["x"][0] + (corners[:, 0] - left) / (right - left) * (of["x"][1] - of["x"][0])
    decades = np.log10(of["y"][:2])
    y = decades[0] + (bottom - corners[:, 1]) / (bottom - top) * np.diff(decades)
    np.testing.assert_allclose(x, [0, 1, 2], atol=2e-3)
    np.testing.assert_allclose(y, [0, 1, 2], atol=5e-3)
    assert of["series"][0]["label"] == "grows"


def test_titles_are_escaped(tmp_path):
    figure = Figure()
    figure.subplots().plot([0, 1, 2], [0, 1, 0], label='a "b" & c')
    text = write_report(
        tmp_path / "r.html", "t", [], [Section("s", figures=(("<i> & 'k'", figure),))]
    ).read_text(encoding="utf-8")
    root = ElementTree.fromstring(text.replace("<!DOCTYPE html>", ""))
    drawn = next(root.iter(f"{SVG}svg"))
    assert drawn.find(f"{SVG}title").text == "<i> & 'k'"
    assert 'a "b" & c' in unescape(drawn.get("data-axes")).replace('\\"', '"')


@pytest.mark.parametrize(
    ("text", "kept"),
    [
        ("off by 4.12 ± 0.21 mN m rms", ["4.12 ± 0.21 mN m"]),
        ("2e-3 N m s/rad, and 315 µs earlier", ["2e-3 N m s/rad", "315 µs"]),
        ("8 samples and 3 records", []),
    ],
)
def test_no_line_ends_between_a_number_and_its_unit(text, kept):
    said = str(whole_quantities(text))
    assert re.findall(r'<span class="whole">(.*?)</span>', said) == kept
    assert re.sub(r"<[^>]*>", "", said) == text
    assert "<b>" not in whole_quantities("<b> 3 m & more")


def test_a_page_may_run_its_one_script_and_ask_nobody_for_anything(page):
    (policy,) = re.findall(r'http-equiv="Content-Security-Policy" content="([^"]*)"', page)
    (script,) = re.findall(r"<script>(.*?)</script>", page, re.DOTALL)
    rules = dict(rule.split(maxsplit=1) for rule in unescape(policy).split("; "))
    digest = b64encode(sha256(script.encode()).digest()).decode()
    assert rules["script-src"] == f"'sha256-{digest}'"
    assert rules["default-src"] == rules["base-uri"] == rules["form-action"] == "'none'"
    assert rules["img-src"] == rules["media-src"] == "data:"
    assert set(" ".join(rules.values()).split()) <= {
        "'none'", "'unsafe-inline'", "data:", f"'sha256-{digest}'",
    }  # fmt: skip
    assert page.index("Content-Security-Policy") < page.index("<style>") < page.index("<script>")
    assert not re.search(r"<[^>]*\son\w+=", page)  # the policy would not run it


NAMES = ("wrist 😀", "关节", "sustrjø", "ارتباط", "a\u0301\u200d")


@pytest.fixture(params=NAMES)
def named(request):
    figure = Figure((4.0, 3.0), layout="constrained")
    ax = figure.subplots()
    ax.plot([0, 1, 2], label=request.param)
    ax.set(xlabel=f"{request.param} [rad]", title=request.param)
    ax.legend()
    return request.param, figure


def test_a_figure_keeps_its_letters_and_warns_of_none(named, tmp_path, monkeypatch):
    name, figure = named  # warnings are errors here
    assert name in drawing(figure, "f1_", "a caption")
    assert save_png(figure, tmp_path / "a.png").stat().st_size > 0
    monkeypatch.setattr(media, "_LARGEST_SVG", 0)
    assert "data:image/png;base64," in drawing(figure, "f2_", "a caption")
