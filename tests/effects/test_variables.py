"""Which variables of a joint a law depends on is found by trying."""

from math import sqrt

import pytest
from numba import njit

from identification.effects.catalogue import joint_effects
from identification.effects.effect import Effect
from identification.effects.plant.joint_law import _AXES
from identification.effects.sizes import Size
from identification.effects.variables import VARIABLES, variables
from identification.prediction.scoring.forced import ON_JOINTS
from identification.prediction.scoring.screening import at_several

EFFECTS = {e.name: e for e in joint_effects(_AXES)}


@pytest.mark.parametrize(("name", "read"), [
    ("coulomb_friction", {"v"}),  # it is counted against the motion
    ("periodic_friction", {"q", "v"}),
    ("load_dependent_friction", {"f_u", "v"}),
    ("quadratic_friction", {"v"}),
    ("position_dependent_damping", {"q", "v"}),
    ("hardening", {"q"}),
    ("torque_saturation", {"f_u"}),
    ("voltage_limit", {"f_u", "v"}),
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


@njit
def rooted(s, p):
    return p[0] * sqrt(s.v)


def test_a_law_of_a_user_that_has_no_force_somewhere_is_asked_elsewhere():
    size = (Size("c", "N m", 1.0, 0.1, about=""),)
    own = Effect("own", "", size, places={"joint": ""}, hooks={"force": rooted})
    assert variables(own) == {"v"}
