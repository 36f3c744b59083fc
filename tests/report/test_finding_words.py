"""Every kind of finding has words and plain values."""

import ast
from pathlib import Path

import pytest
from finding_cases import EVIDENCE_OF

from identification.discovery.findings.finding import Finding, FindingKind
from identification.report.discovery.finding_words import (
    FOLLOWED,
    HOLDS,
    REGRESSORS,
    describe_finding,
    sentence,
)
from identification.report.words.effects import SCATTERS, doubt_words


@pytest.mark.parametrize("kind", FindingKind)
def test_every_kind_has_a_clause_with_its_numbers(kind):
    clause = describe_finding(Finding(kind, EVIDENCE_OF[kind]))
    assert "nan" not in clause
    said = sentence(clause)
    assert said.endswith(".")
    assert said[0] == said[0].upper()


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


@pytest.mark.parametrize(("luck", "asked", "is_luck"), [
    (0.2, 0.01, True), (0.02, 0.01, True), (1.8e-4, 0.01, False), (0.02, 0.05, False),
])  # fmt: skip
def test_no_chance_that_counts_as_proof_is_called_luck(luck, asked, is_luck):
    """Such a gain differs too much from block to block, whatever its chance is."""
    said = doubt_words("chance", luck, asked)
    assert ("may be luck (chance" in said) == is_luck
    assert (said == SCATTERS) != is_luck
