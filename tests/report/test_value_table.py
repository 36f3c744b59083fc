"""The table of fitted values has what was fitted, and no number that only says a kind."""

from types import SimpleNamespace

import numpy as np
from joint_cases import arm

from identification.effects.effect import Candidate, effect_parameters, in_each_record
from identification.effects.inputs import Drive, input_effects
from identification.effects.joint_plant import candidates
from identification.effects.state_effects import joint_elasticity
from identification.model.parameter import Parameter
from identification.report.effect_words import parameter_words, value_words
from identification.report.fitted_values import value_table


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


def test_what_several_joints_have_is_told_with_its_joint():
    def level(joint):
        name = f"coulomb_friction.f_c@{joint}"
        return Parameter(name=name, value=1.0, unit="N m", where="effect", lower=0.0, upper=9.0,
                         symbol="f_c", about="level: of Coulomb friction")  # fmt: skip

    elbow, wrist = level("elbow"), level("wrist")
    assert [*parameter_words([elbow, wrist]).values()] == ["level f_c, elbow", "level f_c, wrist"]
    assert [*parameter_words([elbow]).values()] == ["level f_c"]


def test_the_value_of_a_record_is_said_in_words_with_its_record():
    drives = [Drive("u", 1.0), Drive("w", 1.0)]
    (shift,) = [e for e in input_effects(drives) if e.name == "time_shift"]
    mass = Parameter(name="mass", value=1.0, unit="kg", where="body/arm.mass")
    plant = SimpleNamespace(parameters=[mass, *effect_parameters(shift)], effects=(shift,))
    names = ["mass", "mass [a]", "time_shift.tau@u [a]", "time_shift.tau [b 2]"]
    words = value_words(names, plant)
    assert [words[n] for n in names] == [
        "mass", "mass of record a", "time shift of record a, input u",
        "time shift of record b 2, all inputs",
    ]  # fmt: skip


def test_what_differs_between_records_is_said_without_the_words_of_its_effect():
    effects = {e.name: e for e in candidates(arm(), ())}
    zero = in_each_record(effects["encoder_offset"])
    name = zero.parameter(zero.sizes[0].name, next(iter(zero.places)))
    words = value_words([f"{name} [a]"], SimpleNamespace(parameters=[]), [zero])
    (said,) = [words[n] for n in words if n.endswith(" [a]")]
    assert said.startswith("encoder offset of record a, sensor ")
    assert "by record" not in said
