"""A search asks its moves in their order; each that adds an effect lets all be asked again."""

from dataclasses import replace
from math import inf
from pathlib import Path
from types import SimpleNamespace

from identification.discovery import moves as moves_module
from identification.discovery.moves import Evidence, Move, SearchState
from identification.discovery.passes import PASSES
from identification.errors import InputError
from identification.innovations import state as innovations
from identification.prediction import state as windows
from identification.report.discovery.verdict import SOUGHT
from identification.runtime.pool import OutOfTime, end_if_given_up

ROOT = Path(__file__).parents[2]


def begun(most=8, without=(), minutes=inf):
    options = SimpleNamespace(max_effects=most, without=without, max_minutes=minutes)
    return SearchState(
        task=SimpleNamespace(options=options), moves=(), nominal=None, nominal_scores=(),
        model=None, accepted=(), scores=(), rejected=(), seconds={},
    )  # fmt: skip


def finding(name, effects, asked):
    """A move that adds those of some effects, one a time, which the state lacks."""

    def make(state, progress):
        asked.append(name)
        new = [e for e in effects if e not in state.accepted][:1]
        return replace(state, accepted=(*state.accepted, *new))

    return Move(name, make, grows=True)


def searched(state, every):
    """Returns the finished state of an evidence that begins with a state."""
    return Evidence(lambda task, progress: state, every, lambda end: end).search(state.task)


def moves(asked):
    def nothing(state, progress):
        asked.append("drop_effects")
        return state

    return (
        finding("add_effect", ["a", "b"], asked), finding("add_pair", ["c"], asked),
        Move("drop_effects", nothing),
    )  # fmt: skip


def test_after_each_effect_all_moves_are_asked_again_and_the_last_ones_once():
    asked = []
    end = searched(begun(), moves(asked))
    assert end.accepted == ("a", "b", "c")
    first, second = "add_effect", "add_pair"
    assert asked == [first, first, first, second, first, second, "drop_effects"]
    assert end.made == (first, first, second)


def test_where_there_is_room_for_no_more_nothing_is_added():
    most = 1
    asked = []
    end = searched(begun(most), moves(asked))
    assert end.accepted == ("a", "b", "c")[:most]
    assert asked[-1] == "drop_effects"
    assert asked.count("drop_effects") == 1


def test_behind_the_time_limit_no_effect_is_added_and_the_checks_are_made():
    """Each move ends at its first simulation; what an earlier one has found stays."""

    def simulates(state, progress):
        end_if_given_up()
        return replace(state, rejected=("simulated",))

    def checks(state, progress):
        end_if_given_up()
        return replace(state, scores=("checked",))

    every = (
        Move("add_effect", simulates, grows=True), Move("add_set", simulates, grows=True),
        Move("drop_effects", checks),
    )  # fmt: skip
    end = searched(begun(minutes=0), every)
    assert end.cut_short == ("add_effect", "add_set")
    assert end.rejected == ()
    assert end.scores == ("checked",)
    assert searched(begun(), every).cut_short == ()


def test_the_time_of_a_search_counts_moves_that_were_ended(monkeypatch):
    now = [1000.0]
    monkeypatch.setattr(moves_module, "time", SimpleNamespace(monotonic=lambda: now[0]))

    def ended(state, progress):
        now[0] += 45.0
        raise OutOfTime

    def finished(state, progress):
        now[0] += 7.0
        return replace(state, seconds={"refits": 6.0})

    every = (Move("add_set", ended, grows=True), Move("drop_effects", finished))
    end = searched(begun(), every)
    assert end.cut_short == ("add_set",)
    assert (end.took, sum(end.seconds.values())) == (52.0, 6.0)
    assert replace(end, began=None).took == 6.0


def test_a_move_that_is_left_out_is_not_asked():
    asked = []
    assert searched(begun(without=("add_effect",)), moves(asked)).accepted == ("c",)
    assert "add_effect" not in asked


def test_a_move_that_fails_is_told_and_the_next_ones_are_asked():
    def fails(state, progress):
        raise InputError("a matrix is singular; take another")

    asked = []
    every = (Move("add_deviants", fails, grows=True), *moves(asked))
    end = searched(begun(), every)
    assert end.accepted == ("a", "b", "c")
    assert [f.name for f in end.failed] == ["the move add deviants"]


def test_every_move_of_both_searches_has_a_reason_and_can_be_left_out():
    for every in (innovations.MOVES, windows.MOVES):
        for move in every:
            assert move.name in {*PASSES, "add_effect"}
            state = begun(without=(move.name,))
            assert move not in Evidence(None, every, None).asked(state)
            assert len(Evidence(None, every, None).asked(state)) == len(every) - 1


def test_what_each_move_that_the_time_limit_ends_seeks_is_told_in_words():
    every = {*innovations.MOVES, *windows.MOVES}
    assert {*SOUGHT} == {move.name for move in every if move.grows}


def test_the_page_lists_every_pass_with_what_it_does():
    page = (ROOT / "docs" / "discovery.md").read_text(encoding="utf-8")
    rows = [f"| `{name}` | {of} | {does} |" for name, (of, does) in PASSES.items()]
    assert "\n".join(rows) in page, "\n".join(rows)
