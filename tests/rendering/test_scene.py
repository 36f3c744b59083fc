"""Whatever a film is made of, it shows the same."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from identification.errors import InputError
from inca_mj.rendering.scene import Scene, make_scene
from inca_mj.twin.logs import read_inca_log
from inca_mj.twin.run import save_run
from inca_mj.workflows.comparison import compare

LOG = Path(__file__).parents[2] / "examples" / "log.csv"


def same(one, two):
    np.testing.assert_array_equal(one.run.qpos, two.run.qpos)
    np.testing.assert_array_equal(one.angles, two.angles)


def test_a_log_its_file_and_its_comparison_are_one_scene():
    log = read_inca_log(LOG)
    short = log.between(0.0, 0.5)
    from_log = make_scene(short)
    same(from_log, make_scene(compare(short)))
    same(make_scene(log, 0.3), make_scene(LOG, 0.3))
    same(make_scene(log, 0.3), from_log.until(float(from_log.run.time[29])))
    assert make_scene(from_log) is from_log


def test_a_log_that_is_wired_in_another_way_is_drawn_as_it_is():
    log = read_inca_log(LOG).between(0.0, 4.0)
    wrong = replace(log, outputs=-log.outputs)
    with pytest.raises(InputError, match="turn the sign"):
        compare(wrong)
    np.testing.assert_array_equal(make_scene(wrong).angles, wrong.outputs)


def test_a_saved_run_is_the_run_that_was_saved(short_run, tmp_path):
    scene = make_scene(save_run(short_run, tmp_path / "run.npz"), 0.25)
    np.testing.assert_array_equal(scene.run.qpos, short_run.qpos[:26])
    assert scene.angles is None


def test_the_ghost_ends_where_the_run_does(short_run):
    pose = np.hstack([short_run.position, short_run.angles])
    scene = Scene(short_run, short_run.motor_angle, pose).until(0.4)
    assert len(scene.run.time) == len(scene.angles) == len(scene.pose) == 41
    with pytest.raises(InputError, match="less than two samples"):
        scene.until(0.0)
