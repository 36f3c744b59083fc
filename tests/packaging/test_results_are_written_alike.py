"""A result of Python writes what the command writes, and what was saved is read again."""

import json
import re
from dataclasses import replace
from functools import cache
from pathlib import Path

import fake_discovery
import numpy as np
import pytest
from elbow_cases import ELBOW, elbow, fitted
from folder_cases import content, made
from page_text import text_of

from identification import (
    NominalModel,
    SavedDiscovery,
    SavedFit,
    discover,
    load,
)
from identification.commands.cli import main
from identification.robot import discovery, fitting
from identification.storage.shown import verdict_of

ROOT = Path(__file__).parents[2]
LINE = [ELBOW / "elbow.toml", ELBOW / "first.csv", "--confirm", ELBOW / "second.csv"]


@cache
def by_hand():
    """A discovery on a nominal model that no file describes."""
    robot = elbow()[0]
    model = robot.nominal_model
    assert isinstance(model, NominalModel)
    effects = [e for e in robot.candidates if e.name == "coulomb_friction"]
    return discover(model, robot.log, effects)


RESULTS = {
    "discover": lambda: elbow()[1],
    "fit": fitted,
    "INCA": lambda: fake_discovery.found(several=True),
    "nothing": lambda: fake_discovery.found("nothing missing"),
}


@pytest.fixture(params=RESULTS)
def result(request):
    return RESULTS[request.param]()


@pytest.mark.parametrize("command", ["discover", "fit"])
def test_python_saves_what_the_command_saves(command, tmp_path, monkeypatch, capsys):
    # a copy, whose figures no other test has drawn: a second drawing moves them by a pixel
    found = replace(RESULTS[command]())
    monkeypatch.setattr(discovery, "discover", lambda *_, **__: found)
    monkeypatch.setattr(fitting, "fit", lambda *_, **__: found)
    assert main([command, *map(str, LINE), "--json", "--out", str(tmp_path / "theirs")]) == 0
    assert found.save(tmp_path / "ours") == tmp_path / "ours"
    assert json.loads(capsys.readouterr().out) == found.to_dict()
    ours, theirs = (content(tmp_path / name) for name in ("ours", "theirs"))
    assert {"result.json", "report.html", "robot.toml"} < {*ours} == {*theirs}
    mine, other = (json.loads(each.pop("result.json")) for each in (ours, theirs))
    assert mine.pop("configuration") == {}
    assert other.pop("configuration")
    assert mine == other
    assert ours == theirs


@pytest.mark.usefixtures("undrawn")
def test_a_report_is_one_file_that_begins_with_the_verdict(result, tmp_path):
    assert result.report(tmp_path / "one.html") == tmp_path / "one.html"
    assert [p.name for p in tmp_path.iterdir()] == ["one.html"]
    page = text_of((tmp_path / "one.html").read_text())
    verdict = result.to_dict()["verdict"]
    first = verdict[0] if isinstance(verdict, list) else verdict_of(result)[0]
    assert first in page
    assert "<video" not in page


@pytest.mark.usefixtures("undrawn")
def test_what_was_saved_is_read_again_from_the_folder_or_its_file(result, tmp_path):
    folder = result.save(tmp_path / "out")
    saved = load(folder)
    assert saved == load(folder / "result.json")
    record = saved.to_dict()
    assert {*result.to_dict()} < {*record}
    assert len(repr(saved)) < 2000
    if isinstance(saved, SavedFit):
        assert (saved.values, saved.start) == (result.values, result.start)
        assert saved.at_bound == result.at_bound
        np.testing.assert_array_equal([*saved.std.values()], [*result.std.values()])
        assert [*saved.verdict] == record["verdict"]
        return
    assert isinstance(saved, SavedDiscovery)
    assert repr(saved) == repr(result)
    assert saved._repr_html_() == result._repr_html_()
    older = {name: each for name, each in record.items() if name != "sentences"}
    assert repr(replace(saved, record=older)).startswith(result.verdict)
    assert (saved.verdict, saved.unexplained) == (result.verdict, result.unexplained)
    assert saved.values == dict(result.final.told_values)
    for mine, theirs in zip(saved.named, result.named, strict=True):
        names = "name", "where", "confidence", "parameters"
        assert [getattr(mine, n) for n in names] == [getattr(theirs, n) for n in names]
        assert [(r.name, r.where, r.confidence) for r in mine.rivals] == [
            (r.name, r.where, r.confidence) for r in theirs.rivals
        ]
    assert [(r.name, r.where) for r in saved.rejected] == [r.candidate.key for r in result.rejected]


def test_the_examples_of_the_documents_write_and_read(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    page = (ROOT / "docs" / "robot" / "index.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```", page, re.M | re.S)
    names = {"found": elbow()[1]}
    for block in (b for b in blocks if "found.save" in b or "load(" in b):
        exec(compile(block, "example", "exec"), names)
    said = capsys.readouterr().out
    assert names["saved"].named
    assert all(f"{named.name} {named.where}" in said for named in elbow()[1].named)
    assert {p.name for p in tmp_path.iterdir()} == {"report.html", "results"}


@pytest.mark.usefixtures("undrawn")
def test_a_search_on_a_model_by_hand_saves_its_numbers_and_its_report(tmp_path):
    found = by_hand()
    assert found.report(tmp_path / "one.html").stat().st_size > 1000
    assert found.verdict in found.to_dict()["verdict"]
    names = {p.name for p in found.save(tmp_path / "out").iterdir()}
    assert {"result.json", "report.html"} < names
    assert not {"robot.toml", "model.xml"} & names


@pytest.mark.usefixtures("undrawn")
def test_saving_replaces_results_and_no_file_of_anybody_else(tmp_path, refusal):
    found = fitted()
    found.save(tmp_path / "out")
    found.save(tmp_path / "out")
    made(tmp_path / "mine", **{"notes.txt": "mine"})
    (tmp_path / "mine" / "notes.txt").write_text("changed")
    said = refusal(found.save, tmp_path / "mine")
    assert "holds notes.txt, not made there by this program" in said
    assert "choose a new or an empty folder" in said


def test_what_is_no_result_is_refused(tmp_path, refusal):
    assert "no such file" in refusal(load, tmp_path)
    path = tmp_path / "result.json"
    path.write_text("[1]")
    assert "holds no JSON object; give a folder that found.save(folder)" in refusal(load, path)
    path.write_text('{"fit_percent": []}')
    assert "which has the keys verdict, effects and rejected or verdict and" in refusal(load, path)
    path.write_text(
        '{"verdict": "named", "effects": [{"name": 1}], "rejected": [], "unexplained": false}'
    )
    assert "is damaged or was changed (KeyError: 'where')" in refusal(load, path)
