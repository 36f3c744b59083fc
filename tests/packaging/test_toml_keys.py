"""The page of keys has those of the source and no others, with types and defaults that hold."""

import re
import tomllib
from dataclasses import MISSING, fields
from pathlib import Path

import pytest

from identification.errors import InputError
from identification.logs.sidecar import _KEYS, _TABLES, Sidecar, _values
from identification.robot.file import alike
from identification.robot.file.file import RobotFile
from identification.robot.file.file_checks import EFFECTS_KEYS, KEYS, PARAMETER_KEYS, check_table
from identification.robot.file.parameters import KNOWN

PAGE = (Path(__file__).parents[2] / "docs" / "robot" / "keys.md").read_text(encoding="utf-8")
TYPES = {"text": str, "list": list, "number": (int, float), "whole number": int}
SOURCES = {  # heading: the keys that the source knows
    "The robot's file": KEYS,
    "parameters.NAME": PARAMETER_KEYS,
    "spread.NAME": alike._KEYS,
    "effects": EFFECTS_KEYS,
    "The log's file": {**_KEYS, **_TABLES},
}


def table(heading):
    """The rows below a heading, by key: type, unit, default, example, meaning."""
    part = re.split(r"\n#+ ", PAGE.partition(f"# {heading}\n")[2])[0]
    rows = [
        [cell.strip() for cell in line.strip("|").split("|")]
        for line in part.splitlines()
        if line.startswith("| `")
    ]
    return {re.split(r"[.\]]", row[0].strip("`[]"))[0]: row[1:] for row in rows}


def read(heading, content):
    """Reads a table of a file as the program does."""
    if heading == "The log's file":
        _values(content, "here")
    else:
        check_table(content, SOURCES[heading], "here")


ROWS = [
    pytest.param(heading, key, row, id=f"{heading}-{key}")
    for heading in SOURCES
    for key, row in table(heading).items()
]


@pytest.mark.parametrize("heading", SOURCES)
def test_the_page_has_every_key_and_no_other(heading):
    assert {*table(heading)} == {*SOURCES[heading]}


@pytest.mark.parametrize(("heading", "key", "row"), ROWS)
def test_each_example_is_read_and_is_of_the_type_that_is_told(heading, key, row):
    kind, _, _, example, meaning = row
    content = tomllib.loads(example.strip("`"))
    assert [*content] == [key]
    read(heading, content)
    assert isinstance(content[key], TYPES.get(kind, dict))
    assert meaning


@pytest.mark.parametrize(("heading", "key", "row"), ROWS)
def test_a_value_of_another_type_is_refused(heading, key, row):
    wrong = {"text": 1, "number": "one", "whole number": 1.5}.get(row[0], "a word")
    with pytest.raises(InputError, match=re.escape(key)):
        read(heading, {key: wrong})


def test_defaults_are_those_of_the_source():
    plain = {"none": ((), {}, ""), "1": (1,), '"zoh"': ("zoh",), "SI": ({},),
             "the same names": ({},), "the model's": ({},), "the halves": ({},)}  # fmt: skip
    for of, heading in ((RobotFile, "The robot's file"), (Sidecar, "The log's file")):
        known = {f.name: f.default if f.default_factory is MISSING else f.default_factory()
                 for f in fields(of)}  # fmt: skip
        told = table(heading)
        for key in {*told} & {*known}:
            default = told[key][2]
            assert (known[key] is MISSING) == (default == "needed")
            if default in plain and key != "factors":
                assert known[key] in plain[default]
    assert float(table("parameters.NAME")["known"][2]) == KNOWN
    assert float(table("spread.NAME")["known"][2]) == alike.KNOWN
