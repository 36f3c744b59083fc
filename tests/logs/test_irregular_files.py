"""A pipe, a device or gigabytes in the place of any file are refused and not waited for."""

import os

import numpy as np
import pytest
from folder_cases import list_foreign

from identification import InputError, read_log
from identification.linear.export import load_system
from identification.report.page.media import image_source, video_source
from identification.storage.files import read_archive, read_bytes, read_json, read_text, read_toml
from identification.storage.folders import MADE, whole_folder
from inca_mj.twin.run import load_run
from inca_mj.twin.saved import load_twin, save_twin
from inca_mj.twin.twin import build_twin

pytestmark = pytest.mark.skipif(os.name != "posix", reason="pipes and devices of POSIX")
LARGE = 3 * 2**30  # [bytes]


def pipe(path):
    os.mkfifo(path)


def device(path):
    path.symlink_to("/dev/zero")


def sparse(path):
    with path.open("wb") as file:
        file.truncate(LARGE)


READERS = {
    "read_bytes": read_bytes,
    "read_text": read_text,
    "read_toml": read_toml,
    "read_json": lambda p: read_json(p, "list", "write it again"),
    "read_archive": lambda p: read_archive(p, "run"),
    "log": lambda p: read_log(p.rename(p.with_suffix(".csv")), ["u"], ["y"]),
    "system": load_system,
    "run": load_run,
    "picture": image_source,
    "film": video_source,
}


@pytest.mark.parametrize("make", [pipe, device, sparse])
@pytest.mark.parametrize("reader", READERS)
def test_a_reader_refuses_it(tmp_path, reader, make):
    make(tmp_path / "file")
    with pytest.raises(InputError, match=r"is not a regular file|MB, more than the"):
        READERS[reader](tmp_path / "file")


@pytest.mark.parametrize("name", ["effects.json", "model.xml"])
@pytest.mark.parametrize("make", [pipe, sparse])
def test_a_twin_with_a_file_that_is_none_is_refused(tmp_path, make, name):
    save_twin(build_twin(), tmp_path)
    (tmp_path / name).unlink()
    make(tmp_path / name)
    with pytest.raises(InputError, match=rf"{name}.*regular file|{name} has 3072 MB|no .*{name}"):
        load_twin(tmp_path)


@pytest.mark.parametrize("make", [pipe, device])
@pytest.mark.parametrize("name", ["result.json", MADE])
def test_a_folder_of_results_with_one_is_foreign_or_unknown(tmp_path, make, name):
    with whole_folder(tmp_path / "out") as draft:
        (draft / "result.json").write_text("{}")
    assert list_foreign(tmp_path / "out") == []
    (tmp_path / "out" / name).unlink()
    make(tmp_path / "out" / name)
    assert list_foreign(tmp_path / "out") == ["result.json"]


def test_a_file_that_grows_while_it_is_read_is_bounded(tmp_path, monkeypatch):
    (tmp_path / "file").write_bytes(bytes(101))
    monkeypatch.setattr("identification.storage.files.check_file", lambda *_: None)
    with pytest.raises(InputError, match="more than"):
        read_bytes(tmp_path / "file", 100)
    assert len(read_bytes(tmp_path / "file", 101)) == 101


def test_an_archive_that_unpacks_to_gigabytes_is_refused(tmp_path, monkeypatch):
    np.savez_compressed(tmp_path / "run.npz", a=np.zeros(2**20))
    assert read_archive(tmp_path / "run.npz", "run")["a"].shape == (2**20,)
    monkeypatch.setattr("identification.storage.files.MAX_BYTES", 2**19)
    with pytest.raises(InputError, match="more than the 4 MB"):
        read_archive(tmp_path / "run.npz", "run")


@pytest.mark.parametrize("name", ["a\0b", "a\0b/c", 300 * "a", "loop"])
def test_a_name_that_no_file_can_have_is_told(tmp_path, name):
    (tmp_path / "loop").symlink_to(tmp_path / "loop")
    with pytest.raises(InputError, match=r"cannot read|no such f(ile|older)"):
        read_bytes(tmp_path / name)
