"""The logs of the small robots are those of their script, and each robot reads its own."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

FOLDER = Path(__file__).parents[2] / "examples" / "linkages"
spec = importlib.util.spec_from_file_location("linkages_record", FOLDER / "record.py")
script = importlib.util.module_from_spec(spec)
spec.loader.exec_module(script)


@pytest.mark.parametrize("name", [*script.ROBOTS])
def test_the_logs_are_those_of_the_script(name):
    path = FOLDER / name / "first.csv"
    table, header = script.record(path.with_name("model.xml"), script.ROBOTS[name], 1)
    assert path.read_text().partition("\n")[0] == header
    assert np.loadtxt(path, delimiter=",", skiprows=1) == pytest.approx(table, abs=2e-6)
    assert sum(each.stat().st_size for each in path.parent.iterdir()) < 300_000
