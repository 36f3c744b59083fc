"""One parameter for two numbers of a model in a fixed ratio, and spreads that make an inertia."""

import mujoco
import numpy as np
import pytest
from estimation_plants import PENDULUM, positive, record
from hypothesis import given
from hypothesis import strategies as st

from identification import InputError, Parameter, ParameterSet
from identification.estimation.estimation import estimate
from identification.model.plant import ModelPlant
from identification.model.tied import spreads

DAMPING = Parameter(
    name="damping", value=0.1, unit="N m s/rad", where="joint/shoulder.damping", lower=0.0,
    ties=(("joint/elbow.damping", 2.0),),
)  # fmt: skip


def plant(*records):
    return ModelPlant(mujoco.MjModel.from_xml_string(PENDULUM), ParameterSet("tied", records))


def test_a_tie_is_the_model_whose_two_numbers_are_written_one_by_one():
    tied = plant(DAMPING)
    apart = plant(
        positive("a", 0.1, "", "joint/shoulder.damping"),
        positive("b", 0.2, "", "joint/elbow.damping"),
    )
    np.testing.assert_array_equal(tied.model.dof_damping, apart.model.dof_damping)
    _, numbers = tied.settings(("damping",), np.array([[0.3], [0.4]]))
    written = {slot.rows: values.tolist() for slot, values in numbers}
    assert written == {(0,): [0.3, 0.4], (1,): [0.6, 0.8]}


def test_a_tied_parameter_is_recovered_and_both_joints_follow():
    log = record(plant(DAMPING), ("q1", "q2"))
    found = estimate(plant(DAMPING), log, ("damping",), {"damping": 0.14})
    assert found.values["damping"] == pytest.approx(0.1, rel=1e-6)


def test_the_start_can_be_tied_too():
    angle = Parameter(
        name="angle", value=0.2, unit="rad", where="qpos[0]", ties=(("qpos[1]", -1.0),)
    )
    state, _ = plant(angle).settings(("angle",), np.array([[0.5]]))
    np.testing.assert_array_equal(state.qpos, [[0.5, -0.5]])


def test_two_parameters_may_not_write_one_place():
    other = positive("other", 0.3, "", "joint/elbow.damping")
    with pytest.raises(InputError, match="damping and other all go to"):
        plant(DAMPING, other)
    with pytest.raises(InputError, match="factor 0"):
        Parameter(name="p", value=1.0, unit="", where="qpos[0]", ties=(("qpos[1]", 0.0),))


BODY = mujoco.MjModel.from_xml_string(PENDULUM).body(1).name
PATHS = [f"body/{BODY}.spread[{k}]" for k in range(3)]


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
