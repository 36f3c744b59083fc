"""Which windows screen candidates: spread evenly, and where the model errs most."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from identification.prediction.problem import FEWEST_WINDOWS
from identification.prediction.thinning import THIN, kept

SQUARES = st.lists(st.floats(0.0, 1e6), min_size=1, max_size=200).map(np.array)


@given(SQUARES)
def test_about_one_window_of_three_is_kept_each_once_and_in_order(squares):
    at = kept(squares, THIN)
    assert np.all(np.diff(at) > 0)
    assert at[0] == 0
    assert len(at) >= min(len(squares), FEWEST_WINDOWS)
    if len(squares) >= THIN * FEWEST_WINDOWS:
        assert abs(len(at) - len(squares) / THIN) <= 2


@given(SQUARES, st.integers(0, 199))
def test_the_window_of_a_rare_event_is_kept(squares, place):
    place %= len(squares)
    squares[place] = 1e9
    whole = place < len(squares) - len(squares) % (2 * THIN)
    if whole or len(squares) < 2 * FEWEST_WINDOWS:
        assert place in kept(squares, THIN)
