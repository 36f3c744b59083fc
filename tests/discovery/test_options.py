"""Options of a discovery: their page, their file, and that each of them is used."""

import re
from dataclasses import fields
from math import inf, nan
from pathlib import Path

import pytest

from identification import InputError
from identification.discovery.options import DiscoveryOptions, read_options

ROOT = Path(__file__).parents[2]
FIELDS = [field for field in fields(DiscoveryOptions) if field.metadata]  # of one number each


def row_of(field):
    """The row of an option in the table of docs/discovery.md."""
    m = field.metadata
    return (f"`{field.name}`", f"{field.default:g}", m["unit"], m["reason"], m["source"])


def test_the_page_has_every_option_with_its_value_unit_reason_and_source():
    page = (ROOT / "docs" / "discovery.md").read_text(encoding="utf-8")
    rows = [tuple(cell.strip() for cell in line.strip("|").split("|"))
            for line in page.splitlines() if re.match(r"\| `\w+` \|", line)]  # fmt: skip
    table = [row for row in rows if len(row) == 5]
    expected = [row_of(field) for field in FIELDS]
    assert table == expected, "\n".join("| " + " | ".join(row) + " |" for row in expected)


def write(tmp_path, text):
    path = tmp_path / "options.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_file_sets_what_it_names_and_leaves_the_rest(tmp_path):
    path = write(tmp_path, "min_proof_t = 3\nmax_effects = 1\n")
    assert read_options(path) == DiscoveryOptions(min_proof_t=3.0, max_effects=1)
    assert read_options(write(tmp_path, "")) == DiscoveryOptions()


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("min_prof_t = 3.0", "did you mean 'min_proof_t'"),
        ("max_effects = 2.5", "give a whole number of 1 or more"),
        ("[discovery]\nmax_effects = 1", "unknown option in .*: 'discovery'"),
        ('without = "add_pair"', "give a list of names of passes"),
    ],
)
def test_a_wrong_file_is_refused_in_one_sentence(tmp_path, refusal, text, says):
    path = write(tmp_path, text)
    said = refusal(read_options, path)
    assert re.search(says, said)
    assert str(path) in said


@pytest.mark.parametrize("field", FIELDS, ids=lambda field: field.name)
def test_the_limits_of_an_option_hold_and_its_default_lies_within(field):
    least, most = field.metadata["least"], field.metadata["most"]
    kind = int if isinstance(field.default, int) else float
    assert least <= field.default <= most
    assert getattr(DiscoveryOptions(**{field.name: kind(least)}), field.name) == least
    for value in (least - 1, most + 1 if most < inf else inf, nan):
        with pytest.raises(InputError, match=field.name):
            DiscoveryOptions(**{field.name: value})


def test_passes_that_are_left_out_are_kept_once_in_a_value_that_does_not_change():
    options = DiscoveryOptions(without=["add_pair", "begin_anew", "add_pair"])
    assert options == DiscoveryOptions(without=("add_pair", "begin_anew"))
    assert hash(options) == hash(DiscoveryOptions(without=("add_pair", "begin_anew")))
