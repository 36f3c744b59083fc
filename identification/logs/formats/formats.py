"""Which reader reads a log, by what its path is.

    run.csv                  text, a row for each sample
    run.mat                  MATLAB: u, y and Ts
    run.npz                  arrays of numpy, by name
    run.parquet              a table of Parquet
    set/episode_3            an episode of a LeRobot data set, the folder set
    run.mcap  run.db3  run.bag  run      ROS: one file, or the folder that `ros2 bag record` makes

Those that need a package of an extra say so when it is lacking.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from pathlib import Path

from identification.errors import InputError
from identification.logs.formats.arrays import read_npz
from identification.logs.formats.csv_files import parse_csv
from identification.logs.formats.read_bag import SUFFIXES as OF_ROS
from identification.logs.formats.read_bag import is_bag_folder, read_bag
from identification.logs.formats.read_mat import parse_mat
from identification.logs.formats.read_parquet import episode_of, read_parquet
from identification.logs.table import Table
from identification.storage.files import LOG, check_file, read_bytes

Wanted = Callable[[Sequence[str]], Collection[str]]  # of the columns of a file, those to be read
KINDS = (".csv", ".mat", ".npz", ".parquet", *OF_ROS)


def refuse_no_log(path: Path) -> None:
    """Refuse a path that names neither a file nor a folder that is a log, without reading it."""
    if episode_of(path) is None and not is_bag_folder(path):
        check_file(path, what=LOG)


def log_table(
    path: Path,
    wanted: Wanted | None,
    *,
    header: Sequence[str] = (),
    stamps: Collection[str] = ("time",),
    asked: Collection[str] = (),
    of_matlab: tuple[Sequence[str], Sequence[str], Sequence[str]] = ((), (), ()),
) -> Table:
    """Returns the table of columns in a log, whatever its kind.

    Args:
        path: of the file, of a folder of ROS, or of an episode of a LeRobot data set.
        wanted: says which of the columns of a file to read, whose empty cells are NaN; all
            columns, and no empty cells in a CSV, when None.
        header: names of the columns of a CSV that has none.
        stamps: columns of time, which count less the first one where a float cannot hold them.
        asked: columns that the file should have, for messages.
        of_matlab: names of inputs, outputs and optional columns of a MATLAB file, which has none.

    Raises:
        InputError: the file cannot be read, or is no log.
    """
    kind = path.suffix.lower()
    if episode_of(path) is not None:
        return read_parquet(path, wanted, stamps)
    if is_bag_folder(path) or kind in OF_ROS:
        return read_bag(path, wanted, asked)
    if kind == ".csv":
        return parse_csv(read_bytes(path), path, header, wanted, stamps)
    if kind == ".mat":
        return parse_mat(read_bytes(path), path, *of_matlab)
    if kind == ".npz":
        return read_npz(path, wanted, stamps)
    if kind == ".parquet":
        return read_parquet(path, wanted, stamps)
    raise InputError(
        f"{path} is no log that can be read, which are {', '.join(KINDS)}; export it as one of them"
    )
