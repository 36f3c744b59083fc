"""Which variables of a joint a law depends on is found by trying."""

import pytest

from identification.effects.catalogue import joint_effects
from identification.effects.joint_law import _AXES
from identification.effects.variables import VARIABLES, variables
from identification.prediction.screening import at_several
from identification.prediction.yardstick import ON_JOINTS

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
    effect = EFFECTS[name]
    assert variables(effect) == read
    both = [where for where, suffix in effect.places.items() if suffix][:2]
    assert variables(at_several(effect, both)) == read


@pytest.mark.parametrize("effect", EFFECTS.values(), ids=EFFECTS)
def test_a_law_of_every_kind_can_be_asked(effect):
    assert variables(effect) <= {*VARIABLES}
    assert variables(effect) or effect.name == "offset" or not {*effect.hooks} & ON_JOINTS
