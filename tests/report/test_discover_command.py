"""inca discover as a user meets it, what it finds being given."""

import json
import sys
from types import ModuleType

import pytest
from fake_discovery import EFFECTS, found, log

from identification import write_log
from inca_mj.cli import main
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
