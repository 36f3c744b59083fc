import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
LOCKS = ("requirements.lock", "requirements-mujoco4.lock", "requirements-docs.lock")


def pins(name):
    text = (ROOT / name).read_text(encoding="utf-8")
    return dict(re.findall(r"^([a-z0-9.-]+)==(\S+)", text, re.M))


@pytest.mark.parametrize("name", LOCKS)
def test_every_pin_has_hashes_and_no_address(name):
    text = (ROOT / name).read_text(encoding="utf-8")
    entries = re.split(r"\n(?=\S)", text.strip())
    assert len(entries) == len(pins(name))
    assert all(" --hash=sha256:" in entry for entry in entries)
    assert not re.search(r"://|index|find-links|@", text)


def test_the_second_environment_differs_by_mujoco_alone():
    ours, theirs = (pins(name) for name in LOCKS[:2])
    assert ours["mujoco"] == "3.17.0"
    assert theirs["mujoco"] == "4.0.0"
    assert "dm-control" not in theirs
    shared = set(ours) & set(theirs) - {"mujoco"}
    assert len(shared) > 30
    assert {n: ours[n] for n in shared} == {n: theirs[n] for n in shared}
