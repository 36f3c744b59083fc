"""The public lists: every name is there, and none is a module's too."""

from importlib import import_module
from pkgutil import iter_modules

import pytest


@pytest.mark.parametrize("package", ["identification", "inca_mj"])
def test_public_names(package):
    module = import_module(package)
    assert module.__all__
    assert dir(module) == sorted(module.__all__)
    for name in module.__all__:
        assert getattr(module, name) is not None
    # a module of the same name would take the name's place, or not, by the order of imports
    assert not {m.name for m in iter_modules(module.__path__)} & set(module.__all__)
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        _ = module.nonsense
