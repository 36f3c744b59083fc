"""Mistakes of several currents, and of angle and current of a drive together, are named and mended.

Each is made in a right log and refused. What the message tells to write makes the log a right one.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from advice import advised

from identification import InputError, write_log
from inca_mj.robot.inputs import make_input
from inca_mj.twin.followed_log import follow, places_of
from inca_mj.twin.logs import read_inca_log, run_to_log
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import build_twin
from inca_mj.twin.wiring import refuse_miswired

LOG = read_inca_log(Path(__file__).parents[2] / "examples" / "log.csv").between(0.0, 4.0)
RIGHT, NONE = (0, 1, 2, 3, 4, 5, 6, 7), ()


@pytest.fixture(scope="module")
def plant():
    return build_twin()


def places(at, back):
    """A signed permutation: column k is that of drive at[k], with the other sign if k is back."""
    return np.eye(8)[:, list(at)] * np.where(np.isin(np.arange(8), list(back)), -1, 1)


@pytest.mark.parametrize(
    ("angles", "currents", "unit", "told"),
    [
        ((RIGHT, (3,)), (RIGHT, (3,)), 1.0, "turn the sign of angle_4, current_4: write"),
        (
            ((0, 1, 2, 6, 4, 5, 3, 7), NONE),
            ((0, 1, 2, 6, 4, 5, 3, 7), NONE),
            1.0,
            "exchange angle_4 and angle_7, and current_4 and current_7 under",
        ),
        ((RIGHT, NONE), (RIGHT, (1, 6)), 1.0, "turn the sign of current_2, current_7: write"),
        (
            (RIGHT, NONE),
            ((1, 0, 3, 2, 4, 5, 6, 7), NONE),
            1.0,
            "exchange current_1 and current_2, and current_3 and current_4 under",
        ),
        ((RIGHT, NONE), ((2, 1, 0, 3, 4, 5, 6, 7), (2, 5)), 1.0, "turn the sign of the new"),
        (
            (RIGHT, NONE),
            ((0, 2, 3, 1, 4, 5, 6, 7), NONE),
            np.pi / 180,
            'so read, .*write angle = "deg"',
        ),
    ],
)
def test_what_is_told_of_several_columns_mends_the_log(
    plant, tmp_path, angles, currents, unit, told
):
    y, u = LOG.outputs @ places(*angles) / unit, LOG.inputs @ places(*currents)
    wrong = replace(LOG, outputs=y, inputs=u, units={})
    with pytest.raises(InputError, match=told) as refused:
        refuse_miswired(wrong, plant)
    path = tmp_path / "log.csv"
    write_log(wrong, path)
    path.with_suffix(".toml").write_text(advised(str(refused.value)))
    mended = read_inca_log(path)
    np.testing.assert_allclose(mended.outputs, LOG.outputs, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(mended.inputs, LOG.inputs, rtol=1e-9, atol=1e-12)
    refuse_miswired(mended, plant)


@pytest.mark.parametrize("drive", [3, 6])
def test_a_current_that_was_not_logged(plant, drive):
    u = LOG.inputs.copy()
    u[:, drive] = 0.0
    wrong = replace(LOG, inputs=u)
    with pytest.raises(InputError, match=f"current_{drive + 1} stands still at 0 A") as refused:
        refuse_miswired(wrong, plant)
    assert "write --trust sensors" in str(refused.value)


@pytest.mark.parametrize("level", [0.0, 0.75])
def test_a_current_that_was_kept_constant_is_right(plant, level):
    u = make_input("prbs", 3.0, seed=1)
    u[:, 2] = level
    heavier = plant.with_values({"m": 0.25, "b_c": 0.008})
    refuse_miswired(run_to_log(simulate(heavier, u)), plant)


def test_a_unit_is_not_blamed_where_the_motion_has_another_shape(plant):
    rng = np.random.default_rng(3)
    walk = np.cumsum(rng.standard_normal(LOG.outputs.shape), axis=0)
    wrong = replace(LOG, outputs=20 * (walk - walk[0]))
    with pytest.raises(InputError, match="it is not clear what is wrong: check") as refused:
        refuse_miswired(wrong, plant)
    assert "write --trust wiring units" in str(refused.value)
    refuse_miswired(wrong, plant, ["wiring", "units"])


@pytest.mark.parametrize("seed", range(4))
def test_currents_that_make_the_twin_follow_tell_every_place_and_sign(plant, seed):
    rng = np.random.default_rng(seed)
    wrong = places(rng.permutation(8), np.flatnonzero(rng.integers(0, 2, 8)))
    followed = follow(plant, LOG)
    assert followed is not None
    mixed = replace(LOG, inputs=LOG.inputs @ wrong)
    np.testing.assert_array_equal(places_of(mixed, followed[0]), wrong)
    assert np.abs(followed[1] - LOG.outputs).max() < 0.2 * np.ptp(LOG.outputs)
