"""A current that was not logged beside an angle that is turned or of another scale: both are told.

Each alone was told before, and together they hid each other.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from advice import advised

from identification import InputError, write_log
from inca_mj.refusals.agreement import some
from inca_mj.refusals.scales import odd_angle
from inca_mj.refusals.wiring import refuse_miswired
from inca_mj.twin.logs import read_inca_log
from inca_mj.twin.twin import build_twin

LOG = read_inca_log(Path(__file__).parents[2] / "examples" / "log.csv").between(0.0, 4.0)


@pytest.fixture(scope="module")
def plant():
    return build_twin()


def wrong(dead, angle, factor):
    """The log with a current of zero and an angle multiplied, by the number of their drive."""
    every = np.arange(1, 9)
    return replace(
        LOG,
        inputs=LOG.inputs * (every != dead),
        outputs=LOG.outputs * np.where(every == angle, factor, 1.0),
        units={},
    )


def test_what_is_told_of_the_angle_mends_it(plant, tmp_path):
    with pytest.raises(InputError) as refused:
        refuse_miswired(wrong(7, 3, -1.0), plant)
    path = tmp_path / "log.csv"
    write_log(wrong(7, 3, -1.0), path)
    path.with_suffix(".toml").write_text(advised(str(refused.value)))
    mended = read_inca_log(path)
    np.testing.assert_allclose(mended.outputs, LOG.outputs, rtol=1e-9, atol=1e-12)
    refuse_miswired(replace(mended, inputs=LOG.inputs), plant)


@pytest.mark.parametrize("factor", [-1.0, 180 / np.pi])
def test_the_cables_tell_an_odd_angle_without_a_current(plant, factor):
    y = some(LOG.outputs)
    assert odd_angle(plant, y) is None
    found = odd_angle(plant, y * np.where(np.arange(8) == 7, factor, 1.0))
    assert found is not None
    assert found[0] == 7
    assert found[1] * factor == pytest.approx(1.0, rel=0.1)
