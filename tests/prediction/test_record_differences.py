"""What differs between records is told, and neither named nor in the way of what is missing."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from records_cases import listed, nominal_model, pendulum, record, search
from test_contenders import OPTIONS, contender, effect

from identification.discovery.candidates import list_common
from identification.discovery.findings.finding import FindingKind
from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Candidate, in_each_record
from identification.prediction.discovery import WINDOWS, discover_records
from identification.prediction.judging.judging import judged
from identification.prediction.judging.odds import find_odds
from identification.prediction.moves import likeliest_of_set as moves
from identification.prediction.moves.add_set import with_one
from identification.prediction.moves.likeliest_of_set import (
    is_alike,
    laws_of_records,
    likeliest_of_set,
)
from identification.prediction.scoring.scores import WindowScore
from identification.prediction.scoring.screening import at_several, felt_places
from identification.prediction.selection.edges import without_edges
from identification.prediction.selection.selection import STRONG_BIC, ranked
from identification.prediction.task import RecordsTask
from identification.prediction.verdict.verdict import conclude
from identification.report.discovery.horizon_gap import find_gap
from identification.report.discovery.json import discovery_to_json
from identification.report.discovery.report import discovery_text
from identification.windows.records import as_records

FEW = ("offset", "stiffness", "encoder_offset")
SHIFTS = (0.02, -0.015, 0.01, -0.02)  # of each record's inputs [s]
ZEROS, PUSHES = (0.08, -0.07, 0.05, -0.09), (0.03, -0.02, 0.01, -0.04)


@cache
def found(each, samples=400, names=FEW, without=()):
    """A search over four records, each of which has values of its own."""
    logs = [record(k + 1, samples, dict(own), plant=pendulum()) for k, own in enumerate(each)]
    return search(logs, names, without=without)


def of_each(name, values):
    return tuple(((name, value),) for value in values)


@pytest.mark.parametrize(
    ("name", "values", "said"),
    [
        ("encoder_offset.c@angle", ZEROS, "its zero differs between the records, sensor angle: by"),
        pytest.param(
            "offset.f_0@hinge",
            PUSHES,
            "constant, and differs between the records, joint hinge: by",
            marks=pytest.mark.long,
        ),
    ],
)
def test_a_value_of_each_record_is_told_and_nothing_is_missing(name, values, said):
    answer = found(of_each(name, values))
    assert answer.verdict == "nothing missing"
    assert answer.named == answer.findings == ()
    (told,) = answer.differences
    assert told.candidate.sizes == (name,)
    for (value, std), true in zip(told.values.values(), values, strict=True):
        assert value == pytest.approx(true, abs=max(5 * std, 5e-3 * abs(true)))
    assert told.spread == pytest.approx(max(values) - min(values), rel=0.03)
    assert said in discovery_text(answer)
    (kept,) = discovery_to_json(answer)["differences"]
    assert len(kept["parameters"]) == 4
    assert answer.before.rms < 1.1 * answer.noise_rms


@pytest.mark.parametrize(
    ("name", "size", "right"),
    [
        ("offset.f_0@hinge", 0.04, "offset"),
        pytest.param("stiffness.k@hinge", 0.1, "stiffness", marks=pytest.mark.long),
    ],
)
def test_what_all_records_have_is_named_and_not_hidden_by_values_of_each(name, size, right):
    answer = found(of_each(name, (size,) * 4))
    assert answer.verdict == "named"
    assert [n.name for n in answer.named] == [right]
    ((value, std, _),) = answer.named[0].parameters.values()
    assert value == pytest.approx(size, abs=max(5 * std, 0.02 * size))
    assert answer.differences == ()


@cache
def clocked(name, values, without=()):
    """A search over four records, whose inputs come at other times than their stamps say."""
    logs = [replace(record(k + 1, 400, {name: v}, plant=pendulum()), name=f"record {k + 1}")
            for k, v in enumerate(values)]  # fmt: skip
    base = replace(nominal_model(), horizon=0.26)  # the inputs jump within windows
    effects = listed("offset", "delay", "time_shift")
    options = DiscoveryOptions(without=without)
    return discover_records(base, logs[:2], logs[2:], effects, options=options)


def test_clocks_that_differ_are_told_and_are_no_name():
    answer = clocked("time_shift.tau@drive", SHIFTS)
    assert answer.verdict == "nothing missing"
    assert answer.named == ()
    (told,) = answer.differences
    for (value, std), true in zip(told.values.values(), SHIFTS, strict=True):
        assert value == pytest.approx(true, abs=max(5 * std, 1e-3))
    said = discovery_text(answer)
    assert "its time stamps are shifted, input drive: by" in said
    assert "between two of them" not in said
    assert "tau is how much later it acts than its stamps say" in said


@pytest.mark.parametrize("name", ["delay.tau@drive", "time_shift.tau@drive"])
def test_inputs_that_come_late_in_all_records_alike_are_named_and_no_clock_doubts_it(name):
    answer = clocked(name, (0.015,) * 4)
    (named,) = answer.named
    assert named.candidate.effect.name == "delay"
    assert named.rivals == ()
    assert answer.differences == ()


def test_inputs_that_come_early_in_all_records_alike_are_a_matter_of_clocks():
    answer = clocked("time_shift.tau@drive", (-0.015,) * 4)
    assert answer.named == ()
    (told,) = answer.differences
    assert all(v == pytest.approx(-0.015, abs=1e-3) for v, _ in told.values.values())


def with_shift(*shifts, effects=("time_shift", "delay")):
    """A search's state whose model has a shift of each of some records; the last one confirms."""
    logs = [replace(record(k, 600, {"time_shift.tau@drive": s}, plant=pendulum()), name=f"{k}")
            for k, s in enumerate(shifts, 1)]  # fmt: skip
    base = replace(nominal_model(), horizon=0.26)  # the inputs jump within windows
    task = RecordsTask(
        nominal_model=base, records=as_records(logs[:-1], logs[-1:]),
        effects=listed(*effects), options=DiscoveryOptions(),
    )  # fmt: skip
    state = WINDOWS.begin(task, print)
    best = max((s for s in state.scores if s.candidate.effect.own), key=lambda s: s.fall).candidate
    new = judged(state.model, with_one(state, state.model, best), 1, task.options)
    return state, replace(state, model=new.model, accepted=(new,))


def test_beside_a_shift_windows_that_feel_inputs_beyond_the_ends_are_left_out():
    bare, state = with_shift(0.016, 0.016)
    assert without_edges(bare) is bare
    cut = without_edges(state)
    assert [r.edge for r in cut.task.records] == pytest.approx([0.02, 0.02])  # two samples
    (before,), (after,) = (s.model.fit.problem.parts for s in (state, cut))
    assert list(after.cut.starts) == list(before.cut.starts[1:])  # the last is not at the end
    assert len(cut.model.unseen.at_horizon[0]) == len(state.model.unseen.at_horizon[0]) - 1
    assert without_edges(cut) is cut


def test_a_shift_that_all_records_have_alike_becomes_a_delay_and_is_no_rival_of_it():
    _, state = with_shift(0.016, 0.016)
    (shift,) = state.accepted
    assert is_alike(shift, state.model)
    model, (law,), _ = likeliest_of_set(without_edges(state), print)
    assert [c.effect.name for c in model.candidates] == ["delay"]
    assert law.is_proven
    odds = find_odds(replace(law, alternatives=(shift,)), model)
    assert (odds.own, odds.rivals) == (1.0, ())


@pytest.mark.parametrize(("factor", "name"), [(0.5, "time_shift"), (2.0, "offset")])
def test_another_law_takes_the_place_of_an_early_shift_only_where_it_is_likelier(
    monkeypatch, factor, name
):
    """No delay is negative, so that the law of the shift itself is never proven."""
    _, state = with_shift(-0.016, -0.016, effects=("time_shift", "delay", "offset"))
    (shift,) = state.accepted
    offset = next(s.candidate for s in state.scores if s.candidate.effect.name == "offset")
    other = judged(state.nominal, with_one(state, state.nominal, offset), 1, state.task.options)
    gains = replace(shift.gains, blocks=factor * shift.gains.blocks)
    other = replace(other, doubt=None, gains=gains, numbers=shift.numbers)
    monkeypatch.setattr(moves, "_judged_together", lambda *given: [shift, other])
    _, (kept,), _ = likeliest_of_set(without_edges(state), print)
    assert kept.candidate.effect.name == name


def test_errors_before_and_after_are_of_the_same_windows_where_a_shift_has_cut_them():
    _, state = with_shift(0.016, 0.016)
    cut = without_edges(state)
    model, accepted, _ = likeliest_of_set(cut, print)  # the shift itself is no part of it any more
    answer = conclude(replace(cut, model=model, accepted=accepted))
    assert len(model.fit.errors[0]) < len(cut.nominal.fit.errors[0])
    (fitted, confirm) = find_gap(answer).records
    assert [len(r.time) for r in (fitted, confirm)] == [len(r.before) for r in (fitted, confirm)]
    assert len(fitted.before) == len(fitted.after) == len(model.fit.errors[0])
    assert np.median(fitted.before) > np.median(fitted.after)


def test_shifts_that_differ_stay_differences():
    _, state = with_shift(0.016, -0.009, 0.005)
    assert not is_alike(state.accepted[0], state.model)
    model, (kept,), _ = likeliest_of_set(state, print)
    assert kept.candidate.effect.name == "time_shift"
    assert model is state.model


def test_the_law_of_a_difference_is_that_of_all_records():
    effects = listed("delay", "time_shift", "encoder_offset")
    (shift,) = list_common([e for e in effects if e.name == "time_shift"])[:1]
    (zero,) = (e for e in effects if e.name == "encoder_offset")
    (differs,) = list_common([in_each_record(zero)])
    assert {c.key for c in laws_of_records(shift, effects)} == {("delay", "input drive")}
    assert [c.key for c in laws_of_records(differs, effects)] == [
        ("encoder_offset", "sensor angle")
    ]
    assert laws_of_records(list_common([zero])[0], effects) == []


def test_without_the_pass_a_shift_of_clocks_is_a_name():
    answer = clocked("time_shift.tau@drive", SHIFTS, ("record_differences",))
    assert [n.candidate.effect.name for n in answer.named] == ["time_shift"]


def test_friction_beside_zeros_that_differ_is_named_and_the_zeros_are_told():
    """Twice the friction hides the zeros, and they it: neither alone is then beyond chance."""
    name = "coulomb_friction.f_c@hinge"
    each = tuple((("encoder_offset.c@angle", c), (name, 0.03)) for c in ZEROS)
    names = "encoder_offset", "coulomb_friction"
    answer = found(each, 400, names, ("untouched_part",))  # all windows decide, so few do
    assert [n.name for n in answer.named] == ["coulomb_friction"]
    assert [d.candidate.sizes for d in answer.differences] == [("encoder_offset.c@angle",)]
    assert not [f for f in answer.findings if f.kind == FindingKind.UNPROVEN_EFFECT]


def test_what_explains_fitted_records_and_worsens_unseen_ones_says_that_records_differ():
    zeros = (0.08, 0.08, -0.08, -0.08)
    logs = [record(k, 400, {"encoder_offset.c@angle": c}, plant=pendulum())
            for k, c in enumerate(zeros, 1)]  # fmt: skip
    (zero,) = listed("encoder_offset")
    alike = replace(zero, of_records="")  # a zero that is the same in all records
    answer = discover_records(nominal_model(), logs[:2], logs[2:], [alike])
    assert answer.verdict == "unknown effect"
    (tried,) = answer.rejected
    assert tried.doubt == "differ"
    assert tried.proof.disagrees == ("record 3", "record 4")
    said = discovery_text(answer)
    assert "the records differ in something that it stands for (worse: record 3, record 4)" in said
    assert "may be luck" not in said


@pytest.mark.parametrize("ahead", [0.9, 1.1])
def test_a_difference_comes_before_a_law_only_where_the_evidence_is_very_strong(ahead):
    differs = in_each_record(replace(effect("zero"), of_records="its zero differs"))
    law, own = contender(effect("law"), 1.0), contender(differs, 1.0)
    law, own = replace(law, criterion=50.0), replace(own, criterion=50.0 + ahead * STRONG_BIC)
    first, _ = ranked((law, own), OPTIONS)
    assert first is (own if ahead > 1 else law)
    unproven = replace(law, doubt="chance")
    assert ranked((unproven, own), OPTIONS)[0] is own


def test_a_place_is_felt_in_any_record_and_sizes_are_those_of_one_record_after_the_other():
    three = replace(effect("zero"), places={f"joint {x}": f"@{x}" for x in "abc"}, of_records="z")
    differs = in_each_record(three)
    places = [*differs.places]
    several = at_several(differs, places)
    score = WindowScore(
        candidate=Candidate(several, next(iter(several.places)), {}),
        size=np.array([0.5, 0.0, 0.0, 0.0, 0.0, 0.5]), std=np.full(6, 0.1), fall=0.2, p_value=1e-9,
        along=np.zeros(0),
    )  # fmt: skip
    assert felt_places(score, places, differs, OPTIONS) == [places[0], places[2]]
