"""The script of the figures, in a browser without a window; skipped where there is none."""

import json
import re
import shutil
import subprocess

import pytest
from matplotlib.figure import Figure

from identification.report.page.page import Section, Table, write_report

NAMES = ("chromium", "chromium-browser", "google-chrome")
BROWSER = next(filter(None, map(shutil.which, NAMES)), None)
pytestmark = pytest.mark.skipif(BROWSER is None, reason="no browser on this machine")

PROBE = """
<script>
window.addEventListener("load", function () {
  var svg = document.querySelector("svg[data-axes]"), hit = svg.querySelector(".hit"), said = {};
  var box = hit.getBoundingClientRect();
  function send(kind, x, y) {
    hit.dispatchEvent(new PointerEvent(kind, {clientX: box.left + x * box.width, button: 0,
      clientY: box.top + y * box.height, bubbles: true, pointerId: 1, pointerType: "pen"}));
  }
  hit.setPointerCapture = function () {};
  function texts() {
    return Array.from(svg.querySelectorAll(".ticks text"), function (t) { return t.textContent; });
  }
  send("pointermove", 0.5, 0.05);
  said.read = document.querySelector(".tip").textContent;
  send("pointerdown", 0.25, 0.5); send("pointermove", 0.5, 0.52); send("pointerup", 0.75, 0.52);
  said.ticks = texts();
  said.moved = svg.querySelector("[id$='line0.0'] [transform]").getAttribute("transform");
  said.reset = !document.querySelector(".reset").hidden;
  send("pointermove", 0.5, 0.05);
  said.again = document.querySelector(".tip").textContent;
  document.querySelector(".reset").click();
  said.after = texts();
  document.body.setAttribute("data-said", JSON.stringify(said));
});
</script></body>"""


def probed(page, probe):
    """A page with a script of the test, which its Content-Security-Policy would not let run."""
    free, count = re.subn(r'<meta http-equiv="Content-Security-Policy"[^>]*>', "", page)
    assert count == 1
    return free.replace("</body>", probe)


def browse(path, *asked, width=1000):
    """What the browser writes on stdout of a page in a window of some width."""
    return subprocess.run(
        [BROWSER, "--headless", "--no-sandbox", "--disable-gpu", f"--window-size={width},800",
         "--virtual-time-budget=2000", f"--user-data-dir={path.parent / 'profile'}", *asked,
         path.as_uri()],
        capture_output=True, text=True, timeout=120, check=False,
    ).stdout  # fmt: skip


@pytest.fixture(scope="module")
def said(tmp_path_factory):
    folder = tmp_path_factory.mktemp("browser")
    figure = Figure((6.0, 3.0))
    ax = figure.subplots()
    ax.plot([0, 1, 2, 3, 4], [0, 5, 10, 5, 0], label="a peak")
    ax.set(xlim=(0, 4), ylim=(0, 10), xlabel="time [s]", ylabel="height [m]")
    path = write_report(folder / "r.html", "t", [], [Section("s", figures=(("A peak", figure),))])
    path.write_text(probed(path.read_text(encoding="utf-8"), PROBE), encoding="utf-8")
    found = re.search(r'data-said="([^"]*)"', dom := browse(path, "--dump-dom"))
    assert found, dom[-500:]
    return json.loads(found[1].replace("&quot;", '"').replace("&amp;", "&"))


def test_a_pointer_reads_the_nearest_corner_of_a_line(said):
    assert said["read"].split("\n") == ["a peak", "time [s]: 2", "height [m]: 10"]


def test_a_drag_zooms_and_draws_new_ticks(said):
    ticks = [float(t) for t in said["ticks"]]
    assert len(ticks) >= 3
    assert min(ticks) >= 1
    assert max(ticks) <= 3
    wide, _, _, high, *_ = map(float, said["moved"].removeprefix("matrix(").rstrip(")").split(","))
    assert (wide, high) == pytest.approx((2, 1))
    assert said["reset"]
    assert said["again"] == said["read"]


def test_all_of_it_comes_back(said):
    assert said["after"] == []


def boxes(page, width):
    """Classes of the parts that may be wider than the screen."""
    return re.findall(
        r'class="(?:table )?(sideways[^"]*)"', browse(page, "--dump-dom", width=width)
    )


def test_what_is_wider_than_the_screen_says_so_and_nothing_else_does(tmp_path):
    figure = Figure((9.0, 3.0))
    figure.subplots().plot([0, 1, 2])
    tables = [
        Table(tuple(f"column_{k}" for k in range(n)), (("a_single_word",) * n,)) for n in (2, 7)
    ]
    parts = [Section("s", figures=(("A line", figure),), table=tables[0])]
    parts.append(Section("t", table=tables[1]))
    page = write_report(tmp_path / "r.html", "t", [], parts)
    assert boxes(page, 1600) == ["sideways"] * 3
    narrow, figure_box, wide = boxes(page, 420)
    assert narrow == figure_box == "sideways"  # a figure becomes as narrow as the screen
    assert wide == "sideways on"
