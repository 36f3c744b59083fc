"""Logs that read well and cannot be of a robot that moves are refused in a sentence."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from identification import InputError, write_log
from inca_mj.twin.logs import read_inca_log

LOG = Path(__file__).parents[2] / "examples" / "log.csv"


def written(path: Path, **changes: object) -> Path:
    whole = read_inca_log(LOG)
    short = whole.between(0.0, 1.0)
    write_log(replace(short, extras={}, units={}, splits={}, **changes), path)
    return path


def test_a_log_in_which_nothing_moves(tmp_path: Path) -> None:
    still = np.zeros((100, 8))
    with pytest.raises(InputError, match="nothing moves in"):
        read_inca_log(written(tmp_path / "still.csv", outputs=still))


def test_time_in_milliseconds(tmp_path: Path) -> None:
    time = 10.0 * np.arange(100)
    with pytest.raises(InputError, match="is it in milliseconds"):
        read_inca_log(written(tmp_path / "slow.csv", time=time))


def test_the_log_as_it_is(tmp_path: Path) -> None:
    assert len(read_inca_log(written(tmp_path / "log.csv"))) == 100
