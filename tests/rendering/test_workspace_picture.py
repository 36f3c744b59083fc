"""The picture of a workspace."""

import numpy as np
import pytest
from PIL import Image
from statics_cases import ROBOT

from identification.errors import InputError
from inca_mj.rendering.workspace_picture import workspace_picture
from inca_mj.robot.geometry import INCA
from inca_mj.robot.parameters import parameter_set
from inca_mj.statics.workspace import DriveLimits, workspace

TRIAL = parameter_set("trial")
SIZE = (240, 180)


def _blue(path):
    """How many pixels are much bluer than red."""
    with Image.open(path) as image:
        assert image.size == SIZE
        picture = np.asarray(image.convert("RGB"), int)
    return ((picture[..., 2] - picture[..., 0]) > 40).sum()


def test_a_larger_workspace_covers_more_of_the_picture(opengl, tmp_path):
    large = workspace("closure", ROBOT, cells=8)
    small = workspace("feasible", ROBOT, cells=8, limits=DriveLimits(force=3.0, torque=0.1))
    pixels = [
        _blue(workspace_picture(w, tmp_path / f"{w.kind}.png", TRIAL, INCA, size=SIZE))
        for w in (large, small)
    ]
    assert pixels[0] > 1.5 * pixels[1] > 0


def test_an_empty_workspace_is_refused(tmp_path):
    nothing = workspace("feasible", ROBOT, cells=8, limits=DriveLimits(force=500.0))
    assert nothing.volume == 0
    with pytest.raises(InputError, match="no point of the grid lies in the wrench-feasible"):
        workspace_picture(nothing, tmp_path / "a.png", TRIAL, INCA)
    assert not (tmp_path / "a.png").exists()
