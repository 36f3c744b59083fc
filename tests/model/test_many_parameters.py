"""A robot with many joints has thousands of parameters: what is done with them grows as they do."""

import pytest

from identification.errors import InputError, repeated
from identification.model.parameter import Parameter, ParameterSet

MANY = 400


class Counted(str):
    """A name that counts how often it is compared with another one."""

    comparisons = 0
    __hash__ = str.__hash__

    def __eq__(self, other):
        Counted.comparisons += 1
        return str.__eq__(self, other)


@pytest.fixture
def names(monkeypatch):
    monkeypatch.setattr(Counted, "comparisons", 0)
    return [Counted(f"damping_{k}") for k in range(MANY)]


def test_names_are_compared_with_few_others(names):
    assert repeated([*names, *names[3:5]]) == ["damping_3", "damping_4"]
    assert Counted.comparisons < 10 * MANY


def test_new_values_ask_for_each_parameter_once(names):
    every = ParameterSet("many", tuple(
        Parameter(name=n, value=1.0, unit="N m s/rad", where=f"joint/{n}.damping", lower=0.0,
                  upper=10.0)
        for n in names
    ))  # fmt: skip
    values = {n: 2.0 + k / MANY for k, n in enumerate(names)}
    new = every.with_values(values)
    assert new.values() == values
    assert all(new[n].value == values[n] for n in names)
    assert Counted.comparisons < 30 * MANY


def test_an_unknown_parameter_is_told():
    with pytest.raises(InputError, match=r"unknown parameter 'mas'.*mass"):
        ParameterSet("one", (Parameter(name="mass", value=1.0, unit="kg", where="body/b.mass",
                                       lower=0.0, upper=9.0),))["mas"]  # fmt: skip
