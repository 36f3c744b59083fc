from xml.etree import ElementTree

import numpy as np
import pytest
from PIL import Image

from identification.report.compare_figure import compare_figure
from identification.report.style import save_png
from identification.report.vector import svg
from inca_mj.report.figures import crosscheck_figure, simulation_figures


def test_the_currents_and_the_four_figures_of_the_thesis(short_run):
    figures = simulation_figures(short_run)
    lines = {name: len(figure.axes[0].lines) for name, figure in figures.items()}
    assert lines == {
        "motor_currents": 8,
        "motor_angles": 8,
        "cable_tensions": 8,
        "platform_position": 3,
        "platform_angles": 3,
    }
    for figure in figures.values():
        [axes] = figure.axes
        assert axes.get_xlabel() == "time [s]"
        assert axes.get_ylabel().endswith("]")


@pytest.mark.parametrize("channels", [1, 3, 8])
def test_compare_shows_every_output_with_its_fit_and_residual(channels):
    time = np.linspace(0, 1, 20)
    measured = np.sin(np.outer(time, np.arange(1, channels + 1)))
    fit = np.linspace(90, 99, channels)
    fit[-1] = np.nan
    names = [f"angle_{k}" for k in range(channels)]
    figure = compare_figure(time, measured, measured + 0.1, fit, names, "rad")
    panels = {a.get_title("left"): a for a in figure.axes if a.get_title("left")}
    assert len(panels) == channels
    for k, name in enumerate(names[:-1]):
        assert f"{name}   fit {fit[k]:.2f} %" in panels
    residuals = [a for a in figure.axes if a.get_ylabel().startswith("residual")]
    assert len(residuals) == channels
    for axes in residuals:
        np.testing.assert_allclose(axes.lines[0].get_ydata(), -0.1)


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
