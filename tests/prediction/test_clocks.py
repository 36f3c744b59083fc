"""A shift of a record's clock is told where it is true, and not where a force is missing."""

import pytest
from bump_cases import push, record, rise, rub, searched

from identification.prediction.verdict.clocks import SHIFT, record_shifts, told_shifts

NAMES = (SHIFT, "curve_speed", "curve_load", "curve_position")
LATE = 0.02  # [s]


def shifts(first, last=0.0, **how):
    """The shifts of three records, of which the third has inputs that act later; those told."""
    logs = [record(first + k, seconds=8.0, late=last * (k == 2), **how) for k in range(3)]
    task, model = searched(logs, NAMES)
    found = record_shifts(task, model)
    return found, told_shifts(found, len(logs), task.options)


@pytest.mark.parametrize(("force", "seed"), [(push, 4), (rise, 10), (rub, 31)])
def test_a_bump_that_is_missing_is_no_shift_of_exact_stamps(force, seed):
    """Its blocks tell of 10 to 50 ms with a std of a quarter of that, 15 to 55 times the noise."""
    found, _ = shifts(seed, force=force, size=3.0, is_smooth=True)
    assert found == ()


@pytest.mark.parametrize("more", [{}, {"spring": 6.0}, {"size": 2.0}])
def test_a_true_shift_is_told_also_beside_a_force_that_is_missing(more):
    """The missing spring leaves some hundred times the noise."""
    _, (told,) = shifts(10, LATE, **{"size": 0.0, **more})
    assert told.record == "record 12"
    assert told.shift == pytest.approx(LATE, abs=3e-4)
    assert abs(told.shift - LATE) < 2 * told.std


def test_a_shift_beside_which_nothing_is_left_has_a_small_std():
    _, (told,) = shifts(1, LATE, size=0.0, is_smooth=True)
    assert told.shift == pytest.approx(LATE, abs=1e-4)
    assert told.std < 1e-4
