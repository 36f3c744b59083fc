"""The cache folder is the user's alone, and bounded."""

import os
import stat

import pytest

from identification.native import cache_folder
from identification.native.cache_folder import read, write


def test_only_the_user_may_enter(folder):
    before = os.umask(0)
    try:
        write("entry", b"content")
    finally:
        os.umask(before)
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    assert stat.S_IMODE((folder / "entry").stat().st_mode) == 0o600
    assert read("entry") == b"content"


def test_what_was_used_longest_ago_goes_first(folder, monkeypatch):
    monkeypatch.setattr(cache_folder, "LARGEST", 35)
    for k, name in enumerate("abc"):
        write(name, b"ten bytes.")
        os.utime(folder / name, (k, k))
    read("a")  # used now
    write("d", b"ten bytes.")
    assert {p.name for p in folder.iterdir()} == {"a", "c", "d"}


@pytest.mark.parametrize("given", ["", "relative/path"])
def test_where_it_is_without_an_absolute_path(given, tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", given)
    monkeypatch.setenv("HOME", str(tmp_path))
    assert cache_folder.folder() == tmp_path / ".cache" / "inca_mj"
