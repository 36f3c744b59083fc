"""A name is at least as likely as not, or one of the set that is told with it."""

from types import SimpleNamespace

import pytest

from identification.discovery.options import DiscoveryOptions
from identification.prediction.doubts import is_sure


@pytest.mark.parametrize(("confidence", "one_of", "sure"), [
    (0.51, False, True), (0.49, False, False),
    (0.3, True, True),  # with its look-alike
    (0.02, True, False),  # the others are a set without it
])  # fmt: skip
def test_what_is_less_likely_than_a_member_of_a_set_is_no_name(confidence, one_of, sure):
    named = SimpleNamespace(confidence=confidence, one_of=one_of)
    assert is_sure(named, DiscoveryOptions()) == sure


def test_what_makes_a_set_is_an_option():
    named = SimpleNamespace(confidence=0.3, one_of=True)
    assert not is_sure(named, DiscoveryOptions(set_confidence=0.4))
