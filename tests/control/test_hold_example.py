import runpy
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("dm_control", reason="dm_control runs on neither MuJoCo 4 nor Python 3.13")

EXAMPLE = Path(__file__).parents[2] / "examples" / "hold_the_handle.py"


def test_the_example_brings_the_handle_to_its_target():
    task = "hold"
    miss, reward = runpy.run_path(str(EXAMPLE))["hold"](seconds=3.0, seed=4, task=task)
    assert miss[-1] < 1e-3
    assert reward[-1] > 0.99
    if task == "hold":
        assert np.max(miss) < 0.01
