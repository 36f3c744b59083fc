"""Angles that cannot be those of the drives they are named after are refused in a sentence."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from identification import InputError
from inca_mj.refusals.wiring import refuse_miswired
from inca_mj.robot.inputs import make_input
from inca_mj.twin.logs import JUDGED, read_inca_log, run_to_log
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import build_twin

LOG = Path(__file__).parents[2] / "examples" / "log.csv"  # an effect is missing from its model
pytestmark = pytest.mark.usefixtures("each_run_once")


@pytest.fixture(scope="module")
def plant():
    return build_twin()


def changed(change):
    log = read_inca_log(LOG)
    y = log.outputs.copy()
    change(y)
    return replace(log, outputs=y)


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

    with pytest.raises(InputError, match="turn the sign of angle_1, ") as refused:
        refuse_miswired(changed(reverse), plant)
    assert "current_" not in str(refused.value)
    right = changed(lambda y: None)
    with pytest.raises(InputError, match="turn the sign of current_1, ") as refused:
        refuse_miswired(replace(right, inputs=-right.inputs), plant)
    assert "angle_1 = -1" not in str(refused.value)


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
