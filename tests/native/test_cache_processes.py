"""Laws that one process compiled are, in another, the same to the bit."""

import re

import pytest
from cache_cases import output, start

pytestmark = pytest.mark.long  # test_cache has the laws of an entry with a callback that is small


@pytest.fixture(scope="module")
def home(tmp_path_factory):
    return tmp_path_factory.mktemp("home")


@pytest.fixture(scope="module")
def compiled(home):
    """What two processes print that compile and write the same laws at the same time."""
    both = [start(XDG_CACHE_HOME=str(home), INCA_MJ_CACHE="", PYTHONHASHSEED=seed) for seed in "12"]
    return [output(process) for process in both]


def test_two_processes_at_once(compiled, home):
    first, second = compiled
    assert first == second
    assert all(float(line.split()[0]) > 0 for line in first.splitlines())  # everything moves
    names = [entry.name for entry in (home / "inca_mj").iterdir()]
    assert len(names) >= 5  # each callback of the joints and of the cables, and no draft
    assert all(re.fullmatch("[0-9a-f]{64}", name) for name in names)


def test_loaded_laws_give_the_same_trajectories(compiled, home):
    loaded = start("refuse", XDG_CACHE_HOME=str(home), INCA_MJ_CACHE="")
    assert output(loaded) == compiled[0]


def test_laws_without_the_cache_give_the_same_trajectories(compiled, tmp_path):
    alone = start(XDG_CACHE_HOME=str(tmp_path), INCA_MJ_CACHE="off")
    assert output(alone) == compiled[0]
    assert not list(tmp_path.iterdir())
