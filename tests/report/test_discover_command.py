"""inca discover as a user meets it, what it finds being given."""

import json
import re
import sys
from types import ModuleType

import pytest
from fake_discovery import EFFECTS, found, log

from identification import write_log
from identification.discovery.options import DiscoveryOptions
from identification.report.page import Section
from inca_mj.cli import main
from inca_mj.commands import filmed
from inca_mj.twin.saved import load_twin


@pytest.fixture(autouse=True)
def outcome(monkeypatch):
    """What the discovery finds, to be changed for another, and the options that it was given."""
    result = [found()]
    module = ModuleType("inca_mj.workflows.discovery")

    def discover(*_, **given):
        result[1:] = [given["options"]]
        return result[0]

    module.discover = discover  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "inca_mj.workflows.discovery", module)
    return result


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("log") / "second.csv"
    write_log(log(), path)
    return path


def run(*arguments):
    return main([str(a) for a in arguments])


def test_the_verdict_comes_first(path, capsys):
    assert run("discover", path) == 0
    out = capsys.readouterr().out
    assert out.startswith("Missing from the model: friction – Stribeck peak, all drives")
    assert "+ friction – Stribeck peak, all drives: f_s = 4.12 ± 0.21 mN m" in out


def test_json_is_the_contract(path, capsys):
    assert run("discover", path, "--json") == 0
    out = capsys.readouterr().out
    assert out.count("\n") == 1
    record = json.loads(out)
    assert {"verdict", "effects", "unexplained", "gap", "located", "model", "seconds"} <= set(
        record
    )
    assert record["verdict"] == "named"
    assert record["model"] is None
    (effect,) = record["effects"]
    assert (effect["name"], effect["where"]) == ("stribeck_friction", "all drives")
    assert set(record["gap"]["before"]) == {"rms", "fit_percent", "rms_by_unit"}


@pytest.mark.parametrize(
    ("case", "says"),
    [
        ({"one_of": True, "unexplained": True, "several": True}, "is one of these"),
        *(
            pytest.param(*case, marks=pytest.mark.long)
            for case in (
                ({}, "Missing from the model"),
                ({"verdict": "nothing missing"}, "Nothing is missing"),
                ({"verdict": "unknown effect", "unexplained": True}, "none of the 3 known effects"),
            )
        ),
    ],
)
def test_a_folder_of_results_is_whole(case, says, path, tmp_path, outcome, capsys):
    outcome[0] = found(**case)
    assert run("discover", path, "--out", tmp_path, "--no-film", "--json") == 0
    record = json.loads(capsys.readouterr().out)
    assert record["model"] == str(tmp_path / "model.xml")
    names = {p.name for p in tmp_path.iterdir()}
    assert {"report.html", "result.json", "model.xml", "effects.json",
            "error-on-unseen-data-before-and-after.png", "error-by-output-on-unseen-data.png",
            "gain-of-the-best-candidates-on-the-nominal-fit.png"} <= names  # fmt: skip
    page = (tmp_path / "report.html").read_text()
    assert page.index(says) < page.index("The gap on unseen data")
    assert ">nan<" not in page
    assert 'src="http' not in page
    kept = json.loads((tmp_path / "result.json").read_text())
    assert kept["verdict"] == record["verdict"]
    assert {"python", "mujoco"} <= set(kept["versions"])
    twin = load_twin(tmp_path, EFFECTS)
    assert {e.name for e in twin.effects} == {e["name"] for e in record["effects"]}


def test_the_film_stands_in_the_report_before_the_model(path, tmp_path, monkeypatch, capsys):
    def film_discovery(found, folder, progress):
        files = [folder / name for name in ("film.mp4", "film.jpg")]
        for file in files:
            file.write_bytes(b"moving")
        return Section("The film", "It moves.", video=files[0], poster=files[1], first=True)

    monkeypatch.setattr(filmed, "film_discovery", film_discovery)
    monkeypatch.setattr("inca_mj.commands.discover.cannot_draw", lambda: "")
    assert run("discover", path, "--out", tmp_path) == 0
    said = capsys.readouterr()
    assert f"film:    {tmp_path / 'film.mp4'}" in said.out
    first = said.err.index(f"report: {tmp_path / 'report.html'} (drawn in ")  # can be read by then
    assert first < said.err.index("the film took")
    page = (tmp_path / "report.html").read_text()
    assert page.count("<video") == 1
    assert 0 < page.index("It moves.") < page.index("Parameter set ")
    alone = found().report(tmp_path.parent / "alone.html").read_text()
    titles = [sorted(re.findall(r"<title id=[^>]*>(.*?)</title>", text)) for text in (page, alone)]
    assert titles[0] == titles[1] != []


def test_options_of_a_file_are_passed_on_and_bad_ones_refused(path, tmp_path, outcome, capsys):
    options = tmp_path / "options.toml"
    options.write_text("min_proof_t = 3.0\n")
    assert run("discover", path, "--options", options) == 0
    assert outcome[1] == DiscoveryOptions(min_proof_t=3.0)
    assert run("discover", path) == 0
    assert outcome[1] is None
    capsys.readouterr()
    options.write_text("max_effects = 'two'\n")
    assert run("discover", path, "--options", options) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.count("\n") == 1
    assert "max_effects is 'two'; give a whole number of 1 or more" in said.err


@pytest.mark.usefixtures("undrawn")
def test_the_demo_opens_with_the_verdict_and_ends_with_the_report(path, tmp_path, capsys):
    assert run("demo", path, "--no-film", "--out", tmp_path / "demo") == 0
    out = capsys.readouterr().out
    assert out.startswith("Missing from the model: ")
    assert f"report:  {tmp_path / 'demo' / 'report.html'}" in out
