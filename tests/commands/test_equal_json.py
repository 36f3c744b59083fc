"""`--json` of two equal runs is equal to the byte but for the times, under the key `seconds`."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from robot_cases import TOML, simulated, write_slider

from identification.logs.formats.csv_files import write_log
from inca_mj.twin.logs import read_inca_log

LOG = Path(__file__).parents[2] / "examples" / "log.csv"
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "INCA_MJ_THREADS")
LINES = (
    pytest.param("identification fit robot.toml log.csv", marks=pytest.mark.long),
    pytest.param("identification fit horizon.toml log.csv", marks=pytest.mark.long),
    pytest.param("identification discover robot.toml long.csv", marks=pytest.mark.long),
    pytest.param("identification discover few.toml long.csv", marks=pytest.mark.long),
    pytest.param("identification linearize robot.toml", marks=pytest.mark.long),
    "inca_mj compare twin.csv",
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with a robot that is fitted in a free run, and over a horizon."""
    folder = tmp_path_factory.mktemp("robot")
    write_slider(folder)
    (folder / "horizon.toml").write_text("horizon = 0.3\nown = ['qpos[0]', 'qvel[0]']\n" + TOML)
    few = "[effects]\nonly = ['coulomb_friction', 'stiffness']\n"
    (folder / "few.toml").write_text("horizon = 0.3\n" + TOML + few)
    write_log(simulated({"damping": 3.3, "mass": 2.2}, 600), folder / "long.csv")
    write_log(read_inca_log(LOG).between(0.0, 2.0), folder / "twin.csv")
    return folder


def printed(folder, line, seed, threads):
    """What a program prints where sets have another order, and sums another number of threads."""
    done = subprocess.run(
        [sys.executable, "-m", *line.split(), "--json"], cwd=folder, capture_output=True, text=True,
        env=os.environ | {"PYTHONHASHSEED": str(seed), **dict.fromkeys(THREADS, str(threads))},
        check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout


def untimed(text):
    """A printed object as text, without its times."""
    return json.dumps(json.loads(text, object_hook=lambda each: {k: v for k, v in each.items()
                                                                if k != "seconds"}))  # fmt: skip


@pytest.mark.parametrize("line", LINES)
def test_two_equal_runs_print_the_same(folder, line):
    one, other = printed(folder, line, 1, 1), printed(folder, line, 4242, 2)
    assert untimed(one) == untimed(other)
