"""Of the records that confirm, a search over windows decides on a part and keeps the other."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from records_cases import HORIZON, STEP, listed, nominal_model, records, roles

from identification.discovery.options import DiscoveryOptions
from identification.logs.parts import MEMORIES, inside
from identification.prediction.discovery import WINDOWS
from identification.prediction.fits.nominal_fit import fit_alone, predicted
from identification.prediction.selection.exchange import exchanged
from identification.prediction.task import RecordsTask
from identification.prediction.verdict.verdict import conclude
from identification.report.words.parts import is_untouched, parts_sentence, parts_to_json
from identification.windows import dividing
from identification.windows.comparison import compare
from identification.windows.dividing import divide_records, memory_of
from identification.windows.unseen import LENGTHS, cut_unseen

FALSE = {"offset.f_0@hinge": 0.02}


@cache
def alone(samples=500):
    """The records, two to fit and two that confirm, and the fit of the former."""
    logs = records(4, FALSE, samples=samples)
    told = roles(logs)
    return told, *fit_alone(nominal_model(), told)


@cache
def divided(samples=500):
    told, found, scale = alone(samples)
    parts = divide_records(found.problem.plant, told, found, HORIZON, scale)
    return parts, predicted(found, scale, parts, HORIZON)


def test_each_record_that_confirms_has_windows_of_every_length_in_both_parts():
    parts, model = divided()
    for record in parts:
        assert (record.parts is not None) == (record.role == "confirm")
    for part in (model.unseen.select, model.unseen.report):
        assert [*part.lengths] == [*LENGTHS]
        assert all(len(s) for each in part.squares for s in each)
        assert [len(s) for s in part.at_horizon] == [len(s) for s in part.of_outputs]
    both = [np.concatenate(pair) for pair in zip(
        model.unseen.select.at_horizon, model.unseen.report.at_horizon, strict=True
    )]  # fmt: skip
    for kept, every in zip(both, model.unseen.at_horizon, strict=True):
        assert {*kept} <= {*every}
        assert len({*kept}) == len(kept)


def test_windows_are_divided_as_their_samples_are():
    parts, model = divided()
    confirm = [r for r in parts if r.role == "confirm"]
    for k, length in enumerate(model.unseen.lengths):
        cuts = cut_unseen(model.plant, confirm, length * HORIZON, is_horizon=length == 1.0)
        for r, record in enumerate(confirm):
            at = inside(record.parts, "report", cuts[r].places)
            told = model.unseen.report.squares[k][r]
            np.testing.assert_array_equal(told, model.unseen.squares[k][r][at])


def test_with_the_roles_exchanged_a_fit_sees_no_window_that_is_kept():
    parts, model = divided()
    other = exchanged(model, parts, HORIZON)
    confirm = [r for r in parts if r.role == "confirm"]
    for record, part in zip(confirm, other.fit.problem.parts, strict=True):
        for first, behind in part.cut.places:
            assert record.parts.select[first:behind].all()
            assert not record.parts.report[first:behind].any()


def test_errors_in_the_part_that_is_kept_decide_nothing_and_are_told():
    _, model = divided()
    unseen = model.unseen

    def louder(squares, places):
        each = zip(squares, places, unseen.parts, strict=True)
        return tuple((s.T * np.where(inside(p, "report", at), 4.0, 1.0)).T for s, at, p in each)

    worse = replace(unseen, powers=tuple(map(louder, unseen.powers, unseen.places)))
    found = compare(model.unseen, worse)
    assert (found.fall, found.t, found.gain) == (0.0, 0.0, 0.0)
    assert found.told.fall == pytest.approx(-3.0)
    assert found.told.gain < 0


def test_short_records_are_not_divided():
    """Of two records of 10 windows six decide each, in three blocks: t of five asks too much."""
    parts, model = divided(200)
    assert all(r.parts is None for r in parts)
    assert model.unseen.select is model.unseen.report is model.unseen
    assert len(model.unseen.report.at_horizon[0]) == 10


def test_blocks_of_windows_are_as_long_as_their_errors_repeat(monkeypatch):
    told, found, scale = alone(1000)
    assert HORIZON <= memory_of(found, scale) < 3 * HORIZON
    for memory, windows in ((0.0, 2), (4 * HORIZON / MEMORIES, 4), (100.0, 6)):
        monkeypatch.setattr(dividing, "memory_of", lambda *_, τ=memory: τ)
        each = divide_records(found.problem.plant, told, found, HORIZON, scale)
        blocks = {r.parts.block for r in each if r.role == "confirm"}
        assert blocks == {round(windows * HORIZON / STEP)}


@pytest.mark.parametrize("without", [(), ("untouched_part",)])
def test_a_result_says_of_which_part_it_tells(without):
    logs = records(4, FALSE)
    task = RecordsTask(
        nominal_model=nominal_model(), records=roles(logs), effects=listed("offset"),
        options=DiscoveryOptions(without=without),
    )  # fmt: skip
    state = WINDOWS.begin(task, print)
    found = conclude(replace(state, moves=()))
    assert is_untouched(found) == (not without)
    said, parts = parts_sentence(found), parts_to_json(found)
    assert [p["file"] for p in parts] == [log.name for log in logs[2:]]
    assert [p["kept"] for p in parts] == 2 * [not without]
    unseen = state.nominal.unseen
    told = np.mean(np.concatenate(unseen.report.at_horizon))  # but for the steps of the end
    scale = float(state.nominal.scale[0])
    assert found.before.rms == pytest.approx(scale * np.sqrt(told), rel=1e-4)
    if without:
        assert "same unseen data on which the search has decided" in said
        assert parts[0]["block"] is None
    else:
        assert "is untouched, and errors and gains are computed on it" in said
        assert parts[0]["select"] + parts[0]["report"] == pytest.approx(logs[2].duration, abs=0.02)
