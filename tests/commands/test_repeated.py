"""Options of several values add up, in every program."""

import pytest

from identification.commands.cli import Command
from identification.commands.repeated import gathered
from identification.native.cache import VARIABLE, enabled
from inca_mj.cli import Command as IncaCommand


@pytest.mark.parametrize(
    ("commands", "written", "read"),
    [
        (IncaCommand, "identify a.csv --free A --free B", "identify a.csv --free A B"),
        (IncaCommand, "identify a.csv --free A B --json --free=C",
         "identify a.csv --free A B C --json"),
        (IncaCommand, "identify a.csv --param m=1 --seed 3 --param=b=2",
         "identify a.csv --param m=1 b=2 --seed 3"),
        (IncaCommand, "identify a.csv --seed 3 --seed 4", "identify a.csv --seed 3 --seed 4"),
        (Command, "fit r.toml a.csv --confirm b.csv --json --confirm c.csv -- --free",
         "fit r.toml a.csv --confirm b.csv c.csv --json -- --free"),
        (Command, "fit r.toml a.csv --trust start --trust units",
         "fit r.toml a.csv --trust start units"),
        (Command, "fit --help", "fit --help"),
        (Command, "", ""),
    ],
)  # fmt: skip
def test_what_is_repeated_adds_up(commands, written, read):
    assert gathered(commands, written.split()) == read.split()


@pytest.mark.parametrize("word", ["off", "no", "0", "false", "False", "NO "])
def test_words_that_switch_the_cache_off(monkeypatch, word):
    monkeypatch.setenv(VARIABLE, word)
    assert not enabled()
    monkeypatch.setenv(VARIABLE, "")
    assert enabled()
