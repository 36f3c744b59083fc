"""Discovery where drives differ: their scatter is no effect, and a drive that is off is one."""

from dataclasses import replace

import numpy as np
import pytest
from as_built_cases import COMMON, NOISE, SPREAD, log_as_built, robot_as_built

from identification.report.discovery.json import discovery_to_json
from inca_mj.effects.catalogue import CATALOGUE
from inca_mj.robot.inputs import prbs
from inca_mj.robot.parameters import parameter_set
from inca_mj.twin.logs import run_to_log
from inca_mj.twin.run import simulate
from inca_mj.workflows.discovery import discover
from inca_mj.workflows.discovery_model import named_twin

SOME = tuple(
    e for e in CATALOGUE
    if e.name in ("torque_constant_mismatch", "asymmetric_friction", "drum_eccentricity")
)  # fmt: skip


def log_with(seed, seconds=3.0, **values):
    """A log of the robot as built with other values."""
    robot = robot_as_built().with_values(values)
    log = run_to_log(simulate(robot, prbs(round(100 * seconds), 0.01, seed=seed)), f"record {seed}")
    noise = NOISE * np.random.default_rng(seed).standard_normal(log.outputs.shape)
    return replace(log, outputs=log.outputs + noise, extras={}, units={})


def test_drives_that_differ_as_drives_do_lack_nothing():
    found = discover(log_as_built(4.0), spread=SPREAD, effects=SOME)
    assert found.verdict == "nothing missing"
    assert found.after.rms < 2 * NOISE


@pytest.fixture(scope="module")
def off():
    """A drive with 15 % less torque than it should have, in two records."""
    logs = [log_with(seed, 2.5, **{"K_t@5": -0.15}, x=x) for seed, x in ((3, 0.0), (4, 0.04))]
    return discover(logs, spread=SPREAD, effects=SOME)


@pytest.mark.long
def test_a_drive_that_is_off_by_more_is_named(off):
    (named,) = off.named
    assert named.candidate.key == ("torque_constant_mismatch", "drive 5")
    ((value, _, _),) = named.parameters.values()
    v = off.final.point.values  # the drive may deviate beside its mismatch, as any drive may
    assert v["K_t"] * (1 + v["K_t@5"]) * (1 + value) == pytest.approx(
        0.85 * COMMON["K_t"], rel=0.01
    )
    assert abs(value + 0.15) < 3 * SPREAD.drives["K_t"]
    assert off.after.rms < 2 * NOISE < off.before.rms
    assert named_twin(off).parameters.values()["torque_constant_mismatch.delta@5"] == value


@pytest.mark.long
def test_each_record_is_told_by_itself(off):
    records = discovery_to_json(off)["records"]
    assert [r["file"] for r in records] == ["record 3", "record 4"]
    assert all(r["role"] == "fit" and r["after"] < r["before"] for r in records)


@pytest.mark.long
def test_the_common_value_does_not_hide_a_drive_that_is_off():
    """A drive 45 % off is 1.45 of the others; parts within three std may be 1.3/0.7 = 1.86."""
    kind = tuple(e for e in CATALOGUE if e.name == "viscous_friction_mismatch")
    off = 0.45
    found = discover(log_with(5, 4.0, **{"b_v@6": off}), spread=SPREAD, effects=(*SOME, *kind))
    (named,) = found.named
    assert named.candidate.key == ("viscous_friction_mismatch", "drive 6")
    v = found.final.point.values
    ((value, _, _),) = named.parameters.values()
    whole = v["b_v"] * (1 + v["b_v@6"]) * (1 + value)
    assert whole == pytest.approx(parameter_set().values()["b_v"] * (1 + off), rel=0.05)
    assert found.after.rms < 2 * NOISE
