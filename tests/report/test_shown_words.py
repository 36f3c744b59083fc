"""What a log would have shown: every effect once, with its place, and the hardest to see first."""

import numpy as np
import pytest

from identification.discovery.effect_results import Detectable
from identification.effects.effect import Candidate, Effect, Size
from identification.report.shown_words import (
    FEW,
    LISTED,
    shown_effects,
    shown_lines,
    shown_rows,
    shown_sentences,
)


def effect(name: str, *sizes: Size) -> Candidate:
    made = Effect(name, "-f", sizes or (Size("f", "N", 2.0, 0.01),), places={"joint hip": "@hip"})
    return Candidate(made, "joint hip", {})


def one(name: str, smallest: float) -> Detectable:
    return Detectable(effect(name), "f", smallest, "N")


MANY = [one(f"law_{k}", 0.01 * (k + 1)) for k in range(60)]
BLIND = [one("creep", np.inf), one("backlash", 3.0)]


def test_every_line_has_a_place_and_few_have_one() -> None:
    lines = shown_lines([*MANY, *BLIND])
    assert len(lines) == len(BLIND) + LISTED + 4  # two headings, what has no line, and where
    told = [line for line in lines if (line.startswith("  ") and "law_" in line) or "creep" in line]
    assert all("joint hip" in line for line in told)
    assert "  creep, joint hip" in lines
    assert "  law 59, joint hip: f from 0.600 N on (plausible up to 2 N)" in lines
    (rest,) = (line for line in lines if "more effects" in line)
    assert rest.startswith("  and 52 more effects, which show from 26 % of the largest plausible")


def test_the_hardest_is_first_and_what_never_shows_before_it() -> None:
    names = [s.candidate.effect.name for s in shown_effects([*MANY, *BLIND])]
    assert names == ["creep", "backlash", *(f"law_{k}" for k in reversed(range(60)))]


def test_the_table_has_every_effect_and_the_paragraph_what_matters() -> None:
    rows = shown_rows([*MANY, *BLIND])
    assert len(rows) == 62
    assert rows[1] == ("backlash, joint hip", "not by this log", "2 N")
    assert rows[2] == ("law 59, joint hip", "0.600 N", "2 N")
    said = shown_sentences([*MANY, *BLIND])
    assert "creep, joint hip; backlash, joint hip." in said
    assert said.count("law ") == FEW
    assert "Hardest to see of the others: law 59" in said
    assert shown_sentences(MANY).startswith("Hardest to see: law 59")


def test_an_effect_of_two_sizes_has_one_line() -> None:
    sizes = Size("a", "rad", 0.1, 1e-3), Size("b", "rad", 0.1, 1e-3)
    c = effect("disc", *sizes)
    pair = [Detectable(c, "a", 0.01, "rad"), Detectable(c, "b", np.inf, "rad")]
    (row,) = shown_rows(pair)
    assert row[1] == "a 10 mrad; b at no plausible size"
    (_, line, _) = shown_lines(pair)
    assert line == "  disc, joint hip: a from 10 mrad on (plausible up to 0.100 rad)"


@pytest.mark.parametrize("smallest", [1e-3, np.inf])
def test_a_size_without_a_largest_one(smallest: float) -> None:
    c = effect("drift", Size("d", "N", np.inf, 0.01))
    (shown,) = shown_effects([Detectable(c, "d", smallest, "N")])
    assert shown.is_seen == np.isfinite(smallest)


def test_nothing_is_said_of_nothing() -> None:
    assert shown_lines([]) == []
    assert shown_sentences([]) == ""
