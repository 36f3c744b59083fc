"""Every key that a command prints with --json is on the page that explains them."""

import json
import re
from dataclasses import replace
from pathlib import Path

import fake_discovery
import pytest
from finding_cases import FINDINGS

from identification import write_log
from identification.discovery.findings.finding import FindingKind
from identification.report.discovery.json import finding_to_json
from inca_mj.cli import main
from inca_mj.robot.inputs import make_input
from inca_mj.twin.logs import run_to_log
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import build_twin

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "json.md").read_text(encoding="utf-8")
BY_NAME = (
    "parameters",
    "profiles",
    "options",
    "nominal",
    "final",
)  # their keys are names, explained elsewhere


NESTED = {FindingKind.OVERSIZED_EFFECT: ("value", "std", "unit", "limit")}


def keys_of(value):
    if isinstance(value, list):
        return set().union(*map(keys_of, value))
    if not isinstance(value, dict):
        return set()
    found = set(value)
    for key, inner in value.items():
        is_by_name = key in BY_NAME or key.endswith("_by_unit")
        rows = inner.values() if is_by_name and isinstance(inner, dict) else [inner]
        found |= set().union(*map(keys_of, rows))
    return found


def section(command):
    text = PAGE.split(f"## {command}\n")[1].split("\n## ")[0]
    return set(re.findall(r"`(\w+)`", text))


@pytest.fixture(scope="module")
def short_log(tmp_path_factory):
    log = run_to_log(simulate(build_twin(), make_input("prbs", 0.6, seed=0)), "short")
    path = tmp_path_factory.mktemp("logs") / "short.csv"
    write_log(replace(log, extras={}, units={}), path)
    return path


@pytest.mark.parametrize(
    "arguments", [("compare",), ("identify", "--free", "b_v", "--profile", "b_v", "--starts", "1")]
)
def test_the_page_knows_every_key(arguments, capsys, short_log):
    command, *options = arguments
    assert main([command, str(short_log), *options, "--json"]) == 0
    printed = keys_of(json.loads(capsys.readouterr().out))
    assert printed
    assert printed <= section(command)


def test_the_page_knows_every_key_of_a_discovery():
    printed = keys_of(fake_discovery.found(one_of=True, unexplained=True).to_dict())
    assert {"proof", "rivals", "smallest", "gain"} <= printed
    assert printed <= section("discover")


@pytest.mark.parametrize("finding", FINDINGS, ids=lambda f: f.kind)
def test_the_page_knows_the_keys_of_every_kind_of_finding(finding):
    record = finding_to_json(finding)
    rows = re.findall(rf"^\| {finding.kind} \| (.*) \|$", PAGE, re.MULTILINE)
    assert len(rows) == 1
    assert set(record) - {"kind"} == set(re.findall(r"`(\w+)`", rows[0].split(" as in ")[0])) - {
        "null", *NESTED.get(finding.kind, ())
    }  # fmt: skip
