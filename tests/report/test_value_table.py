"""The table of fitted values has what was fitted, and no number that only says a kind."""

from types import SimpleNamespace

import numpy as np
from joint_cases import arm

from identification.effects.effect import Candidate, effect_parameters
from identification.effects.laws.state_effects import joint_elasticity
from identification.report.fit.fitted_values import matters, value_table


def test_where_an_encoder_sits_is_no_fitted_value():
    """It is said with the effect: 0, the motor's side, would read like a share of nothing."""
    (gear,) = [e for e in arm().effects if joint_elasticity in e.hooks.values()]
    values = {"joint_elasticity.c@elbow": 0.03, "joint_elasticity.rho": 0.2,
              "joint_elasticity.zeta": 0.04, "joint_elasticity.link": 0.0}  # fmt: skip
    std = {name: 1e-3 for name in values if not name.endswith("link")}
    model = SimpleNamespace(
        told_values=values, told_std=std, at_bound=(), plant=SimpleNamespace(
            parameters=effect_parameters(gear)
        ),
    )  # fmt: skip
    candidate = Candidate(gear, "joint elbow", {})
    named = SimpleNamespace(candidate=candidate, name=gear.name, where="joint elbow")
    found = SimpleNamespace(
        nominal=model, final=model, named=(named,), differences=(), is_begun=False
    )
    first = [str(row[0]) for row in value_table(found).rows]
    assert len(first) == 3
    assert not [name for name in first if name.startswith("link")]
    assert np.all([str(row[-1]) != "0 %" for row in value_table(found).rows])


def test_a_finer_step_is_advised_only_where_somebody_would_see_what_it_moves():
    assert matters(0.02, 1.0, "kg", 0.005)
    assert not matters(0.002, 1.0, "kg", 0.005)
    assert not matters(8e-5, 1e-4, "s", 0.005)  # a delay, by a sixtieth of the model's step
    assert matters(8e-4, 1e-4, "s", 0.005)
