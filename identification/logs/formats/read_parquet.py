"""Tables of Parquet, and the episodes of LeRobot data sets, which are such tables.

A LeRobot data set is a folder with `meta/info.json` and files of Parquet below `data`. Its columns
`observation.state` and `action` are lists, whose entries have names in that file:

    observation.state.elbow        action.elbow        time

Its stamps are the number of the frame through the rate of the camera, in a float of 32 bits. They
are read as frame_index / fps, the same number in all its digits.
"""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Collection, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from identification.errors import InputError
from identification.logs.formats.arrays import KINDS, names_of, table_of
from identification.logs.table import Table
from identification.runtime.lazy import needed
from identification.storage.files import MAX_BYTES, is_file, read_bytes, read_json

EXTRA, READING = "parquet", "reading Parquet and LeRobot data sets"
WIDEST = 256  # entries of a list: more is a picture, and no signal
UNPACKED = 8  # times as large the numbers of a file may be as the largest file
EPISODE, FRAME, STAMP = "episode_index", "frame_index", "timestamp"  # columns of LeRobot
_PATH = re.compile(r"episode_(\d{1,9})")
_ABOVE = 3  # folders above a file of a data set, among which is that of the data set


def episode_of(path: Path) -> int | None:
    """Returns the number of an episode that a path names; None where it names no episode.

    Such a path is `SET/episode_3`, where SET is the folder of a LeRobot data set; SET itself is its
    only episode, and is refused where it has several.
    """
    if is_file(path / "meta" / "info.json"):
        return _only_episode(path)
    found = _PATH.fullmatch(path.name)
    return int(found[1]) if found and is_file(path.parent / "meta" / "info.json") else None


def read_parquet(
    path: Path,
    wanted: Callable[[Sequence[str]], Collection[str]] | None,
    stamps: Collection[str] = ("time",),
) -> Table:
    """Reads the table in a file of Parquet, or in an episode `SET/episode_3` of a LeRobot data set.

    Raises:
        InputError: pyarrow is not installed, the file is damaged, or it holds several episodes.
    """
    number = episode_of(path)
    if number is None:
        content = _opened(path)
        home = next((p for p in [*path.parents][:_ABOVE] if is_file(p / "meta/info.json")), None)
        info = _info(home) if home else {}
        if EPISODE in content.column_names:
            _refuse_several(content, path, home)
    else:
        home = path if is_file(path / "meta" / "info.json") else path.parent
        info, content = _info(home), _episode(home, number)
    columns = _columns(content, info, stamps)
    return table_of(path, columns, wanted, stamps, lambda row: f"row {row + 1} of {path}")


def _columns(
    content: Any, info: Mapping[str, Any], stamps: Collection[str]
) -> dict[str, Callable[[], np.ndarray]]:
    """Returns what reads each column of numbers in a table of pyarrow, by name."""
    out: dict[str, Callable[[], np.ndarray]] = {}
    for name in content.column_names:
        chunked = content.column(name)
        width = _width(chunked)
        for k, column in enumerate(names_of(name, width, _labels(info, name))):
            if width or _is_number(chunked.type) or str(chunked.type).startswith("timestamp"):
                out[column] = partial(_numbers, chunked, width, k)
    fps = info.get("fps")
    if STAMP in out and STAMP not in stamps and "time" not in out and EPISODE in out:
        stamp = out.pop(STAMP)
        out = {"time": partial(_frames, stamp, out[FRAME], fps) if FRAME in out else stamp, **out}
    return out


def _frames(
    stamp: Callable[[], np.ndarray], frame: Callable[[], np.ndarray], fps: object
) -> np.ndarray:
    """Returns the stamps of frames [s], shape (n,), in all digits where they are frame / fps."""
    stamped = stamp()
    if not isinstance(fps, int | float) or not fps > 0:
        return stamped
    exact = frame() / fps
    return exact if np.all(np.abs(exact - stamped) <= 1e-3 / fps) else stamped


def _width(chunked: Any) -> int:
    """Returns the length of the lists in a column; 0 where it has none, or not of one length."""
    import pyarrow.compute as pc

    kind, types = chunked.type, needed("pyarrow", EXTRA, READING).types
    if not (types.is_list(kind) or types.is_large_list(kind) or types.is_fixed_size_list(kind)):
        return 0
    lengths = pc.unique(pc.list_value_length(chunked)).to_pylist()
    is_one = len(lengths) == 1 and lengths[0] and lengths[0] <= WIDEST and not chunked.null_count
    return int(lengths[0]) if is_one and _is_number(kind.value_type) else 0


def _is_number(kind: Any) -> bool:
    types = needed("pyarrow", EXTRA, READING).types
    return bool(types.is_integer(kind) or types.is_floating(kind) or types.is_boolean(kind))


def _numbers(chunked: Any, width: int, k: int) -> np.ndarray:
    """Returns a column, or the entry k of its lists, shape (n,); NaN where nothing stands."""
    import pyarrow.compute as pc

    values = pc.list_element(chunked, k) if width else chunked
    array = np.asarray(values.to_numpy())
    return array if array.dtype.kind in KINDS else array.astype(np.float64)


def _labels(info: Mapping[str, Any], name: str) -> tuple[str, ...]:
    """Returns the names that a data set gives the entries of a column; none where it gives none."""
    features = info.get("features")
    feature = features.get(name) if isinstance(features, dict) else None
    names = feature.get("names") if isinstance(feature, dict) else None
    if isinstance(names, dict):  # {"motors": ["shoulder", ...]} or {"shoulder": 0, ...}
        names = next((v for v in names.values() if isinstance(v, list)), [*names])
    return tuple(map(str, names)) if isinstance(names, list) else ()


def _info(home: Path) -> dict[str, Any]:
    content = read_json(
        home / "meta" / "info.json", "description of a LeRobot data set", "download it again"
    )
    return content if isinstance(content, dict) else {}


def _only_episode(home: Path) -> int:
    count = _info(home).get("total_episodes")
    if count == 1:
        return 0
    last = f" to {home / f'episode_{count - 1}'}" if isinstance(count, int) and count > 1 else ""
    raise InputError(
        f"{home} is a data set of several episodes, each of which is a log; give one or more of"
        f" them as {home / 'episode_0'}{last}"
    )


def _refuse_several(content: Any, path: Path, home: Path | None) -> None:
    import pyarrow.compute as pc

    numbers = sorted(pc.unique(content.column(EPISODE)).to_pylist())
    if len(numbers) > 1:
        cure = (
            f"give one or more of them as {home / f'episode_{numbers[0]}'}"
            if home
            else "save each as a file of its own"
        )
        raise InputError(
            f"{path} holds {len(numbers)} episodes ({numbers[0]} to {numbers[-1]}), each of which"
            f" is a log; {cure}"
        )


def _episode(home: Path, number: int) -> Any:
    """Returns the rows of an episode as a table of pyarrow."""
    needed("pyarrow.parquet", EXTRA, READING)
    import pyarrow as pa
    import pyarrow.compute as pc

    files = sorted((home / "data").rglob("*.parquet"))
    matching = [file for file in files if file.stem == f"episode_{number:06d}"]
    found: list[int] = []
    for file in matching or files:
        rows = _opened(file, [EPISODE]).column(EPISODE)
        found += pc.unique(rows).to_pylist()
        if number in found:
            content = _opened(file)
            return content.filter(pc.equal(content.column(EPISODE), pa.scalar(number)))
    text = f"episodes {min(found)} to {max(found)}" if found else "no file with episodes below data"
    raise InputError(f"{home} has no episode {number}; it has {text}")


def _opened(path: Path, columns: list[str] | None = None) -> Any:
    """Returns a file of Parquet, or some of its columns, as a table of pyarrow."""
    parquet = needed("pyarrow.parquet", EXTRA, READING)
    raw = read_bytes(path, what="file of Parquet")
    try:
        file = parquet.ParquetFile(io.BytesIO(raw))
        groups = range(file.metadata.num_row_groups)
        size = sum(file.metadata.row_group(k).total_byte_size for k in groups)
        if size <= UNPACKED * MAX_BYTES:
            return file.read(columns)
    except Exception as error:  # a damaged file may raise any
        raise InputError(
            f"{path} is no file of Parquet, or is damaged ({type(error).__name__}); write it again"
        ) from error
    raise InputError(
        f"{path} has {size / 2**20:.0f} MB when it is unpacked, more than the"
        f" {UNPACKED * MAX_BYTES / 2**20:.0f} MB that are read at once; cut it into shorter logs"
    )
