"""The parts of a figure are placed once, whatever shows it later."""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from PIL import Image

from identification.report.page import Section, save_figures, write_report
from identification.report.style import save_png


def drawn():
    figure = Figure((4.0, 2.5), layout="constrained")
    left, right = figure.subplots(1, 2)
    left.plot([0.0, 1000.0], [0.0, 1e5], label="a line")
    right.set_ylabel("a long label [m]")
    figure.legend(loc="outside upper center")
    return figure


def test_a_report_places_each_figure_once_and_looks_the_same(tmp_path, monkeypatch):
    alone = save_png(drawn(), tmp_path / "alone.png")
    placed, execute = [], ConstrainedLayoutEngine.execute
    monkeypatch.setattr(
        ConstrainedLayoutEngine,
        "execute",
        lambda self, figure: placed.append(figure) or execute(self, figure),
    )
    figure = drawn()
    sections = [Section("one", figures=(("It", figure),))]
    [path] = save_figures(sections, tmp_path)
    before = [ax.get_position().bounds for ax in figure.axes]
    page = write_report(tmp_path / "report.html", "page", ["fine"], sections)
    assert placed == [figure]
    assert [ax.get_position().bounds for ax in figure.axes] == before
    assert "<svg" in page.read_text()
    with Image.open(alone) as one, Image.open(path) as other:
        assert one.size == other.size
        first, second = (np.asarray(p.convert("L"), float) for p in (one, other))
    # Letters are measured at another resolution: what is drawn may move by a pixel or two.
    assert abs(first.mean() - second.mean()) < 1.0
    for ax, right in zip(figure.axes, drawn().axes, strict=True):
        right.figure.draw_without_rendering()
        np.testing.assert_allclose(ax.get_position().bounds, right.get_position().bounds, atol=0.01)
