"""Angles that cannot be those of the drives they are named after are refused in a sentence."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from identification import InputError, Log
from inca_mj.logs import read_inca_log
from inca_mj.twin import build_twin
from inca_mj.wiring import refuse_miswired

LOG = Path(__file__).parents[2] / "examples" / "log.csv"  # an effect is missing from its model


@pytest.fixture(scope="module")
def plant():
    return build_twin()


def changed(change) -> Log:
    log = read_inca_log(LOG)
    y = log.outputs.copy()
    change(y)
    return replace(log, outputs=y)


def test_a_model_that_lacks_something_is_still_the_robot(plant):
    refuse_miswired(read_inca_log(LOG), plant)


@pytest.mark.parametrize(("i", "j"), [(0, 1), (2, 4), (3, 7), (0, 6), (5, 6)])
def test_swapped_encoders(plant, i, j):
    def swap(y):
        y[:, [i, j]] = y[:, [j, i]]

    with pytest.raises(InputError, match=r"swap the columns|reverse its sign"):
        refuse_miswired(changed(swap), plant)


@pytest.mark.parametrize("drive", range(8))
def test_a_reversed_encoder(plant, drive):
    def reverse(y):
        y[:, drive] *= -1

    with pytest.raises(InputError, match=f"angle_{drive + 1}: moves against the model"):
        refuse_miswired(changed(reverse), plant)


def test_a_dead_encoder(plant):
    def kill(y):
        y[:, 4] = 0.0

    with pytest.raises(InputError, match="angle_5: stands still"):
        refuse_miswired(changed(kill), plant)


@pytest.mark.parametrize("unit", [2 * np.pi, np.pi / 180])
def test_another_unit(plant, unit):
    def convert(y):
        y /= unit

    with pytest.raises(InputError, match="must be in radians"):
        refuse_miswired(changed(convert), plant)
