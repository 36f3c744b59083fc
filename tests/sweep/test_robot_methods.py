"""A folder of logs of any robot: each record is what the function on one log gives."""

from shutil import copytree

import numpy as np
import pyarrow.dataset
import pytest
from fake_discovery import found
from joint_cases import SLIDER
from robot_cases import TOML, simulated
from sweep_cases import run

from identification import fit as fit_robot
from identification import read_robot, write_log
from identification.__main__ import main
from identification.sweep.answers import ANSWER, PROOF, answer, nested, proof
from identification.sweep.methods import METHODS
from identification.sweep.methods.discover_log import named_findings
from identification.sweep.work import checked

SWEEP = """
[[study]]
method = "fit-log"
[study.settings]
robot = "slider.toml"
[study.grid]
log = { files = "logs/*.csv" }
"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "slider.xml").write_text(SLIDER)
    (tmp_path / "slider.toml").write_text(TOML)
    (tmp_path / "logs").mkdir()
    for seed in (1, 2):
        log = simulated({"damping": 3.6, "mass": 1.8}, samples=300, seed=seed)
        write_log(log, tmp_path / "logs" / f"{seed}.csv")
    (tmp_path / "logs" / "3.csv").write_text("no log\n")
    (tmp_path / "fits.toml").write_text(SWEEP)
    return tmp_path


def test_each_log_of_a_folder_is_fitted(folder):
    line = ["sweep", str(folder / "fits.toml"), "--backend", "serial", "--out", str(folder / "out")]
    assert main(line) == 0
    rows = pyarrow.dataset.dataset(folder / "out" / "records").to_table().sort_by("task")
    first, second, bad = rows.to_pylist()
    assert bad["error"].startswith("InputError: ")
    for row, name in ((first, "1"), (second, "2")):
        fitted = fit_robot(read_robot(folder / "slider.toml", folder / "logs" / f"{name}.csv"))
        assert dict(zip(row["names"], row["estimated"], strict=True)) == fitted.values
        np.testing.assert_array_equal(row["std"], [*fitted.std.values()])
        assert row["set.log"] == f"logs/{name}.csv"
        assert row["after"] <= row["before"]
    assert (folder / "out" / "report.html").exists()


def test_the_same_folder_elsewhere_gives_the_same_records(folder, tmp_path_factory):
    (folder / "logs" / "2.csv").unlink()
    moved = copytree(folder, tmp_path_factory.mktemp("moved") / "robot")
    here, there = (run(place / "fits.toml", place / "out", known=METHODS)
                   for place in (folder, moved))  # fmt: skip
    assert here[:1] == there[:1]


@pytest.mark.parametrize("method", ["fit-log", "discover-log"])
@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('{ files = "logs/*.csv" }', '["logs/1.csv", "logs/4.csv"]', "logs/4.csv, which does not"),
        ("logs/*.csv", "logs/*.mat", "no file matches"),
        ("slider.toml", "cart.toml", "robot in study"),
        ("slider.toml", ".", "is a folder"),
    ],
)
def test_a_file_that_is_not_there_is_refused_before_anything_runs(
    folder, capsys, method, old, new, words
):
    text = SWEEP.replace("fit-log", method).replace(old, new)
    (folder / "fits.toml").write_text(text)
    line = ["sweep", str(folder / "fits.toml"), "--out", str(folder / "out")]
    assert main(line) == 2
    said = capsys.readouterr().err
    assert words in said
    assert len(said.splitlines()) == 1
    assert not (folder / "out").exists()


def test_a_summary_needs_the_records_alone(folder, capsys):
    for file in (folder / "logs").iterdir():
        file.write_text("no log\n")
    text = SWEEP.replace('{ files = "logs/*.csv" }', '["logs/1.csv", "logs/2.csv"]')
    (folder / "fits.toml").write_text(text)
    line = ["sweep", str(folder / "fits.toml"), "--backend", "serial", "--out", str(folder / "out")]
    assert main(line) == 1  # every task met an error, which is a record too
    (folder / "logs" / "2.csv").unlink()
    assert main([*line, "--resume"]) == 2
    assert main([*line, "--summary"]) == 1
    assert "2 of 2 tasks have a record" in capsys.readouterr().out


@pytest.mark.parametrize("one_of", [False, True])
def test_a_discovery_is_told_as_its_json_tells_it(one_of):
    discovery = found(one_of=one_of, several=True)
    record = checked({**answer(discovery), **proof(discovery)}, {**ANSWER, **PROOF})
    names = [n.candidate.effect.name for n in discovery.named]
    assert record["named"] == names
    assert record["confidence"] == [n.confidence for n in discovery.named]
    assert [bool(rivals) for rivals in record["rivals"]] == [n.one_of for n in discovery.named]
    truth = {"kind": "single", "ratio": 3.0, "hidden": names[:1], "hidden_where": [""],
             "hidden_size_of": [], "hidden_sizes": [], "other_shape": False}  # fmt: skip
    row = nested({**record, **truth, "run.processor_seconds": 1.0})
    for told, named in zip(row["answer"]["named"], discovery.named, strict=True):
        assert told["where"] == named.candidate.where
        assert told["sizes"] == {name: p[0] for name, p in named.parameters.items()}
    counted = named_findings([record, record | {"named": [], "where": [], "verdict": "nothing"}])
    assert counted.record["answers"]["nothing"] == 1
    assert sum(counted.record["answers"].values()) == len(names) + 1
