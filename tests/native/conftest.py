"""A cache folder of its own for a test, and a count of what numba compiles."""

from pathlib import Path

import numpy as np
import pytest
from cache_cases import SIGNATURE, power

from identification.native import cache
from identification.native.cache_key import key_of


class Compiler:
    """Numba, with a count of what it compiled."""

    def __init__(self):
        self.count = 0
        self.compile = cache.compile_callback

    def __call__(self, function, signature):
        self.count += 1
        return self.compile(function, signature)


@pytest.fixture
def folder(tmp_path, monkeypatch) -> Path:
    """The cache folder, not made yet, of a user with a new home."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "home"))
    monkeypatch.delenv(cache.VARIABLE, raising=False)
    return tmp_path / "home" / "inca_mj"


@pytest.fixture
def compiler(monkeypatch) -> Compiler:
    counted = Compiler()
    monkeypatch.setattr(cache, "compile_callback", counted)
    return counted


@pytest.fixture
def entry(folder) -> Path:
    """The entry of `power`, written by numba."""
    cache.compile_once(power, SIGNATURE)
    return folder / key_of(power, SIGNATURE)


@pytest.fixture
def same_as_python():
    """Says whether a callback returns what Python does; it is called on many numbers."""

    def check(callback, function=power):
        numbers = np.random.default_rng(0).normal(size=(50, 2))
        got = [callback(*pair) for pair in numbers]
        np.testing.assert_allclose(got, [function(*pair) for pair in numbers], rtol=1e-14)
        return np.array(got)

    return check
