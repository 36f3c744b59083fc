"""What a film says of its time follows the rate of its first frames, not that of its beginning."""

import pytest

from identification.progress import duration
from inca_mj.commands.film import EVERY, FIRST, SOON, FilmProgress


def told(frames, seconds, begin=60.0, lines=True):
    """The lines of a film whose first frame takes `begin` and every other `seconds`."""
    said, now = [], [0.0]
    progress = FilmProgress(said.append, 30.0, lines, lambda: now[0])
    for done in range(1, frames + 1):
        now[0] += begin if done == 1 else seconds
        progress(done, frames)
    return said


def test_it_says_the_length_first_and_then_the_time_by_the_first_frames():
    first, second, *_ = told(600, 0.5)
    assert first == "film: 600 frames, 20 s of film"
    left = 0.5 * (600 - FIRST - 1)  # [s]; what the renderer took to begin is not counted
    assert second == f"film: 600 frames, about {duration(left)} to draw"


@pytest.mark.parametrize("seconds", [1.0, 3.0, 20.0])
def test_slow_frames_are_not_waited_for(seconds):
    _, second, *_ = told(100, seconds)
    done = 1 + next(k for k in range(1, FIRST + 1) if k * seconds >= SOON or k == FIRST)
    assert second == f"film: 100 frames, about {duration(seconds * (100 - done))} to draw"


@pytest.mark.parametrize("seconds", [0.1, 2.0, 40.0])
def test_lines_come_now_and_then_and_say_what_is_left(seconds):
    lines = told(600, seconds)[2:]
    assert len(lines) <= 600 * seconds / EVERY
    assert (len(lines) > 0) is (seconds * 600 > EVERY)
    counts = [int(line.split()[1]) for line in lines]
    assert counts == sorted(set(counts))
    assert all(line.endswith("left") for line in lines)


def test_where_a_bar_is_drawn_only_the_length_and_the_time_are_said():
    assert len(told(600, 2.0, lines=False)) == 2


def test_a_film_of_few_frames_promises_nothing():
    assert told(5, 0.5) == ["film: 5 frames, 0.167 s of film"]


def test_it_begins_with_how_to_do_without_the_film():
    said = []
    FilmProgress(said.append, 15.0, True, hint="--no-film leaves it out")(1, 90)
    assert said == ["film: 90 frames, 6 s of film; --no-film leaves it out"]
