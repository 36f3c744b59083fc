"""The figure of poses along a log hides no curve."""

from types import SimpleNamespace

import numpy as np
import pytest

from inca_mj.report.poses import poses_figure


@pytest.mark.parametrize("has_pose", [False, True])
def test_a_legend_covers_no_curve(has_pose):
    rng, t = np.random.default_rng(0), np.linspace(0, 1, 50)
    pose = rng.standard_normal((50, 6))  # fills the whole height of each axis
    log = SimpleNamespace(time=t)
    found = SimpleNamespace(log=log, pose=pose, std=np.full((50, 6), 1e-4),
                            measured=pose + 1e-4 if has_pose else None)  # fmt: skip
    figure = poses_figure(found)
    figure.draw_without_rendering()
    legends = [axis.get_legend() for axis in figure.axes if axis.get_legend() is not None]
    assert len(legends) == 2
    for legend in legends:
        box = legend.get_window_extent()
        assert not any(box.overlaps(axis.get_window_extent()) for axis in figure.axes)
        assert figure.bbox.y1 >= box.y1
