"""Angles and currents that cannot be those of their drives are refused in a sentence with a cure.

What the messages of a log's checks tell to write makes the log a right one.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from advice import advised

from identification import InputError, write_log
from inca_mj.refusals.agreement import follow, places_of, some, unreached_share
from inca_mj.refusals.scales import odd_angle
from inca_mj.refusals.wiring import refuse_miswired
from inca_mj.robot.inputs import make_input
from inca_mj.twin.logs import JUDGED, read_inca_log, run_to_log
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import build_twin

# An effect is missing from its model.
WHOLE = read_inca_log(Path(__file__).parents[2] / "examples" / "log.csv")
LOG, LONGER = WHOLE.between(0.0, 3.0), WHOLE.between(0.0, 4.0)
UNIT = {"deg": np.pi / 180, "mrad": 1e-3, "rev": 2 * np.pi, "rad": 1.0}
pytestmark = pytest.mark.usefixtures("each_run_once")


@pytest.fixture(scope="module")
def plant():
    return build_twin()


def changed(change):
    y = WHOLE.outputs.copy()
    change(y)
    return replace(WHOLE, outputs=y)


def test_an_encoder_that_freezes(plant):
    def freeze(y):
        y[700:, 3] = y[700, 3]

    with pytest.raises(InputError, match=r"angle_4 of log 'log' repeats .* a frozen sensor"):
        refuse_miswired(changed(freeze), plant)


def test_an_encoder_that_another_sign_hardly_mends_is_not_refused(plant):
    """Of a log whose anchor was 0.1 m off, one angle had a correlation of -0.5 with the model's."""
    n, rng = 200, np.random.default_rng(0)

    def astray(y):
        own = y[:n, 0] - y[0, 0]
        other = np.cumsum(np.cumsum(rng.standard_normal(n)))
        other -= own * (own @ other) / (own @ own)
        other *= np.linalg.norm(own) / np.linalg.norm(other)
        y[:n, 0] = y[0, 0] - 0.5 * own + 0.75**0.5 * (other - other[0])

    refuse_miswired(changed(astray), plant)


def test_a_log_that_rests_first_is_not_judged_by_its_noise(plant):
    still = np.repeat(make_input("prbs", 0.1)[:1] * 0, round(2.0 / 0.01), axis=0)
    log = run_to_log(simulate(plant, np.vstack([still, make_input("prbs", 3.0)])))
    noise = 5e-4 * np.random.default_rng(1).standard_normal(log.outputs.shape)
    step = 2 * np.pi / 4000
    refuse_miswired(replace(log, outputs=log.outputs + noise), plant)
    refuse_miswired(replace(log, outputs=step * np.round(log.outputs / step)), plant)


def test_all_signs_turned_are_those_of_angles_or_of_currents(plant):
    """A cable pulls only, so that the two are no mirror images: each has its own cure."""

    def reverse(y):
        y *= -1

    assert "current_" not in said_of(changed(reverse), plant, "turn the sign of angle_1, ")
    wrong = replace(WHOLE, inputs=-WHOLE.inputs)
    assert "angle_1 = -1" not in said_of(wrong, plant, "turn the sign of current_1, ")


def beside(plant, change):
    """The twin's own log of 3 s, changed, with the noise of its encoders."""
    log = run_to_log(simulate(plant, make_input("prbs", 3.0)))
    y = log.outputs + 5e-4 * np.random.default_rng(2).standard_normal(log.outputs.shape)
    change(y)
    return replace(log, outputs=y)


def test_an_exchange_that_leaves_other_angles_astray_is_no_wiring(plant):
    """A load friction and a clipped current once looked like an exchange of two of four angles that
    were off: after it, the others were as far from the twin as before."""

    def exchange(y):
        y[:, [3, 5]] = y[:, [5, 3]]

    def astray(y):
        exchange(y)
        y[:, 4] = y[0, 4] + np.linalg.norm(y[:, 4]) * np.sin(np.arange(len(y)) / 30)

    with pytest.raises(InputError, match="exchange angle_4 and angle_6"):
        refuse_miswired(beside(plant, exchange), plant)
    refuse_miswired(beside(plant, astray), plant)


@pytest.mark.parametrize(
    ("word", "change"),
    [
        ("wiring", lambda y: np.negative(y, out=y)),
        ("units", lambda y: np.multiply(y, 57.3, out=y)),
        ("sensors", lambda y: y[:, 4].fill(0.0)),
    ],
)
def test_who_knows_better_overrules_a_check_and_only_this_check(plant, word, change):
    log = beside(plant, change)
    with pytest.raises(InputError, match=f"write --trust {word}"):
        refuse_miswired(log, plant, [other for other in JUDGED if other != word])
    refuse_miswired(log, plant, [word])


def test_beside_an_angle_that_stands_still_the_others_are_judged(plant):
    def reverse(y):
        y[:, 4].fill(0.0)
        y[:, [0, 1, 2, 3, 5, 6, 7]] *= -1

    def convert(y):
        y[:, 4].fill(0.0)
        y *= 57.3

    with pytest.raises(InputError, match=r"turn the sign of angle_1, .*angle_8"):
        refuse_miswired(beside(plant, reverse), plant, ["sensors"])
    with pytest.raises(InputError, match="must be in radians"):
        refuse_miswired(beside(plant, convert), plant, ["sensors"])


def mistaken(at=range(8), back=(), word="rad"):
    """A log whose column k is angle at[k], with signs turned, in another unit."""
    y = LOG.outputs[:, list(at)] * np.where(np.isin(np.arange(8), back), -1, 1) / UNIT[word]
    return replace(LOG, outputs=y)


def said_of(log, plant, told=None):
    with pytest.raises(InputError, match=told) as refused:
        refuse_miswired(log, plant)
    return str(refused.value)


def mended(log, said, folder):
    """The log, read with what the message told to write into its TOML."""
    path = folder / "log.csv"
    write_log(log, path)
    path.with_suffix(".toml").write_text(advised(said))
    return read_inca_log(path)


def same(log, right, *parts):
    for part in parts:
        np.testing.assert_allclose(getattr(log, part), getattr(right, part), rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize(
    ("at", "back", "word"),
    [
        (range(8), (2,), "rad"),
        ((1, 2, 0, 3, 4, 5, 6, 7), (1, 6), "rad"),
        (range(8), (1, 4, 6), "deg"),
    ],
)
def test_what_is_told_mends_the_log(plant, tmp_path, at, back, word):
    wrong = mistaken(at, back, word)
    again = mended(replace(wrong, units={}), said_of(wrong, plant), tmp_path)
    same(again, LOG, "outputs")
    refuse_miswired(again, plant)


RIGHT, NONE = (0, 1, 2, 3, 4, 5, 6, 7), ()
CYCLED = (0, 4, 2, 3, 6, 5, 1, 7)


def places(at, back):
    """A signed permutation: column k is that of drive at[k], with the other sign if k is back."""
    return np.eye(8)[:, list(at)] * np.where(np.isin(np.arange(8), list(back)), -1, 1)


@pytest.mark.parametrize(
    ("angles", "currents", "unit", "told"),
    [
        ((RIGHT, (3,)), (RIGHT, (3,)), 1.0, "turn the sign of angle_4, current_4: write"),
        ((CYCLED, NONE), (CYCLED, NONE), 1.0, "drives 2, 5, 7 numbered in another order"),
    ],
)
def test_what_is_told_of_several_columns_mends_the_log(
    plant, tmp_path, angles, currents, unit, told
):
    y, u = LOG.outputs @ places(*angles) / unit, LOG.inputs @ places(*currents)
    wrong = replace(LOG, outputs=y, inputs=u, units={})
    again = mended(wrong, said_of(wrong, plant, told), tmp_path)
    same(again, LOG, "outputs", "inputs")
    refuse_miswired(again, plant)


def test_drives_in_reverse_order_are_told_up_to_the_symmetry_of_the_robot(plant, tmp_path):
    wrong = replace(LOG, outputs=LOG.outputs[:, ::-1], inputs=LOG.inputs[:, ::-1])
    said = said_of(wrong, plant, r"numbered in another order.*robot is symm")
    again = mended(wrong, said, tmp_path)
    shares = unreached_share(plant, np.stack([some(log.outputs) for log in (again, LOG)]))
    assert shares[0] < 3 * shares[1]
    refuse_miswired(again, plant)


@pytest.mark.parametrize(
    ("of", "drive", "factor", "told"),
    [
        ("outputs", 3, 1 / (2 * np.pi), r'write angle_4 = "rev" under \[units\]'),
        *(
            pytest.param(*case, marks=pytest.mark.long)
            for case in (
                ("inputs", 4, 2.0, r"write current_5 = 0.(4\d|5\d?) under \[factors\]"),
                ("outputs", 6, 0.5, r"write angle_7 = (1.9|2|2.1) under \[factors\]"),
                ("outputs", 1, 2.0, r"write angle_2 = 0.(4[5-9]|5\d?) under \[factors\]"),
                ("inputs", 4, 0.5, r"write current_5 = (1.[89]|2|2.[12]) under \[factors\]"),
            )
        ),
    ],
)
def test_one_column_of_another_scale_is_told(plant, of, drive, factor, told):
    scale = np.where(np.arange(8) == drive, factor, 1.0)
    wrong = replace(LOG, **{of: getattr(LOG, of) * scale})
    assert "write --trust units" in said_of(wrong, plant, told)
    refuse_miswired(wrong, plant, ["units"])


def test_angles_belong_to_poses_of_one_platform_in_the_right_order_only(plant):
    y = some(LOG.outputs)
    right, backward = unreached_share(plant, np.stack([y, y[:, ::-1]]))
    assert right < 1e-3
    assert backward > 10 * right
    still = unreached_share(plant, np.zeros((1, 3, 8)))
    assert np.isinf(still).all()


def test_a_current_that_was_kept_constant_is_right(plant):
    u = make_input("prbs", 3.0, seed=1)
    u[:, 2] = 0.75
    heavier = plant.with_values({"m": 0.25, "b_c": 0.008})
    refuse_miswired(run_to_log(simulate(heavier, u)), plant)


def test_a_unit_is_not_blamed_where_the_motion_has_another_shape(plant):
    rng = np.random.default_rng(3)
    walk = np.cumsum(rng.standard_normal(LOG.outputs.shape), axis=0)
    wrong = replace(LOG, outputs=20 * (walk - walk[0]))
    said = said_of(wrong, plant, "it is not clear what is wrong: check")
    assert "write --trust wiring units" in said
    refuse_miswired(wrong, plant, ["wiring", "units"])


@pytest.mark.parametrize("seed", range(2))
def test_currents_that_make_the_twin_follow_tell_every_place_and_sign(plant, seed):
    rng = np.random.default_rng(seed)
    wrong = places(rng.permutation(8), np.flatnonzero(rng.integers(0, 2, 8)))
    followed = follow(plant, LOG)
    assert followed is not None
    mixed = replace(LOG, inputs=LOG.inputs @ wrong)
    np.testing.assert_array_equal(places_of(mixed, followed[0]), wrong)
    assert np.abs(followed[1] - LOG.outputs).max() < 0.2 * np.ptp(LOG.outputs)


def test_beside_a_current_that_was_not_logged_what_is_told_of_an_angle_mends_it(plant, tmp_path):
    """Together the two hid each other."""
    every = np.arange(1, 9)
    inputs = LONGER.inputs * (every != 7)
    outputs = LONGER.outputs * np.where(every == 3, -1.0, 1.0)
    wrong = replace(LONGER, inputs=inputs, outputs=outputs, units={})
    said = said_of(wrong, plant, "current_7 stands still at 0 A")
    assert "; beside it, angle_" in said
    again = mended(wrong, said, tmp_path)
    same(again, LONGER, "outputs")
    refuse_miswired(replace(again, inputs=LONGER.inputs), plant)


@pytest.mark.parametrize("factor", [-1.0, 180 / np.pi])
def test_the_cables_tell_an_odd_angle_without_a_current(plant, factor):
    y = some(LONGER.outputs)
    assert odd_angle(plant, y) is None
    at, by = odd_angle(plant, y * np.where(np.arange(8) == 7, factor, 1.0))
    assert at == 7
    assert by * factor == pytest.approx(1.0, rel=0.1)
