"""Where a robot with effects starts: as the nominal one, or settled with them."""

import numpy as np
import pytest
from effect_cases import bare, forward, full

PRESENT = {
    "pulley_radius": {"pulley_radius.r_p": 0.02},
    "anchor_offset": {"anchor_offset.x@3": 0.01, "anchor_offset.z@3": -0.01},
    "com_offset": {"com_offset.x": 3e-3, "com_offset.y": -1e-3, "com_offset.z": 4e-3},
    "cable_weight": {"cable_weight.rho": 2e-3},
    "external_force": {"external_force.x": 0.05, "external_force.z": -0.1},
    "cable_hardening": {"cable_hardening.kappa": 2000.0},
    "cable_creep": {"cable_creep.c": 0.3},
    "backlash": {"backlash.h": 0.02},
    "drum_radius_mismatch": {"drum_radius_mismatch.delta@2": 0.02},
    "drum_eccentricity": {"drum_eccentricity.a": 0.01, "drum_eccentricity.b": 0.01},
    "air_drag": {"air_drag.c": 0.1},
}
TURNED = {"x": 0.05, "y": -0.03, "z": 1.4, "roll": 0.05, "pitch": -0.08, "yaw": 0.1}


@pytest.mark.parametrize("name", PRESENT)
def test_a_settled_robot_rests(name):
    twin = full(settled=True).with_values({**TURNED, **PRESENT[name]})
    data = forward(twin, twin.state())
    scale = np.abs(forward(bare(), bare().state(), 1.0).qacc).max()
    assert np.abs(data.qacc).max() < 1e-8 * scale
    creep = data.act_dot.reshape(8, -1)
    assert np.abs(creep).max() < 1e-9


def test_a_settled_robot_with_all_of_them_rests():
    present = {k: v / 3 for values in PRESENT.values() for k, v in values.items()}
    twin = full(settled=True).with_values({**TURNED, **present})
    assert np.abs(forward(twin, twin.state()).qacc).max() < 1e-5


@pytest.mark.parametrize("name", PRESENT)
def test_else_it_starts_with_the_nominal_tension(name):
    twin, nominal = full().with_values({**TURNED, **PRESENT[name]}), bare().with_values(TURNED)
    begin = twin.start
    assert begin.tension == pytest.approx(nominal.start.tension, abs=1e-12)
    lambda_ = twin.parameters["lambda"].value
    data = forward(twin, twin.state())
    if name not in ("pulley_radius", "anchor_offset"):  # MuJoCo's own length is then the path
        d_0 = lambda_ * data.ten_length / (lambda_ + begin.tension)
        assert begin.no_load_length == pytest.approx(d_0, rel=1e-12)


def test_one_call_with_many_starts_is_many_calls():
    twin = full()
    names = [k for values in PRESENT.values() for k in values]
    row = [v / 3 for values in PRESENT.values() for v in values.values()]
    state, numbers = twin.settings(names, np.array([row, np.zeros(len(row))]))
    with_it = twin.with_values(dict(zip(names, row, strict=True)))
    assert np.array_equal(state.act[0], with_it.state().act)
    for slot, column in numbers:
        written = getattr(with_it.model, slot.field)[slot.index()]
        assert np.array_equal(written, np.full_like(written, column[0])), slot
