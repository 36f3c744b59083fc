"""The folder of records: Parquet files that are written whole, so that a kill costs no record.

FOLDER/records/part-000000012-….parquet   one record, written as its task ended
FOLDER/records/rows-….parquet             many of them, put together
FOLDER/.sweep.json                        whose records these are

A file is written under a hidden name, brought to the disk, and renamed. Its name ends with a digest
of its content, so a file that is not whole is none, and its tasks run again. While a sweep runs,
its single records are put together now and then, and at its end all are one file.
`pandas.read_parquet(FOLDER / "records")` reads them at any time. If the program is killed while it
puts files together, some records are there twice, until the sweep is resumed.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, Self
from uuid import uuid4

from identification.errors import InputError
from identification.runtime.lazy import needed
from identification.storage.files import digest, read_json, to_disk, write_text
from identification.sweep.rows import schema
from identification.sweep.task import Sweep

RECORDS = "records"
KEY = ".sweep.json"
_LOCK = ".sweep.lock"
TOGETHER = 256  # single records that are put into one file
_BLOCK = 20_000  # rows that are held at once
_LARGEST = 2**36  # bytes of a file of records, which is read a part at a time


class Store:
    """The records of one sweep in a folder; one program at a time writes them.

    Attributes:
        sweep: whose records they are.
        folder: in which `records` lies.
    """

    def __init__(self, sweep: Sweep, folder: Path) -> None:
        self._pa: Any = needed("pyarrow", "sweep", "a sweep")
        self.sweep, self.folder = sweep, folder
        self._schema = schema(sweep)
        self._lock: int | None = None
        self._single: list[Path] = []
        self.done: set[int] = set()

    @property
    def records(self) -> Path:
        """The folder of the Parquet files."""
        return self.folder / RECORDS

    def __enter__(self) -> Self:
        """Lock the folder and look at what is there.

        Raises:
            InputError: the records of another sweep lie there, or another program writes.
        """
        try:
            self.records.mkdir(parents=True, exist_ok=True)
            self._lock = os.open(self.folder / _LOCK, os.O_CREAT | os.O_RDWR, 0o666)
        except OSError as error:
            raise InputError(
                f"cannot make folder {self.records}: {error.strerror}; choose another"
            ) from error
        try:
            _lock(self._lock, self.folder)
            self._refuse_other()
            self._look()
        except BaseException:
            os.close(self._lock)
            raise
        return self

    def __exit__(self, *error: object) -> None:
        if self._lock is not None:
            os.close(self._lock)  # the lock ends with it

    def add(self, row: dict[str, Any]) -> None:
        """Write the record of a task; it is on the disk when this returns."""
        table = self._pa.Table.from_pylist([row], schema=self._schema)
        path = _write_whole(self.records, f"part-{row['task']:09d}", self._schema, [table])
        self.done.add(row["task"])
        self._single.append(path)
        if len(self._single) >= TOGETHER:
            self._merge(self._single)
            self._single = []

    def rows(self) -> Iterator[dict[str, Any]]:
        """Yields all records in the order of their tasks, a part of them in memory at a time."""
        for table in self._tables(self._files()):
            yield from table.to_pylist()

    def finish(self) -> Path | None:
        """Put all records into one file, in the order of their tasks; returns its path."""
        files = self._files()
        self._single = []
        return self._merge(files) if len(files) > 1 else next(iter(files), None)

    def drop_errors(self) -> int:
        """Remove the records of tasks that met an error, so that they run again; how many."""
        compute: Any = needed("pyarrow.compute", "sweep", "a sweep")
        files, before = self._files(), len(self.done)
        good = (table.filter(compute.is_null(table["error"])) for table in self._tables(files))
        _write_whole(self.records, f"rows-{uuid4().hex}", self._schema, good)
        for file in files:
            file.unlink()
        self._look()
        return before - len(self.done)

    def _refuse_other(self) -> None:
        key = self.folder / KEY
        mine = {"digest": self.sweep.digest(), "sweep": str(self.sweep.path)}
        if not key.exists():
            if self._files():
                raise InputError(
                    f"{self.records} holds Parquet files and {self.folder} does not say whose;"
                    " give --out a new folder"
                )
            write_text(key, json.dumps(mine, indent=1) + "\n")
            return
        try:
            theirs = read_json(key, "record of a sweep", "give --out a new folder")
            other = theirs["digest"] != mine["digest"]
        except (InputError, KeyError, TypeError) as error:
            raise InputError(f"{key} cannot be read; give --out a new folder") from error
        if other:
            raise InputError(
                f"{self.folder} holds the records of another sweep ({theirs.get('sweep')}, or this"
                " one before it was changed); give --out a new folder"
            )

    def _look(self) -> None:
        """Finds what is done; removes drafts, files that are not whole, and what is there twice."""
        for draft in self.records.glob(".*.tmp"):
            draft.unlink()
        tasks: list[tuple[Path, set[int]]] = []
        for path in self._files():
            try:
                tasks.append((path, read_tasks(path)))
            except OSError:
                path.unlink()  # not whole, so it is no record
        self.done, self._single = set(), []
        for path, here in sorted(tasks, key=lambda each: -len(each[1])):
            if here <= self.done:
                path.unlink()
                continue
            self.done |= here
            if len(here) == 1:
                self._single.append(path)

    def _files(self) -> list[Path]:
        return sorted(self.records.glob("*.parquet"))

    def _tables(self, files: Sequence[Path]) -> Iterator[Any]:
        """Yields the rows of some files in the order of their tasks, a block at a time."""
        dataset: Any = needed("pyarrow.dataset", "sweep", "a sweep")
        if not files:
            return
        every = dataset.dataset([str(file) for file in files], schema=self._schema)
        task = dataset.field("task")
        for first in range(0, len(self.sweep), _BLOCK):
            table = every.to_table(filter=(task >= first) & (task < first + _BLOCK)).sort_by("task")
            if len(table):
                yield table

    def _merge(self, files: Sequence[Path]) -> Path:
        name = f"rows-{uuid4().hex}"
        path = _write_whole(self.records, name, self._schema, self._tables(files))
        for file in files:
            file.unlink()
        return path


def _lock(number: int, folder: Path) -> None:
    try:
        import fcntl
    except ImportError:  # a system without it
        return
    try:
        fcntl.flock(number, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        raise InputError(
            f"another sweep writes into {folder} now; wait for it, or give --out another folder"
        ) from error


def _write_whole(folder: Path, stem: str, schema: Any, tables: Iterable[Any]) -> Path:
    """Write tables into a file that is there whole when this returns; returns its path."""
    parquet: Any = needed("pyarrow.parquet", "sweep", "a sweep")
    draft = folder / f".{stem}.tmp"
    with draft.open("w+b") as stream:
        with parquet.ParquetWriter(stream, schema, compression="zstd") as writer:
            for table in tables:
                writer.write_table(table)
        stream.flush()
        os.fsync(stream.fileno())
    path = folder / f"{stem}-{_digest(draft)}.parquet"
    draft.replace(path)
    to_disk(folder)
    return path


def read_tasks(path: Path) -> set[int]:
    """Returns the tasks of a file; raises OSError where it is not whole, or was changed."""
    parquet: Any = needed("pyarrow.parquet", "sweep", "a sweep")
    if not path.stem.endswith(f"-{_digest(path)}"):
        raise OSError(f"{path} is not what was written")
    return set(parquet.read_table(path, columns=["task"])["task"].to_pylist())


def _digest(path: Path) -> str:
    return digest(path, _LARGEST, "record of a sweep")[:16]
