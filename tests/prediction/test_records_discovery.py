"""From records to a verdict: a hidden law is named, an empty one is not, and what is refused."""

import json
from dataclasses import replace

import pytest
from records_cases import MJCF, nominal_model, pendulum, records

from identification import write_log
from identification.__main__ import main
from identification.effects.joint_plant import candidates
from identification.prediction.discovery import discover_records
from identification.report.finding_words import describe_finding
from identification.report.records_text import records_text

MU = "transmitted_load_friction.mu@hinge"
FEW = ("transmitted_load_friction", "gravity_load_friction", "quadratic_friction", "offset")


def found(values, names=FEW, count=4):
    logs = records(count, values)
    effects = [e for e in candidates(pendulum(), ("J", "d")) if e.name in names]
    return discover_records(nominal_model(), logs[:2], logs[2:], effects)


def test_friction_under_the_transmitted_load_is_named_with_its_size():
    answer = found({MU: 0.15})
    assert answer.verdict == "named"
    (named,) = answer.named
    assert named.effect.candidate.effect.name == "transmitted_load_friction"
    value, std, _ = named.effect.parameters["mu"]
    assert abs(value - 0.15) < 4 * std
    assert std < 0.02
    assert len(named.agrees) == 2
    assert named.disagrees == ()
    assert answer.share > 0.9
    assert "grows with the transmitted load" in records_text(answer)


def test_records_without_an_effect_get_no_name():
    answer = found(None)
    assert answer.named == ()
    assert answer.verdict == "nothing missing"
    assert "Nothing is missing" in records_text(answer)


def test_a_law_that_is_not_in_the_list_is_not_called_by_another_name():
    answer = found({MU: 0.15}, names=("offset",))
    assert answer.named == ()


def test_findings_have_words():
    answer = found({MU: 0.15})
    assert all(describe_finding(f) for f in answer.findings)


def test_a_horizon_is_needed(refusal):
    base, logs = replace(nominal_model(), horizon=None), records(2)
    assert "horizon" in refusal(discover_records, base, logs[:1], logs[1:], [])


TOML = """
model = "pendulum.xml"
free = ["J", "d"]
horizon = 0.2
[parameters.J]
path = "joint/hinge.armature"
value = 1.5e-3
unit = "kg m^2"
[parameters.d]
path = "joint/hinge.damping"
value = 0.03
unit = "N m s/rad"
[effects]
only = ["transmitted_load_friction", "offset"]
"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "pendulum.xml").write_text(MJCF)
    (tmp_path / "robot.toml").write_text(TOML)
    for k, log in enumerate(records(4, {MU: 0.15})):
        write_log(log, tmp_path / f"log_{k}.csv")
    return tmp_path


def test_the_command_takes_several_logs_and_several_confirm_flags(folder, capsys):
    logs = [str(folder / f"log_{k}.csv") for k in range(4)]
    arguments = ["discover", str(folder / "robot.toml"), *logs[:2], "--confirm", logs[2]]
    out = folder / "out"
    code = main([*arguments, "--confirm", logs[3], "--json", "--out", str(out)])
    record = json.loads(capsys.readouterr().out)
    assert code == 0
    assert record["verdict"] == "named"
    assert [r["role"] for r in record["records"]] == ["fit", "fit", "confirm", "confirm"]
    assert record["effects"][0]["name"] == "transmitted_load_friction"
    assert all(r["after"] < r["before"] for r in record["records"])
    assert {p.name for p in out.iterdir()} >= {"report.html", "result.json", "robot.toml"}
