"""Calibration: known deviations come back, from one record and from several."""

from dataclasses import replace

import numpy as np
import pytest
from as_built_cases import COMMON, NOISE, SPREAD, deviations, log_as_built

from identification import InputError
from inca_mj.report.calibration import calibration_json, calibration_verdict, untold, unusual
from inca_mj.robot.geometry import DRIVES
from inca_mj.workflows.calibration import calibrate
from inca_mj.workflows.spread import INERTIAS, KNOWN, NONE, spread_of


@pytest.fixture(scope="module")
def one():
    return calibrate([log_as_built(4.0)], spread=SPREAD)


@pytest.fixture(scope="module")
def two():
    """Two records that begin 5 cm apart, and a third one that confirms."""
    logs = [log_as_built(2.0), log_as_built(2.0, seed=1, x=0.05)]
    return calibrate(logs, spread=SPREAD, confirm=[log_as_built(1.5, seed=2, x=-0.03)])


def test_deviations_come_back_within_their_std(one):
    """Sixteen deviations and two common values: of so many the largest error is below 4 std."""
    truth = deviations() | COMMON
    error = np.array([(one.values[n] - truth[n]) / one.std[n] for n in truth])
    assert np.abs(error).max() < 4
    assert np.sqrt(np.mean(error**2)) < 1.6  # 18 squares of mean 1, five of their std


def test_the_calibrated_robot_predicts_what_it_has_not_seen(one):
    (gap,) = one.unseen
    assert gap.after < 2 * NOISE < gap.before
    assert not untold(one)
    assert not unusual(one)
    assert "one record" in calibration_verdict(one)[0]


def test_the_scatter_is_that_of_the_drawn_deviations(one):
    for group, names in SPREAD.groups.items():
        drawn = np.sqrt(np.mean([deviations()[name] ** 2 for name in names]))
        assert one.scatter[group] == pytest.approx(min(drawn, SPREAD.drives[group]), rel=0.25)


@pytest.mark.long
def test_records_share_drives_and_begin_at_poses_of_their_own(two):
    values, std = two.values, two.std
    assert abs(values["x [2]"] - 0.05) < 5 * std["x [2]"] + 1e-4
    assert abs(values["x"]) < 5 * std["x"] + 1e-4
    for name, true in deviations().items():
        assert abs(values[name] - true) < 5 * std[name], name
    (gap,) = two.unseen
    assert gap.role == "confirm"
    assert gap.after < 2 * NOISE < gap.before


def test_a_part_far_from_what_is_usual_is_told(one):
    """The same calibration, where usual robots scatter by a tenth of what this one does."""
    tight = {name: std / 10 for name, std in SPREAD.drives.items()}
    judged = replace(one, spread=replace(SPREAD, drives=tight))
    names = {name for _, name, _ in unusual(judged)}
    limit = 4 * 0.1  # of 16 normal variables the largest is below 3.4 std in 99 % of robots
    expected = {n for n, x in deviations().items() if abs(x) > limit * SPREAD.drives[n[:-2]]}
    assert expected
    assert expected <= names
    said = " ".join(calibration_verdict(judged))
    assert "Far from what is usual: drive " in said
    assert "run inca discover" in said
    assert calibration_json(judged)["unusual"][0]["name"] in names


def test_what_cannot_be_calibrated_is_refused(refusal):
    log = log_as_built(2.0)
    assert "inca identify" in refusal(calibrate, [log], spread=NONE)
    assert "no log" in refusal(calibrate, [], spread=SPREAD)
    assert "given twice" in refusal(calibrate, [log], spread=SPREAD, confirm=[log])


def test_a_part_that_leaves_nothing_to_judge_by_is_refused():
    log = log_as_built(4.0)
    log = replace(log, splits={"estimation": (2.0, 3.9)})
    with pytest.raises(InputError, match="does not begin where"):
        calibrate([log], spread=SPREAD)


def test_the_shipped_table_frees_every_drive_and_every_point():
    usual = spread_of("usual")
    assert len(usual.groups["lambda"]) == DRIVES
    assert len(usual.groups["exit"]) == 3 * DRIVES
    assert usual.known["lambda@3"] == usual.drives["lambda"]
    assert usual.known["connector_z@8"] == usual.points["connector"]
    assert {*KNOWN, *INERTIAS} <= usual.known.keys()
    assert len(usual.known) == len(KNOWN) + 3 + 9 * 8 + 48


def test_a_table_of_ones_own(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text("[drives]\nK_t = 0.05\n")
    mine = spread_of(str(path))
    assert mine.groups == {"K_t": tuple(f"K_t@{k}" for k in range(1, 9))}
    assert mine.source == "mine.toml"
