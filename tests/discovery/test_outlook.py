"""The time that is left of a search: a range of this search, which becomes narrower and ends."""

import pytest

from identification.discovery.outlook import (
    CHECKS,
    EFFECT,
    FIT,
    LEFT,
    SCORES,
    STAGES,
    Outlook,
)
from identification.prediction.discovery import WINDOWS

RESTS = {(SCORES, 0): (2.0, 10.0), (EFFECT, 0): (1.0, 4.0), (EFFECT, 1): (0.5, 2.0)}


class Clock:
    now = 50.0

    def __call__(self):
        return self.now


def begun():
    clock, said = Clock(), []
    return clock, said, Outlook(said.append, RESTS, clock)


def test_a_machine_that_is_slower_by_a_factor_has_longer_forecasts_by_that_factor():
    forecasts = []
    for factor in (1.0, 3.0):
        clock, _, outlook = begun()
        clock.now += 7 * factor
        outlook.enter(SCORES)
        clock.now += 2 * factor
        forecasts.append(outlook.left)
    assert forecasts[1] == pytest.approx([3 * each for each in forecasts[0]])


def test_what_passes_is_taken_off_and_what_takes_longer_is_said():
    clock, said, outlook = begun()
    clock.now += 5
    outlook.enter(SCORES)
    assert outlook.left == pytest.approx((10, 50))
    clock.now += 30
    assert outlook.left == pytest.approx((0, 20))
    clock.now += 30
    assert outlook.left is None
    assert str(outlook).endswith("it takes longer than forecast")
    outlook.enter(EFFECT, 7, "so far nothing")  # the table of the most effects serves for more
    assert outlook.left == pytest.approx((32.5, 130))
    assert said[-1] == f"stage 3 of 5, {EFFECT}: 30 s to 2 min left; so far nothing"
    outlook.enter(LEFT)
    assert said[-1] == f"stage 5 of 5, {LEFT}"


@pytest.mark.parametrize("step", [1.0, 20.0, 49.9])
def test_the_clock_may_pass_the_forecast_while_it_is_told(step):
    times = iter(step * k for k in range(1000))
    outlook = Outlook([].append, RESTS, lambda: next(times))
    for _ in range(2):
        outlook.enter(SCORES)
        for _ in range(30):
            assert str(outlook).endswith(("left", "it takes longer than forecast"))


def test_forecasts_are_ranges_of_stages_and_become_narrower_with_each():
    rests = WINDOWS.rests
    assert {stage for stage, _ in rests} == {*STAGES} - {FIT}
    for low, high in rests.values():
        assert 0 <= low < high
    ends = [rests[stage, 0][1] for stage in (SCORES, EFFECT, CHECKS, LEFT)]
    assert ends == sorted(ends, reverse=True)
