"""What is usual: the table that is shipped, and tables of users."""

import pytest

from inca_mj.robot.geometry import DRIVES
from inca_mj.workflows.spread import INERTIAS, KNOWN, NONE, spread_of


def test_the_shipped_table_frees_every_drive_and_every_point():
    usual = spread_of("usual")
    assert len(usual.groups["lambda"]) == DRIVES
    assert len(usual.groups["exit"]) == 3 * DRIVES
    assert usual.known["lambda@3"] == usual.drives["lambda"]
    assert usual.known["connector_z@8"] == usual.points["connector"]
    assert {*KNOWN, *INERTIAS} <= usual.known.keys()
    assert len(usual.known) == len(KNOWN) + 3 + 9 * 8 + 48


def test_without_a_spread_the_common_values_are_free():
    assert spread_of("none") is NONE
    assert NONE.known == KNOWN
    assert NONE.groups == {}


def test_a_table_of_ones_own(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text("[drives]\nK_t = 0.05\n")
    mine = spread_of(str(path))
    assert mine.groups == {"K_t": tuple(f"K_t@{k}" for k in range(1, 9))}
    assert mine.source == "mine.toml"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("[drives]\nK = 0.05", "K_t"),
        ("[drives]\nK_t = 0", "above 0"),
        ("[points]\nexit = 3.0", "below 1"),
    ],
)
def test_a_wrong_table_is_refused_in_one_sentence(tmp_path, refusal, text, says):
    path = tmp_path / "mine.toml"
    path.write_text(text)
    assert says in refusal(spread_of, str(path))
