"""A line is said at least every ten seconds, with the stage and the time that is left."""

from identification.commands.beat import EVERY, Beat
from identification.runtime.progress import stage, watched


class Clock:
    now = 100.0

    def __call__(self):
        return self.now


def watching():
    clock, said = Clock(), []
    return clock, said, Beat(said.append, clock)


def test_nothing_is_said_where_others_speak_often_enough_or_nothing_is_told():
    clock, said, beat = watching()
    clock.now += 5 * EVERY
    beat.check()
    assert said == []  # a program without stages, such as a viewer
    for _ in range(5):
        beat.told()
        clock.now += EVERY - 1
        beat.check()
    assert said == []
    clock.now += 1
    beat.check()
    assert said == ["96 s: still at work"]


def test_the_time_left_is_told_where_the_steps_are_known():
    clock, said, beat = watching()
    with watched(beat.stage), stage("refits", 8) as advance:
        clock.now += EVERY
        beat.check()
        advance()
        clock.now += EVERY
        beat.check()
        with stage("steps of a fit") as inner:
            inner()
            inner()
            clock.now += EVERY
            beat.check()
        advance()
        clock.now += EVERY
        beat.check()
    assert said == [
        "10 s: refits: 0 of 8",
        "20 s: refits: 1 of 8, about 2 min left",
        "30 s: steps of a fit: 2 done",
        "40 s: refits: 2 of 8, about 2 min left",
    ]
