"""docs/sweeps.md has the settings that the methods take, and reports of sweeps speak in words."""

import re
from dataclasses import MISSING, fields
from pathlib import Path

import pytest
from sweep_cases import run, write

from identification.sweep.config import read_sweep
from identification.sweep.figures import power_figure, threshold_figure
from identification.sweep.method import load_method
from identification.sweep.power import Threshold, curves
from identification.sweep.settings import check_values, kinds_of
from identification.sweep.statistics import wilson
from identification.sweep.store import Store
from identification.sweep.summary import summarise
from identification.sweep.words import Heads, about_of
from inca_mj.studies import METHODS

PAGE = (Path(__file__).parents[2] / "docs" / "sweeps.md").read_text(encoding="utf-8")
HEAD = "| setting | unit | default | required | what it is |\n|---|---|---|---|---|"
EXAMPLE = {bool: True, int: 1, float: 1.0, str: "a"}


def written(value):
    """A default as the TOML writes it; one that is not given cannot be written there."""
    if value is MISSING:
        return "–"
    if value is None:
        return "not given"
    if isinstance(value, bool):
        return f"`{str(value).lower()}`"
    return f'`"{value}"`' if isinstance(value, str) else f"`{value:g}`"


def table_of(settings):
    """The table of a settings dataclass."""
    about = about_of(settings)
    rows = []
    for field in fields(settings):
        required = "yes" if field.default is MISSING else "no"
        unit = Heads(about).unit(field.name) or "–"
        words = re.sub(r" \[[^\]]+\]$", "", about[field.name])
        rows.append(
            f"| `{field.name}` | {unit} | {written(field.default)} | {required} | {words} |"
        )
    return "\n".join([HEAD, *rows])


def sections():
    """The tables of the page by the methods that their headings name."""
    part = PAGE.split("## Settings of the methods\n")[1].split("\n## ")[0]
    found = {}
    for section in part.split("\n### ")[1:]:
        title, _, rest = section.partition("\n")
        table = "\n".join(line for line in rest.splitlines() if line.startswith("|"))
        found.update(dict.fromkeys(re.findall(r"`([\w-]+)`", title), table))
    return found


def test_the_page_has_the_settings_of_every_method():
    told = sections()
    assert set(told) == set(METHODS)
    for name, reference in METHODS.items():
        expected = table_of(load_method(reference).settings)
        assert told[name] == expected, f"{name}:\n{expected}"


@pytest.mark.parametrize("name", METHODS)
def test_a_sweep_must_say_what_the_page_calls_required_and_nothing_else(name, refusal):
    settings = load_method(METHODS[name]).settings
    kinds = kinds_of(settings)
    rows = [[c.strip(" `") for c in line.split("|")[1:4:1]] + [line.split("|")[4].strip()]
            for line in sections()[name].splitlines()[2:]]  # fmt: skip
    required = [row[0] for row in rows if row[3] == "yes"]
    given = {key: EXAMPLE.get(kinds[key], "file.csv") for key in required}
    assert set(check_values(settings, given, "here")) == {row[0] for row in rows}
    for key in required:
        rest = {k: v for k, v in given.items() if k != key}
        assert f"does not say {key!r}" in refusal(check_values, settings, rest, "here")


def test_every_setting_says_what_it_is():
    for reference in METHODS.values():
        assert all(about_of(load_method(reference).settings).values())


def test_a_report_speaks_in_words_with_units(tmp_path):
    sweep = read_sweep(write(tmp_path), {})
    run(write(tmp_path), tmp_path / "out")
    with Store(sweep, tmp_path / "out") as store:
        found = summarise(sweep, store.rows())
    told = " ".join(
        [*found.sentences]
        + [f"{s.title} {s.text} {s.table.columns if s.table else ''}" for s in found.sections]
    )
    assert "set." not in told
    assert "run." not in told
    assert not re.search(r"\b[a-z]+_[a-z]+\b", told), told


def test_names_become_words_and_the_unit_stands_behind():
    heads = Heads({"duration": "length of a log [s]", "false_name": "a name is not true"})
    assert heads.head("duration") == "duration [s]"
    assert heads.head("false_name") == "false name"
    assert heads.meaning("false_name") == "false name: a name is not true"
    assert heads.head("own_word") == "own word"


def rows_of(sizes, lengths):
    return [{"found": True, "set.size": x, "set.duration": d} for x in sizes for d in lengths]


@pytest.mark.parametrize(("sizes", "far"), [((0.3, 1.0, 30.0), True), ((1.0, 2.0, 3.0), False)])
def test_a_logarithmic_axis_says_so_and_another_does_not(sizes, far):
    heads = Heads({"duration": "length [s]", "size": "of it [N]"})
    found = curves(rows_of(sizes, (5.0, 10.0)), "found", "size", ["duration"], heads)
    assert [curve.label for curve in found] == ["duration 5 s", "duration 10 s"]
    figure = power_figure(found, heads.head("size"), "found")
    assert all((ax.get_xscale() == "log") is far for ax in figure.axes)
    assert figure.get_supxlabel() == "size [N]" + ", logarithmic axis" * far
    assert all(curve.rates == (wilson(1, 1),) * 3 for curve in found)


@pytest.mark.parametrize("smallest", [0.0, 2.0])
def test_so_do_both_axes_of_thresholds(smallest):
    lines = {"": [Threshold(at, smallest, None, None, smallest) for at in (1.0, 20.0)]}
    (ax,) = threshold_figure(lines, "duration [s]", "size [N]").axes
    assert ax.get_xlabel() == "duration [s], logarithmic axis"
    assert ax.get_xscale() == "log"
    assert (ax.get_yscale() == "log") is (smallest > 0)
    assert ax.get_ylabel().endswith("logarithmic axis") is (smallest > 0)
