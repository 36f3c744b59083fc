"""The document of the rooms names every room of the packages, and none that is not there."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize(
    ("package", "end"), [("identification", "\nBeside"), ("inca_mj", "\nAlso")]
)
def test_every_room_is_told(package, end):
    text = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    part = text.split(f"\n`{package}/`, ")[1].split(end)[0]
    rooms = [p.parent.name for p in (ROOT / package).glob("*/__init__.py")]
    assert sorted(re.findall(r"^\| `(\w+)/` \|", part, re.M)) == sorted(rooms)
