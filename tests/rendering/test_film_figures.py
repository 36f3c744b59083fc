import re
from html.parser import HTMLParser
from xml.etree import ElementTree

import numpy as np
import pytest
from PIL import Image

from identification.errors import InputError
from identification.report.page.media import svg
from identification.report.page.page import Section, Table, write_report
from identification.report.page.style import save_png
from inca_mj.rendering.legend import SLACK, tension_scale
from inca_mj.report.figures import crosscheck_figure, simulation_figures


def test_crosscheck_draws_each_case_and_the_slope():
    rows = [
        {"case": case, "step": h, "max_angle_error": h**4, "max_position_error": h**4,
         "max_tension_error": 0.0}
        for case in ("step", "prbs") for h in (2e-3, 1e-3)
    ]  # fmt: skip
    figure = crosscheck_figure(rows, 4.0)
    angle, _, tension = figure.axes
    assert [line.get_label() for line in angle.lines] == ["step", "prbs", "slope 4"]
    x, y = angle.lines[-1].get_data()
    assert np.diff(np.log(y)) / np.diff(np.log(x)) == pytest.approx(4)
    assert len(tension.lines) == 2
    assert "4.00" in figure.get_suptitle()


def test_png_and_svg(tmp_path, short_run):
    figure = simulation_figures(short_run)["platform_position"]
    path = save_png(figure, tmp_path / "position.png", dpi=50)
    with Image.open(path) as picture:
        assert picture.size == (320, 170)
    text = svg(figure)
    assert ElementTree.fromstring(text).tag.endswith("svg")
    assert text == svg(figure)


def test_colour_follows_tension_and_slack_is_grey():
    scale = tension_scale(np.array([[0.0, 3.2, 9.7]]))
    assert (scale.low, scale.high) == (3.0, 10.0)
    colours = scale(np.array([-1.0, 0.0, 3.2, 6.0, 9.7]))
    np.testing.assert_array_equal(colours[:2], [SLACK, SLACK])
    lightness = colours[2:, :3] @ [0.2126, 0.7152, 0.0722]
    assert (np.diff(lightness) > 0.05).all()


def test_every_run_has_a_scale():
    for tension in (np.zeros((3, 8)), np.full((3, 8), 4.0)):
        scale = tension_scale(tension)
        assert scale.high > scale.low
        assert np.isfinite(scale(tension[0])).all()


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


def test_what_cannot_be_shown_is_refused(tmp_path):
    with pytest.raises(InputError, match="row of 1 cells"):
        Table(("a", "b"), ((1,),))
    missing = Section("film", video=tmp_path / "missing.mp4")
    with pytest.raises(InputError, match=r"no such file: .*missing\.mp4"):
        write_report(tmp_path / "r.html", "t", [], [missing])
    assert list(tmp_path.iterdir()) == []
