"""A law is named although something is left only where it closes more than half of the gap."""

from types import SimpleNamespace

import pytest

from identification.discovery.options import DiscoveryOptions
from identification.prediction.verdict import decide

LEFT = [SimpleNamespace(kind="remaining error")]


def effect(is_curve):
    candidate = SimpleNamespace(effect=SimpleNamespace(is_curve=is_curve))
    return SimpleNamespace(candidate=candidate, confidence=0.85, one_of=False, neighbour=None)


@pytest.mark.parametrize(("curves", "findings", "share", "verdict"), [
    ([False], LEFT, 0.49, "unknown effect"), ([False], LEFT, 0.51, "named"),
    ([False], [], 0.3, "named"), ([True], LEFT, 0.3, "unlisted effect"),
    ([True, False], LEFT, 0.3, "unknown effect"), ([False, False], LEFT, 0.7, "named"),
])  # fmt: skip
def test_what_is_left_and_how_much_is_closed_decide(curves, findings, share, verdict):
    named = [effect(is_curve) for is_curve in curves]
    assert decide(named, findings, True, share, DiscoveryOptions()) == verdict


def test_the_pass_can_be_left_out_and_the_share_be_set():
    named = [effect(False)]
    for options in (DiscoveryOptions(without=("closed_gap",)),
                    DiscoveryOptions(min_explained_share=0.2)):  # fmt: skip
        assert decide(named, LEFT, True, 0.3, options) == "named"
