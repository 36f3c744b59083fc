"""What a public docstring promises: every argument, shapes and units of arrays, errors raised.

What is checked is what can be: an argument that is not told, an array without its shape or unit,
and an `InputError` or `DivergenceError` that can be raised and is not told. Whether the words are
true, only a reader can tell.
"""

import dataclasses
import functools
import inspect
import re
import types

import pytest
from test_public_names import PACKAGES, public

SECTION = re.compile(r"^(Args|Attributes|Raises|Returns|Yields):\n((?:(?: .*)?\n?)*)", re.M)
ENTRY = re.compile(r"^ {4}(\w+): ((?:.*\n?)(?: {8}.*\n?)*)", re.M)
ARRAY = re.compile(r"\b(ndarray|FloatArray|Array)\b")
ERRORS = ("InputError", "DivergenceError")
# An error that a reader of the code sees cannot come out, with the reason.
CANNOT_RAISE = {}
THINGS = [
    pytest.param(package, name, thing, id=f"{package}.{name}")
    for package in PACKAGES
    for name, public_thing in public(package)
    for thing in [getattr(public_thing, "py_func", public_thing)]  # of a compiled function
    if inspect.isfunction(thing) or inspect.isclass(thing)
]


def sections(thing):
    return dict(SECTION.findall(inspect.cleandoc(thing.__doc__ or "") + "\n"))


def entries(thing, section):
    return dict(ENTRY.findall(sections(thing).get(section, "")))


def fields(thing):
    """Names and annotations of what it takes: of a record, its fields."""
    if inspect.isclass(thing):
        if not dataclasses.is_dataclass(thing):
            return {}
        # an option tells its unit and its reason itself
        own = [f for f in dataclasses.fields(thing) if f.init and not f.metadata.get("reason")]
        return {f.name: str(f.type) for f in own}
    parameters = inspect.signature(thing).parameters.values()
    return {p.name: str(p.annotation) for p in parameters}


def told(thing):
    return entries(thing, "Attributes" if inspect.isclass(thing) else "Args")


@pytest.mark.parametrize(("package", "name", "thing"), THINGS)
def test_it_has_a_docstring_that_tells_every_argument(package, name, thing):
    assert thing.__doc__
    # a record without a docstring gets its signature from `dataclass`
    assert not thing.__doc__.startswith(f"{name}(")
    wanted = fields(thing)
    if inspect.isfunction(thing) and len(wanted) == 1 and not told(thing):
        return  # one argument, told in the summary
    assert set(told(thing)) >= set(wanted)
    if inspect.isfunction(thing):
        assert set(told(thing)) == set(wanted)


@pytest.mark.parametrize(("package", "name", "thing"), THINGS)
def test_an_array_has_its_shape_and_its_unit(package, name, thing):
    arrays = {n for n, kind in fields(thing).items() if ARRAY.search(kind)}
    for array in arrays:
        text = " ".join(told(thing).get(array, thing.__doc__).split())
        assert re.search(r"shape|\(\w+(, \w+)*,?\)", text), array
        assert re.search(r"\[[^\]]+\]|\bunits?\b|relative|coordinates|\btrue\b|\bbool", text), array
    if inspect.isfunction(thing):
        back = str(inspect.signature(thing).return_annotation)
        if ARRAY.search(back):
            text = " ".join(thing.__doc__.split())
            assert re.search(r"shape|\(\w+(, \w+)*,?\)", text)
            assert re.search(r"\[[^\]]+\]|\bunits?\b|relative|coordinates|%", text)


@functools.cache
def raised(function):
    """Errors that a function raises or lets out of the functions that it names."""
    source = inspect.getsource(function)
    tells = sections(function).get("Raises", "")
    out = {e for e in ERRORS if re.search(rf"raise {e}\b", source)}
    if re.search(r"raise (unknown_name|unknown_number)\b", source):
        out.add("InputError")
    return out | {e for e in ERRORS if e in tells}


def called(function):
    """Functions of ours that the code of a function names, without those that it catches."""
    names = {n for code in codes(function.__code__) for n in code.co_names}
    for name in names:
        thing = function.__globals__.get(name)
        if inspect.isfunction(thing) and thing.__module__.split(".")[0] in PACKAGES:
            yield thing


def codes(code):
    yield code
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            yield from codes(constant)


@pytest.mark.parametrize(("package", "name", "thing"), THINGS)
def test_the_errors_that_it_raises_are_told(package, name, thing):
    own = thing if inspect.isfunction(thing) else getattr(thing, "__post_init__", None)
    own = inspect.unwrap(own) if own else None
    if not inspect.isfunction(own):
        return
    can = raised(own).union(*map(raised, called(own)))
    assert can - CANNOT_RAISE.get(name, set()) <= {
        e for e in ERRORS if e in sections(thing).get("Raises", "")
    }
