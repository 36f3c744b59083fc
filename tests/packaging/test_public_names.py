"""The public lists: every name is there, for Python and for type checkers, and says what it is."""

import inspect
import json
import re
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules

import pytest

ROOT = Path(__file__).parents[2]
PACKAGES = ("identification", "inca_mj", "inca_mj.kinematics", "identification.sweep")
OPTIONAL = {"load_environment": "dm_control", "load_gymnasium": "dm_control"}


def public(package):
    """Every public name of a package that can be had here, and what it names."""
    module = import_module(package)
    for name in module.__all__:
        if name in OPTIONAL:
            try:
                import_module(OPTIONAL[name])
            except ImportError:
                continue
        yield name, getattr(module, name)


@pytest.mark.parametrize("package", PACKAGES)
def test_the_names_are_there_and_no_module_takes_their_place(package):
    module = import_module(package)
    assert dir(module) == sorted(module.__all__)
    assert all(thing is not None for _, thing in public(package))
    # a module of the same name would take the name's place, or not, by the order of imports
    assert not {m.name for m in iter_modules(module.__path__)} & set(module.__all__)
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        _ = module.nonsense


@pytest.mark.parametrize("package", PACKAGES)
def test_a_name_comes_from_the_module_that_defines_it(package):
    source = Path(import_module(package).__file__).read_text(encoding="utf-8")
    places = re.findall(r"^    from ([\w.]+) import (\w+) as \2$", source, re.M)
    places = {name: place for place, name in places}
    for name, thing in public(package):
        if hasattr(thing, "__module__"):
            assert thing.__module__ == places[name]


def shown():
    """The words of all code that a user sees: of documents, notebooks, examples and benchmarks."""
    pages = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]
    code = [re.findall(r"```.*?```|`[^`\n]+`", p.read_text(encoding="utf-8"), re.S) for p in pages]
    for path in (ROOT / "docs").rglob("*.ipynb"):
        cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
        code += [cell["source"] for cell in cells if cell["cell_type"] == "code"]
    scripts = [*(ROOT / "examples").glob("*.py"), *(ROOT / "benchmarks").rglob("*.py")]
    code += [[path.read_text(encoding="utf-8")] for path in scripts]
    return {word for texts in code for text in texts for word in re.findall(r"\w+", text)}


def annotated(package):
    """The words of what public functions take and return."""
    functions = [thing for _, thing in public(package) if inspect.isfunction(thing)]
    each = (str(f.__annotations__.values()) for f in functions)
    return {word for text in each for word in re.findall(r"\w+", text)}


def test_a_name_is_public_because_a_user_meets_it():
    module = import_module("identification")
    assert set(module.__all__) - shown() - annotated("identification") == set()
    assert not {"halves", "joined", "loss", "drives"} & set(module.__all__)
