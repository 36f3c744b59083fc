"""A law is named although something is left only where it closes more than half of the gap."""

from types import SimpleNamespace

import numpy as np
import pytest

from identification.discovery.options import DiscoveryOptions
from identification.prediction.verdict.doubts import doubts_of_names
from identification.prediction.verdict.verdict import decide, largest_share

LEFT = [SimpleNamespace(kind="remaining error")]


def effect(is_curve):
    candidate = SimpleNamespace(effect=SimpleNamespace(is_curve=is_curve))
    return SimpleNamespace(candidate=candidate, confidence=0.85, one_of=False, neighbour=None)


def verdict_of(named, findings, share, options, impossible=None):
    forbidden = [None] * len(named) if impossible is None else impossible
    doubts = doubts_of_names(named, forbidden, findings, share, options)
    return decide(named, doubts, findings, True)


@pytest.mark.parametrize(("curves", "findings", "share", "verdict"), [
    ([False], LEFT, 0.49, "unknown effect"), ([False], LEFT, 0.51, "named"),
    ([False], [], 0.3, "named"), ([True], LEFT, 0.3, "unlisted effect"),
    ([True, False], LEFT, 0.3, "unknown effect"), ([False, False], LEFT, 0.7, "named"),
])  # fmt: skip
def test_what_is_left_and_how_much_is_closed_decide(curves, findings, share, verdict):
    named = [effect(is_curve) for is_curve in curves]
    assert verdict_of(named, findings, share, DiscoveryOptions()) == verdict


def test_the_pass_can_be_left_out_and_the_share_be_set():
    named = [effect(False)]
    for options in (DiscoveryOptions(without=("closed_gap",)),
                    DiscoveryOptions(min_explained_share=0.2)):  # fmt: skip
        assert verdict_of(named, LEFT, 0.3, options) == "named"


def test_what_physics_forbids_at_the_values_of_the_final_model_is_no_name():
    """An effect is possible when it is accepted, and a later one may move its size."""
    named, options = [effect(False), effect(False)], DiscoveryOptions()
    assert verdict_of(named, LEFT, 0.9, options, [None, None]) == "named"
    assert verdict_of(named, LEFT, 0.9, options, ["mass", None]) == "unknown effect"
    assert doubts_of_names(named, ["mass", None], LEFT, 0.9, options) == ("mass", None)


@pytest.mark.parametrize(("before", "after", "share"), [
    ([1.0, 1.0], [0.01, 1.0], 1.0),  # it does all for one output, which another one is not
    ([1.0, 1.0], [0.505, 0.802], 0.5),
    ([1.0, 0.01], [0.6, 0.001], 0.4 / 0.99),  # an output at its noise is nothing to close
    ([0.01, 0.01], [0.01, 0.01], 0.0),
])  # fmt: skip
def test_the_gap_is_that_of_the_output_of_which_most_is_closed(before, after, share):
    noise = np.array([0.01, 0.01])
    old, new = (
        SimpleNamespace(report=SimpleNamespace(of_outputs=[np.array([x])]), noise=noise)
        for x in (before, after)
    )
    assert largest_share(old, new, DiscoveryOptions()) == pytest.approx(share)
