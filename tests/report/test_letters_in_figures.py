"""A name may have letters of any script: figures are written, and nothing warns."""

import io

import pytest
from matplotlib.figure import Figure

from identification.report import media
from identification.report.media import drawing
from identification.report.style import save_png, write_figure

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


def test_another_warning_is_not_hidden():
    class Warns(Figure):
        def savefig(self, *_, **__):
            import warnings

            warnings.warn("another", UserWarning, stacklevel=1)

    with pytest.raises(UserWarning, match="another"):
        write_figure(Warns(), io.BytesIO())
