"""A rotor inertia against models whose file says the same, and what no rotor has."""

import mujoco
import numpy as np
import pytest
from joint_cases import ARM, arm, arm_log, run, slider, slider_log, steps

from identification import InputError, Parameter
from identification.effects.plant.joint_plant import joint_plant
from identification.model.plant import ModelPlant

LOG = arm_log(steps(100, 2))


def said(**armatures):
    """Outputs of the arm as a file with armatures says it."""
    spec = mujoco.MjSpec.from_string(ARM)
    for joint, a in armatures.items():
        spec.joint(joint).armature += a
    return run(ModelPlant(spec.compile(), joint_plant(ARM, (), LOG).bare.parameters), LOG)


@pytest.mark.parametrize(("values", "armatures"), [
    ({"rotor_inertia.a@elbow": 0.02}, {"elbow": 0.02}),
    ({"rotor_inertia.a@shoulder": 0.05}, {"shoulder": 0.05}),
    ({"rotor_inertia.a": 0.01, "rotor_inertia.a@elbow": 0.02}, {"shoulder": 0.01, "elbow": 0.03}),
])  # fmt: skip
def test_a_rotor_is_what_a_file_says(values, armatures):
    expected = said(**armatures)
    np.testing.assert_allclose(run(arm(), LOG, **values), expected, rtol=0, atol=1e-10)
    assert np.abs(expected - run(arm(), LOG)).max() > 1e-3


def test_a_body_before_its_joint_does_not_feel_a_rotor():
    """Inertia of the lower link, which turns with the upper one, moves the arm otherwise."""
    rotor = run(arm(), LOG, **{"rotor_inertia.a@elbow": 0.005})
    link = run(arm(), LOG, **{"inertia_mismatch.delta@lower": 0.5})
    assert np.abs(rotor - link).max() > 1e-3


def test_it_adds_to_an_armature_that_is_a_parameter_itself():
    own = Parameter(name="J", value=0.01, unit="kg m^2", where="joint/elbow.armature")
    plant = joint_plant(ARM, (own,), LOG)
    found = run(plant, LOG, **{"J": 0.03, "rotor_inertia.a@elbow": 0.02})
    np.testing.assert_allclose(found, said(elbow=0.05), rtol=0, atol=1e-10)


def test_a_slide_has_a_mass_and_no_rotor_is_negative():
    log = slider_log(steps(60))
    (size,) = next(e for e in slider().effects if e.name == "rotor_inertia").sizes
    assert size.unit == "kg"
    with pytest.raises(InputError, match="would have a rotor inertia of -0\\.1"):
        run(slider(), log, **{"rotor_inertia.a@slide": -0.1})
