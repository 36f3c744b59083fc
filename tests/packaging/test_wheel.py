import os
import subprocess
import sys
from pathlib import Path
from zipfile import ZipFile

import pytest

pytest.importorskip("hatchling", reason="the build backend is not installed")

ROOT = Path(__file__).parents[2]
PACKAGES = ("inca_mj", "identification")


def run(*words, cwd, **environment):
    done = subprocess.run(
        [sys.executable, *map(str, words)],
        cwd=cwd,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def build(kind, source, out):
    run("-m", "hatchling", "build", "-t", kind, "-d", out, cwd=source)
    (made,) = out.iterdir()
    return made


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    return build("wheel", ROOT, tmp_path_factory.mktemp("wheel"))


@pytest.fixture(scope="module")
def sdist(tmp_path_factory):
    return build("sdist", ROOT, tmp_path_factory.mktemp("sdist"))


def names(wheel):
    with ZipFile(wheel) as archive:
        return {n for n in archive.namelist() if ".dist-info/" not in n}


def package_files():
    return {
        path.relative_to(ROOT).as_posix()
        for package in PACKAGES
        for path in (ROOT / package).rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }


def test_the_wheel_holds_the_packages_the_models_and_an_example_and_nothing_else(wheel):
    assert names(wheel) == package_files() | {
        "inca_mj/models/inca6d.xml",
        "inca_mj/models/inca6d_plain.xml",
        "inca_mj/models/inca6d_spread.toml",
        "inca_mj/examples/log.csv",
        "inca_mj/examples/log.toml",
    }
    # type checkers read our annotations only where this file says that they may
    assert {f"{package}/py.typed" for package in PACKAGES} <= names(wheel)


def test_the_wheel_says_what_it_is(wheel):
    with ZipFile(wheel) as archive:
        text = {n.split("dist-info/")[1]: archive.read(n).decode() for n in archive.namelist()
                if ".dist-info/" in n}  # fmt: skip
    for line in (
        "inca = inca_mj.__main__:program",
        "identification = identification.__main__:program",
    ):
        assert line in text["entry_points.txt"]
    assert "Apache License" in text["licenses/LICENSE"]
    metadata = text["METADATA"]
    assert "License-Expression: Apache-2.0" in metadata
    assert "Provides-Extra: control" in metadata
    needed = [
        n for n in metadata.splitlines() if n.startswith("Requires-Dist") and "extra" not in n
    ]
    assert not any("dm-control" in line for line in needed)


@pytest.mark.long
def test_the_sdist_makes_the_same_wheel(sdist, wheel, tmp_path):
    subprocess.run(["tar", "-xzf", sdist, "-C", tmp_path], check=True)
    (folder,) = tmp_path.iterdir()
    for name in ("LICENSE", "README.md", "CHANGELOG.md", "models/inca6d.xml", "tests"):
        assert (folder / name).exists(), name
    (tmp_path / "out").mkdir()
    assert names(build("wheel", folder, tmp_path / "out")) == names(wheel)


def test_the_installed_wheel_works_away_from_its_source(wheel, tmp_path):
    target, empty = tmp_path / "target", tmp_path / "empty"
    empty.mkdir()
    pip = "-m", "pip", "install", "-q", "--disable-pip-version-check"
    run(*pip, "--no-deps", "--no-index", "--target", target, wheel, cwd=empty)
    code = (
        "import inca_mj, mujoco; from inca_mj.files import example_path, model_path; "
        "model = mujoco.MjModel.from_xml_path(str(model_path())); "
        "print(model_path(), model.nu, example_path(), sep='\\n')"
    )
    path, drives, log = run("-c", code, cwd=empty, PYTHONPATH=str(target)).split()
    assert Path(path) == target / "inca_mj" / "models" / "inca6d.xml"
    assert drives == "8"
    assert Path(log) == target / "inca_mj" / "examples" / "log.csv"
