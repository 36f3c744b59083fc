"""Which variables of a joint a law depends on is found by trying."""

import pytest

from identification.effects.catalogue import joint_effects
from identification.effects.joint_law import _AXES
from identification.effects.variables import variables

EFFECTS = {e.name: e for e in joint_effects(_AXES)}


@pytest.mark.parametrize(("name", "read"), [
    ("coulomb_friction", {"v"}),  # it is counted against the motion
    ("periodic_friction", {"q", "v"}),
    ("load_dependent_friction", {"f_u", "v"}),
    ("quadratic_friction", {"v"}),
    ("position_dependent_damping", {"q", "v"}),
    ("hardening", {"q"}),
    ("torque_saturation", {"f_u"}),
    ("force_drift", {"time"}),
    ("offset", set()),
    ("gravity_force", {"f_g", "q", "x_before", "x_behind"}),
    ("curve_position", {"q"}),
    ("curve_speed", {"v"}),
    ("curve_load", {"f_u"}),
    ("curve_time", {"time"}),
    ("curve_speed_behind", {"v_behind"}),
])  # fmt: skip
def test_a_law_depends_on_what_changes_its_force(name, read):
    assert variables(EFFECTS[name]) == read
