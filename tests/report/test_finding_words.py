"""Every kind of finding has words and plain values."""

import ast
import json
from pathlib import Path

import pytest
from finding_cases import EVIDENCE_OF, FINDINGS

from identification.discovery.findings.finding import Finding, FindingKind
from identification.report.discovery_json import finding_to_json
from identification.report.finding_words import (
    FOLLOWED,
    HOLDS,
    REGRESSORS,
    describe_finding,
    sentence,
)

SAYS = {
    FindingKind.WORST_OUTPUT: "largest on angle_5: 14.3 mrad rms, 16 % of the power",
    FindingKind.WORST_INTERVAL: "from 2.0 to 3.0 s (25 %",
    FindingKind.MEDIAN_FREQUENCY: "below 0.4 Hz",
    FindingKind.MISSING_FORCE: "4.9 mN and 310 µN m rms on platform would explain 97 %",
    FindingKind.INPUT_HOLD: 'only 2 mA rms and not by 50 mA (if they did, write hold = "foh"',
    FindingKind.SPECTRAL_LINE: "of angle_2 have a line at 2.30 Hz that no candidate explains (ch",
    FindingKind.CORRELATED_INNOVATIONS: "26 % of their power follows from the samples before",
    FindingKind.PARAMETERS_AT_LIMIT: "the parameters b_v and J end at the limit of what",
    FindingKind.LARGE_INPUT_ERROR: "not in the log, 90 mA rms (35 % of their own motion)",
    FindingKind.ROBOT_CHANGE: "from about 10.5 s on the unseen samples are predicted worse",
    FindingKind.UNEXPECTED_ERROR: "is 9.4 times what the sensors, unlogged disturbances and",
    FindingKind.STRUCTURED_INPUT_ERROR: "follows the rate of its output, most of all on current_3",
    FindingKind.DOUBTFUL_EFFECT: "tau = 250 ± 100 µs (delay), explains",
    FindingKind.OVERSIZED_EFFECT: "tau = 0.300 s where 0.100 s is the largest plausible value",
    FindingKind.REMAINING_ERROR: "error of x on unseen data that is 7.1 times its sensor's noise",
    FindingKind.DIFFERENT_RECORD: "c.csv is predicted 4.2 times worse",
    FindingKind.SHIFTED_RECORD: "inputs of record c.csv seem to act 14.0 ± 3.0 ms earlier than",
    FindingKind.WORSE_FIT: "worse than those of the model (mean square 9 times as large)",
    FindingKind.UNPROVEN_EFFECT: "body – centre of mass displaced, body arm, predicts unseen data "
    "better on average (mean square -20 %, t = 1.9), but is not proven: so",
}


@pytest.mark.parametrize("kind", FindingKind)
def test_every_kind_has_a_clause_with_its_numbers(kind):
    clause = describe_finding(Finding(kind, EVIDENCE_OF[kind]))
    assert SAYS[kind] in clause
    assert "nan" not in clause
    said = sentence(clause)
    assert said.endswith(".")
    assert said[0] == said[0].upper()


def test_the_clauses_differ():
    assert len({describe_finding(f) for f in FINDINGS}) == len(FindingKind)


@pytest.mark.parametrize("kind", FindingKind)
def test_every_kind_is_written_with_its_numbers_and_no_sentence(kind):
    record = json.loads(json.dumps(finding_to_json(Finding(kind, EVIDENCE_OF[kind]))))
    assert record.pop("kind") == kind.value
    assert record


EVIDENCES = ("innovations", "prediction")


def strings(path, function):
    """The names that a function of discovery gives to what it lists."""
    module = Path(__file__).parents[2] / "identification" / path
    tree = ast.parse(module.read_text(encoding="utf-8"))
    (body,) = (n for n in ast.walk(tree) if isinstance(n, ast.FunctionDef) and n.name == function)
    body.body = body.body[1:]  # without its docstring
    return {n.value for n in ast.walk(body) if isinstance(n, ast.Constant)
            and isinstance(n.value, str)}  # fmt: skip


def test_every_regressor_and_every_hold_has_words():
    assert strings("discovery/missing_forces.py", "list_regressors") == set(REGRESSORS)
    assert strings("innovations/input_error.py", "list_families") == set(FOLLOWED)
    assert set(HOLDS) == {"foh", "zoh"}


def test_discovery_knows_no_words():
    rooms = [Path(__file__).parents[2] / "identification" / r for r in ("discovery", *EVIDENCES)]
    for path in (path for room in rooms for path in room.rglob("*.py")):
        assert "identification.report" not in {
            ".".join((n.module or "").split(".")[:2])
            for n in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
            if isinstance(n, ast.ImportFrom)
        }, path
