"""A result that writes itself: as plain values, as a report of one file, as a folder of files.

What its files hold depends on what was searched: a robot that a file describes, a twin, or a model
by hand. So whoever makes the result gives it `files_of`, which knows that and makes its `Files`.
The commands write the same `Files`.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from pathlib import Path
from typing import Any, Protocol

from identification.errors import InputError
from identification.storage.folders import draft_of
from identification.storage.results import RESULT, write_result


class Files(Protocol):
    """The files of a result."""

    @property
    def record(self) -> dict[str, Any]:
        """The result as plain values."""

    def keep(self, folder: Path, place: Path) -> dict[str, Any]:
        """Write the model into a folder, whose files will be read from `place`.

        Returns:
            What result.json tells of it beside `record`.
        """

    def write_page(self, path: Path) -> Path:
        """Write the report, one HTML file; returns its path."""

    def draw(self, folder: Path) -> None:
        """Write the report and its figures into a folder."""


class Written:
    """A result that can be written."""

    files_of: Callable[[Any], Files] | None

    @cached_property
    def files(self) -> Files:
        """The writer of the files of this result.

        Raises:
            InputError: the result was made by no public function.
        """
        if self.files_of is None:
            raise InputError(
                "this result has no files, because it does not know what it is of; take one that"
                " identification.discover, identification.fit or inca_mj.discover returns"
            )
        return self.files_of(self)

    def to_dict(self) -> dict[str, Any]:
        """Returns the result as plain values, those of `--json` (docs/json.md).

        What is unknown or not finite is None.

        Raises:
            InputError: the result was made by no public function, or a record that confirms cannot
                be predicted.
            DivergenceError: a model cannot be simulated on a record that confirms.
        """
        return self.files.record

    def report(self, path: str | Path) -> Path:
        """Write the report that a command writes: one HTML file, which needs no network.

        Args:
            path: of the file, such as "report.html"; its folder must exist.

        Returns:
            The path of the file.

        Raises:
            InputError: the file cannot be written, or as `to_dict`.
            DivergenceError: as `to_dict`.
        """
        return self.files.write_page(Path(path))

    def save(self, folder: str | Path) -> Path:
        """Save what a command saves with `--out`: result.json, the model, report and figures.

        `identification.load` reads result.json again. Results of an earlier search in this folder
        are replaced, and files of anybody else never.

        Args:
            folder: made where it is missing.

        Returns:
            The path of the folder.

        Raises:
            InputError: the folder holds other files or cannot be written, or as `to_dict`.
            DivergenceError: as `to_dict`.
        """
        with draft_of(folder) as draft:
            model = self.files.keep(draft.folder, draft.place)
            write_result(draft.folder / RESULT, None, {**self.files.record, **model})
            draft.save()
            self.files.draw(draft.folder)  # what was found is safe, whatever happens meanwhile
            draft.save()
        return draft.place
