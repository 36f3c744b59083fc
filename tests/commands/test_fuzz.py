"""The fuzzer finds what it is to find, makes a case again, and finds nothing here."""

import os
import signal
import time

import campaign
import pytest
from campaign import case, run
from targets import TARGETS, Target

FAST = ("log", "sidecar", "lenient log", "spread", "options")
posix = pytest.mark.skipif(os.name != "posix", reason="forks")


def bad(read):
    return Target(lambda d: (d / "x").write_text("a = 1\n"), ("x",), read, 1.0)


def traceback(folder):
    if (folder / "x").read_bytes() != b"a = 1\n":
        raise KeyError("a")


def crash(folder):
    if (folder / "x").read_bytes() != b"a = 1\n":
        os.kill(os.getpid(), signal.SIGSEGV)


def hang(folder):
    if (folder / "x").read_bytes() != b"a = 1\n":
        time.sleep(60)


def busy(folder):
    while (folder / "x").read_bytes() != b"a = 1\n":
        pass


@posix
def test_a_reader_that_computes_for_ever_is_found(monkeypatch):
    monkeypatch.setitem(TARGETS, "bad", bad(busy))
    monkeypatch.setattr(campaign, "PATIENCE", 0.3)
    found = run("bad", 0, range(2))
    assert found.counts["hang"] >= 1


@posix
@pytest.mark.parametrize("kind", [traceback, crash])
def test_a_bad_reader_is_found(monkeypatch, kind):
    monkeypatch.setitem(TARGETS, "bad", bad(kind))
    monkeypatch.setattr(campaign, "PATIENCE", 0.3)
    monkeypatch.setattr(campaign, "WAITING", 0.5)
    found = run("bad", 0, range(4))
    assert found.counts.total() == 4
    assert found.counts[kind.__name__] >= 3  # a change may change nothing
    assert [k for k, _, _ in found.finds] == [kind.__name__] * len(found.finds)


@posix
@pytest.mark.parametrize("name", FAST)
def test_damaged_files_are_read_or_refused_in_one_line(name):
    assert run(name, 12, range(150)).finds == []


def test_a_case_is_its_seed_and_number():
    right = {"log.csv": b"time,x\n0,1\n1,2\n"}
    cases = [case("log", 3, k, right) for k in range(40)]
    assert cases == [case("log", 3, k, right) for k in range(40)]
    assert len({content for _, content in cases}) > 30
