"""Files that no program wrote: each is refused in one sentence, and none ends the program."""

import json
import re
import sys

import numpy as np
import pytest

from identification import InputError, read_log
from identification.discovery.options import read_options
from identification.runtime import child as child_process
from inca_mj.cli import main
from inca_mj.robot.geometry import INCA, read_geometry, write_geometry
from inca_mj.robot.inputs import prbs
from inca_mj.twin.logs import ANGLES, CURRENTS
from inca_mj.twin.run import load_run, save_run, simulate
from inca_mj.twin.saved import load_twin, save_twin
from inca_mj.twin.twin import build_twin
from inca_mj.workflows.spread import read_spread

DEEP = "a = " + 5000 * "[" + 5000 * "]"
DIGITS = "9" * 400
FIRST = "  [1.5, 1.5, 0.1],"


def test_a_geometry_has_numbers_only(tmp_path):
    path = write_geometry(INCA, tmp_path / "geometry.toml")
    text = path.read_text()
    assert FIRST in text
    path.write_text(text.replace(FIRST, '  ["1.5", 1.5, 0.1],', 1))
    with pytest.raises(InputError, match="exits must be 8 rows of 3 finite numbers"):
        read_geometry(path)


@pytest.mark.parametrize("read", [read_geometry, read_options, read_spread])
@pytest.mark.parametrize("text", [DEEP, "\x00"])
def test_what_is_no_toml_is_told_so(tmp_path, read, text):
    path = tmp_path / "some.toml"
    path.write_text(text)
    with pytest.raises(InputError, match=r"is not TOML \(.{1,120}\); correct it, or give a"):
        read(path)


def test_a_message_is_one_line_whatever_it_quotes():
    said = str(InputError(f"file a\nb\x08 has {20 * DIGITS}; give less"))
    assert said.isprintable()
    assert said.startswith("file a b\\x08 has 999")
    assert said.endswith("999; give less")
    assert len(said) < 300
    assert str(InputError(said)) == said


@pytest.mark.parametrize(("arguments", "said"), [
    (["film", "examples/log.csv", "--speed", "1e-300"], "frames, more than"),
    (["identify", "examples/log.csv", "--seed", "-1"], "seed -1 is negative"),
])  # fmt: skip
def test_a_number_that_would_fill_the_memory_or_the_day_is_refused_first(
    monkeypatch, capsys, request, arguments, said
):
    monkeypatch.chdir(request.config.rootpath)
    assert main(arguments) == 2
    assert said in capsys.readouterr().err


@pytest.fixture(scope="module")
def run():
    return simulate(build_twin(), prbs(21, 0.01))


def broken(run, path, **arrays):
    save_run(run, path)
    with np.load(path) as file:
        content = {**{name: file[name] for name in file}, **arrays}
    np.savez(path, **content)
    return path


@pytest.mark.parametrize("arrays", [
    {"tension": np.full((21, 8), np.nan)}, {"act": np.array("text")},
])  # fmt: skip
def test_a_saved_run_that_no_simulation_gives_is_refused(run, tmp_path, arrays):
    with pytest.raises(InputError, match=r"write (the run|it) again"):
        load_run(broken(run, tmp_path / "run.npz", **arrays))


@pytest.fixture(scope="module")
def twin(tmp_path_factory):
    folder = tmp_path_factory.mktemp("twin")
    save_twin(build_twin(), folder)
    return {name: (folder / name).read_text() for name in ("model.xml", "effects.json")}


def put(files, folder, **changed):
    for name, text in {**files, **changed}.items():
        (folder / name).write_text(text)
    return folder


@pytest.mark.parametrize(("key", "value"), [
    ("timestep", "fast"), ("values", {"m": "heavy"}),
])  # fmt: skip
def test_a_saved_twin_with_an_entry_of_another_kind_is_refused(twin, tmp_path, key, value):
    record = {**json.loads(twin["effects.json"]), key: value}
    folder = put(twin, tmp_path, **{"effects.json": json.dumps(record)})
    with pytest.raises(InputError):
        load_twin(folder)
    record.pop(key)
    put(twin, tmp_path, **{"effects.json": json.dumps(record)})
    with pytest.raises(InputError, match=r"effects\.json is damaged \(KeyError"):
        load_twin(folder)


@pytest.mark.parametrize(("text", "other", "field"), [
    ('timestep="0.001"', 'timestep="0.001" gravity="0 0 -1"', "gravity"),
    ('integrator="RK4"', 'integrator="Euler"', "integrator"),
])  # fmt: skip
def test_an_edit_of_the_physics_is_noticed(twin, tmp_path, text, other, field):
    assert text in twin["model.xml"]
    changed = twin["model.xml"].replace(text, other, 1)
    folder = put(twin, tmp_path, **{"model.xml": changed})
    with pytest.raises(InputError, match=f"{field} differs"):
        load_twin(folder)


def test_another_rounding_of_the_last_digits_is_no_edit(twin, tmp_path):
    """As of a twin that was saved on another processor."""
    number = re.compile(r'user="([^"]*)"')

    def rounded(match):
        return f'user="{" ".join(repr(float(x) * (1 + 2e-15)) for x in match[1].split())}"'

    changed = number.sub(rounded, twin["model.xml"])
    assert changed != twin["model.xml"]
    load_twin(put(twin, tmp_path, **{"model.xml": changed}))


CHILDREN = {
    "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)": "cannot be read as a MATLAB file",
    "raise MemoryError": "cannot be read as a MATLAB file",
    "import sys; sys.exit(3)": "is a MATLAB 7.3",
    "import time; time.sleep(60)": "is not read within",
}


@pytest.mark.parametrize("child", CHILDREN)
@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_a_matlab_file_that_kills_its_reader_is_refused(tmp_path, monkeypatch, child):
    (tmp_path / "child.py").write_text(child)
    (tmp_path / "log.mat").write_bytes(b"MATLAB 5.0")
    monkeypatch.setattr(child_process, "__file__", str(tmp_path / "child.py"))
    monkeypatch.setattr(
        "identification.logs.formats.read_mat.SECONDS", 2.0 if "sleep" in child else 60.0
    )
    with pytest.raises(InputError, match=CHILDREN[child]):
        read_log(tmp_path / "log.mat", CURRENTS, ANGLES)
