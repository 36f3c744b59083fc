"""Parquet files that are there whole or not at all: the name of each ends with its digest."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

from identification.files import digest
from identification.sweep.extras import needed

_BLOCK = 20_000  # rows that are held at once
_LARGEST = 2**36  # bytes of a file of records, which is read a part at a time


def write_whole(folder: Path, stem: str, schema: Any, tables: Iterable[Any]) -> Path:
    """Write tables into a file that is there whole when this returns, or not at all.

    Args:
        folder: of the file.
        stem: how its name begins; a digest of its content follows.
        schema: of the tables, as pyarrow has it.
        tables: one after the other.

    Returns:
        The path of the file.
    """
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
    _sync_folder(folder)
    return path


def read_tasks(path: Path) -> set[int]:
    """Reads the tasks of a file.

    Raises:
        InputError: it is no regular file.
        OSError: the file is not whole, or was changed.
    """
    parquet: Any = needed("pyarrow.parquet", "sweep", "a sweep")
    if not path.stem.endswith(f"-{_digest(path)}"):
        raise OSError(f"{path} is not what was written")
    return set(parquet.read_table(path, columns=["task"])["task"].to_pylist())


def _digest(path: Path) -> str:
    return digest(path, _LARGEST, "record of a sweep")[:16]


def read_tables(files: Sequence[Path], schema: Any, count: int) -> Iterator[Any]:
    """Yields the rows of some files in the order of their tasks, a block at a time.

    Args:
        files: with a column `task`.
        schema: of the tables.
        count: of all tasks.
    """
    dataset: Any = needed("pyarrow.dataset", "sweep", "a sweep")
    if not files:
        return
    every = dataset.dataset([str(file) for file in files], schema=schema)
    task = dataset.field("task")
    for first in range(0, count, _BLOCK):
        table = every.to_table(filter=(task >= first) & (task < first + _BLOCK)).sort_by("task")
        if len(table):
            yield table


def _sync_folder(folder: Path) -> None:
    """Bring the names in a folder to the disk, where the system can."""
    try:
        number = os.open(folder, os.O_RDONLY)
    except OSError:
        return
    try:
        os.fsync(number)
    finally:
        os.close(number)
