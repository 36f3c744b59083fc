"""The places of the files that come with the program."""

from __future__ import annotations

from pathlib import Path

from identification.errors import InputError

_HERE = Path(__file__).resolve().parent


def model_path(name: str = "inca6d.xml") -> Path:
    """Returns the path of a model that comes with the program, installed or in a checkout.

    Args:
        name: of the file.

    Raises:
        InputError: the file is not there: the installation is not whole.
    """
    return _shipped("models", name)


def example_path(name: str = "log.csv") -> Path:
    """Returns the path of an example that comes with the program, installed or in a checkout.

    Args:
        name: of the file; a wheel holds `log.csv` with its `log.toml`, a checkout holds more.

    Raises:
        InputError: the file is not there: the installation is not whole.
    """
    return _shipped("examples", name)


def _shipped(folder: str, name: str) -> Path:
    """Returns the path of a shipped file: in the package if in a wheel, else beside it."""
    places = (_HERE / folder, _HERE.parent / folder)
    for place in places:
        if (place / name).is_file():
            return place / name
    raise InputError(
        f"the file {name} is in neither {' nor '.join(map(str, places))}; install inca-mj again"
    )
