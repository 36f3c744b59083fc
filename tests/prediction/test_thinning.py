"""Which windows screen candidates."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from identification.prediction.problem import MIN_WINDOWS
from identification.prediction.thinning import THIN, kept


@given(st.integers(1, 500))
def test_one_window_of_three_is_kept_and_never_fewer_than_blocks_need(count):
    at = kept(count, THIN)
    assert np.all(np.diff(at) > 0)
    assert at[0] == 0
    assert at[-1] < count
    assert len(at) >= min(count, MIN_WINDOWS)
    if count >= THIN * MIN_WINDOWS:
        assert np.all(np.diff(at) == THIN)
