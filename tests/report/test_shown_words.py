"""What a log would have shown: every effect once, with its place, and the hardest to see first."""

from dataclasses import replace

import fake_discovery
import numpy as np
import pytest
from fake_discovery import fit

from identification.discovery.effect_results import Detectable
from identification.effects.effect import Candidate, Effect
from identification.effects.sizes import Size
from identification.model.parameter import with_own
from identification.report.discovery_json import discovery_to_json
from identification.report.discovery_sections import parameters_section
from identification.report.effect_words import describe_parameter, parameter_words, words_of
from identification.report.fitted_values import FEW as FEW_PARTS
from identification.report.fitted_values import shown_values, unknown_shares
from identification.report.shown_words import (
    FEW,
    LISTED,
    shown_effects,
    shown_lines,
    shown_rows,
    shown_sentences,
)
from inca_mj.robot.parameters import parameter_set
from inca_mj.robot.spread import with_spread


def effect(name, *sizes):
    made = Effect(name, "-f", sizes or (Size("f", "N", 2.0, 0.01),), places={"joint hip": "@hip"})
    return Candidate(made, "joint hip", {})


def one(name, smallest):
    return Detectable(effect(name), "f", smallest, "N")


MANY = [one(f"law_{k}", 0.01 * (k + 1)) for k in range(60)]
BLIND = [one("creep", np.inf), one("backlash", 3.0)]


def test_every_line_has_a_place_and_few_have_one():
    lines = shown_lines([*MANY, *BLIND])
    assert len(lines) == len(BLIND) + LISTED + 4  # two headings, what has no line, and where
    told = [line for line in lines if (line.startswith("  ") and "law_" in line) or "creep" in line]
    assert all("joint hip" in line for line in told)
    assert "  creep, joint hip" in lines
    assert "  law 59, joint hip: f from 0.600 N on (plausible up to 2 N)" in lines
    (rest,) = (line for line in lines if "more effects" in line)
    assert rest.startswith("  and 52 more effects, which show from 26 % of the largest plausible")


def test_the_hardest_is_first_and_what_never_shows_before_it():
    seen, never = shown_effects([*MANY, *BLIND])
    names = [s.sizes[0].candidate.effect.name for s in (*never, *seen)]
    assert names == ["creep", "backlash", *(f"law_{k}" for k in reversed(range(60)))]


def test_the_table_has_every_effect_and_the_paragraph_what_matters():
    rows = shown_rows([*MANY, *BLIND])
    assert len(rows) == 62
    assert rows[1] == ("backlash, joint hip", "not by this log", "2 N")
    assert rows[2] == ("law 59, joint hip", "0.600 N", "2 N")
    said = shown_sentences([*MANY, *BLIND])
    assert "creep, joint hip; backlash, joint hip." in said
    assert said.count("law ") == FEW
    assert "Hardest to see of the others: law 59" in said
    assert shown_sentences(MANY).startswith("Hardest to see: law 59")


COMMON = ("R", "K_t", "stribeck_friction.f_s", "torque_constant_mismatch.delta@3")


def rows(names):
    return [[name, "0 %"] for name in names]


def test_the_worst_known_are_shown_and_their_number_is_told():
    parts = [f"K_t@{k}" for k in range(1, 9)] + [f"exit_x@{k}" for k in range(1, 9)]
    rng = np.random.default_rng(0)
    shares = dict(zip(parts, rng.permutation(np.linspace(0.1, 0.9, 16)).tolist(), strict=True))
    shown, said = shown_values(rows((*COMMON, *parts)), shares)
    names = [row[0] for row in shown]
    assert names[: len(COMMON)] == [*COMMON]
    left_out = {*parts} - {*names}
    assert len(left_out) == len(parts) - FEW_PARTS
    assert min(shares[n] for n in names[len(COMMON) :]) > max(shares[n] for n in left_out)
    assert "Of 16 deviations" in said
    assert "report" in said


def test_what_a_log_does_not_tell_has_the_std_that_was_known_before():
    found = fit({"b_v": 2e-4, "x": 0.0})
    space = replace(found.point.space, names=("K_t@3", "stribeck_friction.delta@3"))
    point = replace(found.point, space=space)
    priors = replace(found.priors, weight=np.array([50.0, 1.0]))
    left = unknown_shares(replace(found, point=point, std=np.array([0.02, 0.1]), priors=priors))
    assert left == {"K_t@3": pytest.approx(1.0)}


EVERY = with_spread(parameter_set())


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("lambda", "cable elasticity λ"),
        ("lambda@5", "cable elasticity λ, drive 5"),
        ("K_t@3", "torque constant K_t, drive 3"),
        ("I_x", "platform inertia I_x"),
        ("exit_x@2", "exit point A, cable 2, along x"),
    ],
)
def test_a_parameter_is_said_in_words_with_its_letter_and_its_place(name, said):
    assert describe_parameter(EVERY[name]) == said


def test_words_tell_all_parameters_of_the_robot_apart_and_none_is_a_raw_name():
    words = parameter_words(EVERY)
    assert len({*words.values()}) == len(words) > 100
    assert not [w for w in words.values() if "@" in w or w in words]


def test_values_of_single_records_are_told_apart():
    own = with_own(EVERY, ("x", "yaw"), 3)
    words = parameter_words(own)
    assert words["x [2]"] == "start position x, record 2"
    assert words["yaw [3]"] == "start yaw ψ_p, record 3"
    assert len({*words.values()}) == len(words)


def test_tables_have_the_words_and_json_has_the_names():
    found = fake_discovery.found()
    words = words_of(found)
    first = [row[0] for row in parameters_section(found).table.rows]
    assert first[0] == "viscous friction b_v"
    assert "f_s, friction – Stribeck peak, all drives" in first
    assert "v_s, friction – Stribeck peak" in first
    assert {*first} <= {*words.values()}
    assert discovery_to_json(found)["effects"][0]["retuned"]["parameter"] == "m"
