"""Errors in a table have one unit, so that rows compare at a glance."""

import pytest

from identification.report.error_words import pair_words


@pytest.mark.parametrize(
    ("pairs", "told"),
    [
        ([({"rad": 3.5e-3}, {"rad": 1.1e-3}), ({"rad": 4e-4}, {"rad": 2e-5})],
         [("3.5 mrad", "1.1 mrad"), ("0.40 mrad", "0.020 mrad")]),
        ([({"": 1.2}, {"": 0.4})], [("1.2", "0.40")]),
        ([], []),
    ],
)  # fmt: skip
def test_one_unit_serves_all_rows(pairs, told):
    assert pair_words(pairs, "") == told


def test_each_unit_of_outputs_has_its_own():
    one, other = {"rad": 2e-3, "m": 5e-2}, {"rad": 1e-4, "m": 1e-3}
    ((a, b), (c, d)) = pair_words([(one, other), (other, one)])
    assert (a, b) == (d, c)
    assert a == "2 mrad rms (angles) and 50 mm rms (slides)"
    assert b == "0.10 mrad rms (angles) and 1 mm rms (slides)"
