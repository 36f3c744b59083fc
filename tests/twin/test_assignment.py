"""The columns that belong to rows, beside a search through all of them."""

from itertools import permutations

import numpy as np
import pytest

from inca_mj.refusals.agreement import assigned


@pytest.mark.parametrize("seed", range(8))
def test_no_other_assignment_adds_up_to_more(seed):
    rng = np.random.default_rng(seed)
    likeness = rng.uniform(size=(5, 5)) + (seed % 2) * 2 * rng.permutation(np.eye(5))
    at = assigned(likeness)
    assert sorted(at) == [0, 1, 2, 3, 4]
    best = max(sum(likeness[range(5), list(p)]) for p in permutations(range(5)))
    assert likeness[range(5), at].sum() == pytest.approx(best, rel=1e-12)


def test_what_is_no_number_is_refused():
    likeness = np.eye(3)
    likeness[1, 2] = np.nan
    with pytest.raises(ValueError, match="invalid"):
        assigned(likeness)
