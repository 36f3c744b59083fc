"""With an unknown effect the answer tells at which joint some force is missing."""

from types import SimpleNamespace

import pytest

from identification.report.discovery_verdict import _any_forces


@pytest.mark.parametrize(("shares", "told"), [
    ({"joint b": 0.18, "joint a": 0.03}, ["18 % at joint b", "3 % at joint a"]),
    ({"joint b": 0.18, "joint a": 0.0}, ["18 % at joint b"]),
    ({"joint b": 0.04}, ["No smooth force", "4 %"]),
    ({"joint b": 0.0}, ["No smooth force"]),
])  # fmt: skip
def test_the_joint_with_the_largest_share_comes_first(shares, told):
    (sentence,) = _any_forces(SimpleNamespace(smooth_by_joint=shares))
    places = [sentence.index(words) for words in told]
    assert places == sorted(places)
    assert ("joint a" in sentence) == (shares.get("joint a", 0) > 0)
