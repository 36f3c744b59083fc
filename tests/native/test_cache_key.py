"""The key changes with everything that machine code depends on, and with nothing else."""

from collections import namedtuple
from math import cos, sin
from types import ModuleType

import numpy as np
import pytest
from numba import njit, types

from identification.native import cache_key
from identification.native.cache_key import UnknownDependency, key_of
from identification.native.memory import load_constant, load_double, load_int, load_word

SIGNATURE = types.double(types.double)


def made(text, **names):
    """The function f that a text defines, with some global names."""
    space = {"njit": njit, **names}
    exec(text, space)
    return space["f"]


def key(text="def f(x): return a * x", **names):
    return key_of(made(text, **names), SIGNATURE)


def closure(a):
    def f(x):
        return a * x

    return f


def through(function, **options):
    """f calls a compiled function, which calls another."""
    g = njit(**options)(function)
    h = njit(lambda x: g(x) + 1.0)
    return key("def f(x): return h(x)", h=h)


def module(**names):
    own = ModuleType("own")
    vars(own).update(names)
    return own


Pair = namedtuple("Pair", "left right")
Other = namedtuple("Other", "left right")
Renamed = namedtuple("Pair", "left up")
VALUES = [
    None, True, 1, 1.0, -0.0, 0.0, np.float64(1.0), np.float32(1.0), 1j, "1", b"1", float("nan"),
    (1, 2), (1, (2,)), ((1, 2),), [1, 2], frozenset({1, 2}), Pair(1, 2), Other(1, 2),
    Renamed(1, 2), Pair, Other, Renamed, np.arange(3), np.arange(3.0), np.arange(4),
    np.arange(4).reshape(2, 2), np.dtype(float), types.float64, types.float32, sin, cos, np.sin,
    np.cos, np.float64, float, njit(sin_ := lambda x: sin(x)), njit(lambda x: cos(x)),
    njit(sin_, error_model="numpy"), (njit(sin_), 1), load_constant, load_double, load_int,
    load_word, SIGNATURE, types.double(types.int64), module(b=1), np,
]  # fmt: skip


def test_every_value_has_its_own_key():
    keys = [key(a=value) for value in VALUES]
    assert len(set(keys)) == len(VALUES)
    assert keys == [key(a=value) for value in VALUES]


def test_where_a_function_stands_does_not_matter():
    assert key(a=1.0) == key("\n\n\ndef f(x): return a * x", a=1.0)


def test_what_a_function_does_not_read_does_not_matter():
    assert key(a=1.0, b=1.0) == key(a=1.0, b=2.0)
    text = "def f(x): return x.b"  # a field, not the global
    assert key(text, b=1.0) == key(text, b=2.0)


@pytest.mark.parametrize(
    "text",
    [
        "def f(x): return a * x + 0.0",
        "def f(x): return a * x * 2",
        "def f(x, y=2.0): return a * x",
        "def f(x): return (lambda y: a + y)(x)",
    ],
)
def test_other_code_has_another_key(text):
    others = {key(text, a=1.0), key(a=1.0), key("def f(x, y=3.0): return a * x", a=1.0)}
    assert len(others) == 3


def test_functions_are_followed_through_other_functions():
    assert through(lambda x: x * 2.0) == through(lambda x: x * 2.0)
    assert through(lambda x: x * 2.0) != through(lambda x: x * 3.0)
    assert through(lambda x: x * 2.0) != through(lambda x: x * 2.0, fastmath=True)


def test_a_module_of_ones_own_counts_by_what_is_read_of_it():
    text = "def f(x): return m.b * x"
    assert key(text, m=module(b=1.0, c=1.0)) == key(text, m=module(b=1.0, c=2.0))
    assert key(text, m=module(b=1.0)) != key(text, m=module(b=2.0))


def test_signature_and_machine_count(monkeypatch):
    f = closure(1.0)
    keys = {key_of(f, SIGNATURE), key_of(f, types.double(types.int64))}
    machine = cache_key.machine()
    for k in range(len(machine)):
        other = (*machine[:k], machine[k] + " other", *machine[k + 1 :])
        monkeypatch.setattr(cache_key, "machine", lambda other=other: other)
        keys.add(key_of(f, SIGNATURE))
    assert len(keys) == 2 + len(machine)


def plain(x):
    return x


@pytest.mark.parametrize("value", [plain, object(), plain.__code__])
def test_what_nobody_knows_is_refused(value):
    with pytest.raises(UnknownDependency):
        key(a=value)
