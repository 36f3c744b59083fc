"""The page of damaged files, interrupts and forecasts says what its records say."""

import json

import pytest
import robustness

FUZZ = [
    {"reader": "log", "seed": 1, "commit": "a", "counts": {"read": 3, "refused": 5}},
    {"reader": "log", "seed": 2, "commit": "a", "counts": {"read": 1, "traceback": 2}},
    {"reader": "run", "seed": 2, "commit": "a", "counts": {"crash": 4}},
    {"reader": "log", "seed": 1, "commit": "b", "counts": {"hang": 1}},
]
STOPS = [
    {"command": "fit", "right": True, "after": 1.0, "seconds": 0.25, "code": 130},
    {"command": "fit", "right": False, "after": 0.04, "seconds": 0.75, "code": -2},
]


def test_the_section_replaces_itself_and_nothing_else(monkeypatch, tmp_path):
    page, results = tmp_path / "page.md", tmp_path / "results"
    results.mkdir()
    for name, rows in (("fuzz", FUZZ), ("interrupts", STOPS)):
        (results / f"{name}.jsonl").write_text("".join(json.dumps(r) + "\n" for r in rows))
    monkeypatch.setattr(robustness, "PAGE", page)
    monkeypatch.setattr(robustness, "RESULTS", results)
    page.write_text(f"before\n{robustness.BEGIN}old\n{robustness.END}behind\n")
    robustness.main()
    once = page.read_text()
    robustness.main()
    assert page.read_text() == once
    assert once.startswith("before\n")
    assert once.endswith("behind\n")
    assert "old" not in once


@pytest.mark.parametrize("name", ["fuzz", "interrupts", "forecast"])
def test_there_is_a_record_of_each(name):
    assert robustness.rows(name)
