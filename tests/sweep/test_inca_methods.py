"""Methods on INCA: worlds are those of their numbers, labels are read, estimates meet the truth."""

import json
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
from identification.sweep.log_methods import METHODS as ROBOT_METHODS
from identification.sweep.log_methods import named_findings
from identification.sweep.method import Seed, load_method
from identification.sweep.work import checked
from inca_mj.robot.parameters import parameter_set
from inca_mj.studies import METHODS
from inca_mj.studies.hidden_worlds import WorldSettings, make_world
from inca_mj.studies.parameters import excitation_findings
from inca_mj.studies.searches import truth_of
from inca_mj.studies.worlds import HiddenSetting, draw_effect, records, world

SEED = Seed(5, (0, 0, 3))


def test_a_null_world_is_that_of_its_number():
    settings = WorldSettings(world=11, kind="null", duration=1.0, rate=50.0, coloured=True)
    (log,), truth = make_world(settings, SEED)
    setting = HiddenSetting(
        input="multisine", duration=1.0, sampling_time=1 / 50, error_rms=5e-4
    )  # fmt: skip
    np.testing.assert_array_equal(log.outputs, world(11, setting=setting).log.outputs)
    assert (truth["kind"], truth["hidden"], truth["ratio"]) == ("null", [], 0.0)


def test_an_effect_that_is_asked_for_is_hidden_with_its_ratio():
    settings = WorldSettings(world=4, kind="listed", effect="quadratic_friction", ratio=5.0,
                             duration=1.0, records=2)  # fmt: skip
    logs, truth = make_world(settings, SEED)
    made = records(
        4, [draw_effect("quadratic_friction", 4)], n=2, ratio=5.0,
        inputs=("prbs", "multisine", "prbs"), setting=HiddenSetting(duration=1.0),
    )  # fmt: skip
    for ours, theirs in zip(logs, made, strict=True):
        np.testing.assert_array_equal(ours.outputs, theirs.log.outputs)
    assert truth["hidden"] == ["quadratic_friction"]
    assert truth["hidden_size_of"] == ["quadratic_friction.c@all drives"]
    assert truth["hidden_sizes"] == [made[0].truth.effects[0].c]


def test_labels_are_read(tmp_path, refusal):
    label = {"kind": "pair", "effects": ["cogging", "delay"], "ratio": 20, "where": [3, None],
             "size": {"cog_c": 0.01, "cog_s": -0.02, "delay": 0.004, "other": 1.0}}  # fmt: skip
    (tmp_path / "labels.json").write_text(json.dumps({"log_1": label}))
    truth = truth_of(tmp_path / "log_1.csv")
    sizes = dict(zip(truth["hidden_size_of"], truth["hidden_sizes"], strict=True))
    assert sizes == {"cogging.a@drive 3": 0.01, "cogging.b@drive 3": -0.02, "delay.tau@": 0.004}
    assert truth["hidden_where"] == ["drive 3", ""]
    assert "has no label of log_2" in refusal(truth_of, tmp_path / "log_2.csv")


def test_an_excitation_is_the_information_of_its_robot():
    from inca_mj.twin.run import simulate
    from inca_mj.twin.twin import build_twin
    from inca_mj.workflows.excitation import Bench
    from inca_mj.workflows.identification import UNKNOWN
    from inca_mj.workflows.limits import Limits
    from inca_mj.workflows.recipes import SAMPLING, standard_inputs

    method = load_method(METHODS["excitation"])
    name, currents = standard_inputs(51)[6]
    settings = method.settings(input=name, duration=0.5, spread=0.0)
    record = checked(method.run(settings, SEED), method.columns)
    robot = build_twin(parameter_set("trial"), visual=False)
    bench = Bench(robot, settings.noise, UNKNOWN, Limits())
    found = bench.attempt(name, simulate(robot, currents, SAMPLING)).found
    np.testing.assert_allclose(record["std"], found.std, rtol=1e-12)
    assert record["names"] == [*UNKNOWN]
    told = excitation_findings([{**record, "set.input": name}] * 2).record["inputs"][name]
    assert told["worst_std"] == pytest.approx(found.e_value**-0.5)


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
    here, there = (run(place / "fits.toml", place / "out", known=ROBOT_METHODS)
                   for place in (folder, moved))  # fmt: skip
    assert here[:1] == there[:1]


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
