"""What was refitted twice to the same values is listed once."""

from dataclasses import replace

import pytest
from fake_discovery import LATE, REJECTED

from identification.discovery.once import listed_once


def late(tau, std=1e-4, where="all drives", letter="tau"):
    """A delay that was refitted."""
    there = replace(LATE, where=where, probe=tau / 1e-3)
    return replace(REJECTED, candidate=there, parameters={letter: (tau, std, "s")})


def test_two_searches_with_one_end_are_one():
    best, again, other = late(2.5e-4), late(2.51e-4), late(9e-4)
    assert listed_once([best, again, other, again]) == (best, other)
    assert listed_once([]) == ()


@pytest.mark.parametrize(
    "different",
    [{"tau": 4e-4}, {"tau": 2.5e-4, "where": "drive 1"}, {"tau": 2.5e-4, "letter": "t"}],
)
def test_another_end_another_place_and_another_number_are_listed(different):
    both = (late(2.5e-4), late(**different))
    assert listed_once(both) == both


@pytest.mark.parametrize("std", [float("nan"), float("inf")])
def test_values_without_a_std_are_the_same_where_their_digits_are(std):
    a, b, c = late(2.5e-4, std), late(2.50001e-4, std), late(2.52e-4, std)
    assert listed_once([a, b, c]) == (a, c)
