"""The published EMPS example, where its data are at hand."""

import importlib.util
import os
from pathlib import Path

import numpy as np
import pytest

from identification.effects.joint_plant import joint_plant
from identification.windows.window_error import window_error
from identification.windows.window_estimate import estimate_windows

PATH = Path(__file__).parents[2] / "examples" / "emps.py"
DATA = Path(os.environ.get("EMPS_DATA", "data/emps"))
SPEC = importlib.util.spec_from_file_location("emps", PATH)
emps = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(emps)


def test_the_model_holds_the_published_values():
    import mujoco

    model = mujoco.MjModel.from_xml_path(str(emps.MODEL))
    assert model.body("carriage").mass[0] == emps.PUBLISHED["M"]
    assert model.dof_damping[0] == emps.PUBLISHED["F_v"]


@pytest.mark.skipif(
    not (DATA / "DATA_EMPS.mat").exists(),
    reason="EMPS_DATA names no folder with DATA_EMPS.mat; get it from nonlinearbenchmark.org",
)
def test_published_values_and_what_they_lack_come_out_of_the_records():
    log, pulses = (emps.read_emps(DATA / f"DATA_EMPS{s}.mat") for s in ("", "_PULSES"))
    plant = joint_plant(emps.MODEL, emps.RECORDS, log)
    size = "asymmetric_viscous_friction.d_a@slide"
    fit = estimate_windows(plant, log, tuple(emps.START), 0.2, emps.START, tolerance=1e-4)
    for name, value in fit.values.items():
        assert value == pytest.approx(emps.PUBLISHED[name], rel=0.05)
    more = estimate_windows(plant, log, (*emps.START, size), 0.2, fit.values, tolerance=1e-4)
    assert more.values[size] == pytest.approx((166.7 - 240.4) / 2, rel=0.1)
    before, after = (
        np.mean(window_error(plant, pulses, 0.2, e.values) ** 2) for e in (fit, more)
    )  # fmt: skip
    assert after < 0.55 * before
