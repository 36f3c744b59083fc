"""Archives of numpy, Parquet and LeRobot data sets give the numbers of the same log as CSV."""

import json
from dataclasses import replace

import numpy as np
import pyarrow as pa
import pytest
from example_logs import INPUTS, OUTPUTS, wave
from pyarrow import parquet

from identification import read_log

BEGIN = 1_748_873_654_316_744_521  # [ns], a stamp that no float holds


def log():
    return replace(wave(200), extras={}, units={})


def read(path, **more):
    return read_log(path, INPUTS, OUTPUTS, lenient=True, **more)


def same(back, first):
    return (
        back.inputs.tobytes() == first.inputs.tobytes()
        and back.outputs.tobytes() == first.outputs.tobytes()
        and np.allclose(back.time - back.time[0], first.time, atol=1e-9)
    )


def test_an_archive_of_vectors_or_of_columns(tmp_path):
    first = log()
    parts = {"time": first.time, "current": first.inputs, "angle": first.outputs}
    np.savez(tmp_path / "vectors.npz", **parts, picture=np.zeros((3, 3, 3)), title="a run")
    np.savez(tmp_path / "columns.npz", time=first.time, **first.columns)
    assert same(read(tmp_path / "vectors.npz"), first)
    assert same(read(tmp_path / "columns.npz"), first)
    assert same(read_log(tmp_path / "columns.npz", INPUTS, OUTPUTS), first)


def test_an_archive_without_stamps_says_its_step(tmp_path):
    first = log()
    path = tmp_path / "run.npz"
    np.savez(path, current=first.inputs, angle=first.outputs, Ts=0.01)
    assert same(read(path), first)
    np.savez(path, current=first.inputs, angle=first.outputs)
    assert same(read(path, said={"sampling_time": 0.01}), first)


@pytest.mark.parametrize("as_dates", [True, False])
def test_whole_nanoseconds_are_read_to_the_last_digit(tmp_path, as_dates):
    first = log()
    ns = BEGIN + 10_000_000 * np.arange(len(first))
    stamps = ns.astype("datetime64[ns]") if as_dates else ns
    said = {"columns": {"stamp": "time"}} | ({} if as_dates else {"units": {"time": "ns"}})
    np.savez(tmp_path / "run.npz", stamp=stamps, **first.columns)
    parquet.write_table(pa.table({"stamp": stamps, **first.columns}), tmp_path / "run.parquet")
    for name in ("run.npz", "run.parquet"):
        assert same(read(tmp_path / name, said=said), first)


def test_a_table_of_parquet_with_lists_and_empty_cells(tmp_path):
    first = log()
    path = tmp_path / "run.parquet"
    parquet.write_table(pa.table({"time": first.time, "words": ["a"] * len(first),
        "current": first.inputs.tolist(), "angle": first.outputs.tolist()}), path)  # fmt: skip
    assert same(read(path), first)
    columns = {"time": first.time, **{n: x.tolist() for n, x in first.columns.items()}}
    columns["angle_1"][7] = None
    parquet.write_table(pa.table(columns), path)
    assert "1 empty cell" in read(path).remarks[0]


JOINTS = ("shoulder", "elbow")
STATES = tuple(f"observation.state.{joint}" for joint in JOINTS)
ACTIONS = tuple(f"action.{joint}" for joint in JOINTS)


def write_data_set(folder, logs, fps, one_file):
    """Write logs as the episodes of a LeRobot data set, of version 3 or, a file each, 2."""
    feature = {"dtype": "float32", "shape": [2]}
    info = {
        "fps": fps, "total_episodes": len(logs),
        "features": {"observation.state": {**feature, "names": list(JOINTS)},
                     "action": {**feature, "names": {"motors": list(JOINTS)}}},
    }  # fmt: skip
    (folder / "meta").mkdir(parents=True)
    (folder / "data" / "chunk-000").mkdir(parents=True)
    (folder / "meta" / "info.json").write_text(json.dumps(info))
    tables = [
        pa.table({
            "observation.state": pa.array(each.outputs.tolist(), pa.list_(pa.float64())),
            "action": pa.array(each.inputs.tolist(), pa.list_(pa.float64(), 2)),
            "timestamp": np.arange(len(each), dtype=np.float32) / np.float32(fps),
            "frame_index": np.arange(len(each)), "episode_index": np.full(len(each), number),
        })
        for number, each in enumerate(logs)
    ]  # fmt: skip
    place = folder / "data" / "chunk-000"
    if one_file:
        parquet.write_table(pa.concat_tables(tables), place / "file-000.parquet")
    else:
        for number, table in enumerate(tables):
            parquet.write_table(table, place / f"episode_{number:06d}.parquet")
    return folder


@pytest.mark.parametrize("one_file", [True, False])
def test_an_episode_of_a_data_set_is_a_log(tmp_path, one_file):
    first = log()
    other = replace(first, outputs=2 * first.outputs)
    home = write_data_set(tmp_path / "set", [first, other], 30, one_file)
    for number, each in enumerate((first, other)):
        back = read_log(home / f"episode_{number}", ACTIONS, STATES, lenient=True)
        assert back.inputs.tobytes() == each.inputs.tobytes()
        assert back.outputs.tobytes() == each.outputs.tobytes()
        assert back.name == f"episode_{number}"
        assert back.time == pytest.approx(np.arange(len(each)) / 30, abs=1e-12)


def test_an_episode_is_asked_for_where_there_are_several(tmp_path, refusal):
    home = write_data_set(tmp_path / "set", [log()] * 3, 30, True)
    said = refusal(read_log, home, ACTIONS, STATES)
    assert f"give one or more of them as {home / 'episode_0'} to {home / 'episode_2'}" in said
    file = home / "data" / "chunk-000" / "file-000.parquet"
    assert str(home / "episode_0") in refusal(read_log, file, ACTIONS, STATES)
    assert "has no episode 7; it has episodes 0 to 2" in refusal(
        read_log, home / "episode_7", ACTIONS, STATES
    )
    alone = tmp_path / "run.parquet"
    alone.write_bytes(file.read_bytes())
    assert "save each as a file of its own" in refusal(read_log, alone, ACTIONS, STATES)
    one = write_data_set(tmp_path / "one", [log()], 30, False)
    assert len(read_log(one, ACTIONS, STATES, lenient=True)) == len(log())


@pytest.mark.parametrize("kind", ["npz", "parquet"])
def test_damaged_and_empty_files_are_refused_in_one_sentence(tmp_path, refusal, kind):
    path = tmp_path / f"run.{kind}"
    path.write_bytes(b"\0" * 200)
    assert "damaged" in refusal(read, path)
    if kind == "npz":
        np.savez(path, title="a run")
        assert "has no arrays of numbers" in refusal(read, path)
    else:
        parquet.write_table(pa.table({"words": ["a", "b"]}), path)
        assert "has no numbers" in refusal(read, path)
