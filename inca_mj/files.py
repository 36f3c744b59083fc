"""Where the files that come with the program lie."""

from __future__ import annotations

from pathlib import Path

from identification.errors import InputError

_HERE = Path(__file__).resolve().parent
# In a wheel the models lie inside the package, in a checkout beside it, where a user looks first.
_FOLDERS = (_HERE / "models", _HERE.parent / "models")


def model_path(name: str = "inca6d.xml") -> Path:
    """The path of a model that comes with the program, installed or in a checkout.

    Raises:
        InputError: the file is not there: the installation is not whole.
    """
    for folder in _FOLDERS:
        if (folder / name).is_file():
            return folder / name
    raise InputError(
        f"the model {name} is in neither {' nor '.join(map(str, _FOLDERS))}; install inca-mj again"
    )
