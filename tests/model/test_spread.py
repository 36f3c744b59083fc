"""Spreads of a body's mass are positive exactly where its inertia is that of some mass."""

import mujoco
import numpy as np
from estimation_plants import PENDULUM, positive
from hypothesis import given
from hypothesis import strategies as st

from identification import ParameterSet
from identification.model.plant import ModelPlant
from identification.model.tied import spreads

BODY = mujoco.MjModel.from_xml_string(PENDULUM).body(1).name
PATHS = [f"body/{BODY}.spread[{k}]" for k in range(3)]


def plant(*records):
    return ModelPlant(mujoco.MjModel.from_xml_string(PENDULUM), ParameterSet("spread", records))


@given(st.lists(st.floats(1e-6, 1e3), min_size=3, max_size=3))
def test_any_positive_spreads_are_a_body_and_are_read_back(sigma):
    records = [positive(f"s{k}", s, "", PATHS[k]) for k, s in enumerate(sigma)]
    model = plant(*records).model
    a, b, c = model.body_inertia[1]
    assert a + b >= c * (1 - 1e-12)
    assert b + c >= a * (1 - 1e-12)
    assert c + a >= b * (1 - 1e-12)
    np.testing.assert_allclose(spreads(model, 1), sigma, atol=1e-12 * max(sigma))


def test_settings_write_what_a_new_plant_has():
    own = plant(*(positive(f"s{k}", 0.01 * (k + 1), "", PATHS[k]) for k in range(3)))
    _, numbers = own.settings(("s0", "s2"), np.array([[0.05, 0.07], [0.2, 0.3]]))
    written = {slot.column: values for slot, values in numbers}
    np.testing.assert_allclose(written[0], [0.02 + 0.07, 0.02 + 0.3])
    np.testing.assert_allclose(written[1], [0.05 + 0.07, 0.2 + 0.3])
    np.testing.assert_allclose(written[2], [0.05 + 0.02, 0.2 + 0.02])
