"""Effects of bodies against models whose file says the same, and what no body can be."""

import mujoco
import numpy as np
import pytest
from joint_cases import ARM, SLIDER, arm, arm_log, run, slider, slider_log, steps

from identification.effects.laws.bodies import body_effects
from identification.effects.moving_bodies import moving_bodies
from identification.effects.plant.body_numbers import frame_inertia, principal
from identification.effects.plant.joint_plant import joint_plant
from identification.model.plant import ModelPlant

LOWER = '<inertial pos="0 0 -0.1" mass="0.5" diaginertia="0.01 0.01 0.005"/>'
LOG = arm_log(steps(100, 2))
TIP = '<site name="tip" pos="0.05 0 -0.3"/>'


def said(text, log=LOG):
    """Outputs of a model as its file says it."""
    empty = joint_plant(ARM, (), log).bare.parameters
    return run(ModelPlant(mujoco.MjModel.from_xml_string(text), empty), log)


@pytest.mark.parametrize(("values", "inertial"), [
    ({"mass_mismatch.dm@lower": 0.1},
     '<inertial pos="0 0 -0.1" mass="0.6" diaginertia="0.012 0.012 0.006"/>'),
    ({"com_offset.x@lower": 0.03, "com_offset.z@lower": -0.02},
     '<inertial pos="0.03 0 -0.12" mass="0.5" diaginertia="0.01 0.01 0.005"/>'),
    ({"inertia_mismatch.delta@lower": -0.3},
     '<inertial pos="0 0 -0.1" mass="0.5" diaginertia="0.007 0.007 0.0035"/>'),
    ({"mass_mismatch.dm@lower": 0.1, "inertia_mismatch.delta@lower": 0.5},
     '<inertial pos="0 0 -0.1" mass="0.6" diaginertia="0.017 0.017 0.0085"/>'),
])  # fmt: skip
def test_an_effect_of_a_body_is_what_a_file_says(values, inertial):
    expected = said(ARM.replace(LOWER, inertial))
    np.testing.assert_allclose(run(arm(), LOG, **values), expected, rtol=0, atol=1e-10)
    assert np.abs(expected - run(arm(), LOG)).max() > 1e-3


def test_a_payload_is_a_small_heavy_body_at_the_farthest_site():
    text = ARM.replace(LOWER, LOWER + TIP + '<site name="near" pos="0 0 -0.01"/>')
    plant = joint_plant(text, (), LOG)
    small = (
        '<body pos="0.05 0 -0.3"><inertial pos="0 0 0" mass="0.4" diaginertia="1e-9 1e-9 1e-9"/>'
    )
    expected = said(ARM.replace(LOWER, LOWER + small + "</body>"))
    found = run(plant, LOG, **{"payload.M@lower": 0.4})
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-7)
    assert np.abs(expected - said(ARM)).max() > 0.01


def test_a_load_is_a_small_heavy_body_at_any_place():
    text = ARM.replace(LOWER, LOWER + TIP)
    small = (
        '<body pos="-0.05 0 -0.1"><inertial pos="0 0 0" mass="0.4" diaginertia="1e-9 1e-9 1e-9"/>'
    )
    expected = said(ARM.replace(LOWER, LOWER + small + "</body>"))
    place = {"load.x": -0.1, "load.z": 0.2}  # from the tip
    found = run(joint_plant(text, (), LOG), LOG, **{"load.M@lower": 0.4, **place})
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-7)
    assert np.abs(expected - said(ARM)).max() > 0.01
    at_the_tip = run(joint_plant(text, (), LOG), LOG, **{"load.M@lower": 0.4})
    payload = run(joint_plant(text, (), LOG), LOG, **{"payload.M@lower": 0.4})
    np.testing.assert_allclose(at_the_tip, payload, rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("geom", "end"),
    [
        ('type="capsule" fromto="0 0 0 0 0 -0.4" size="0.03"', (0, 0, -0.4)),
        ('type="cylinder" fromto="0.1 0 0 0.1 0.3 0" size="0.03"', (0.1, 0.3, 0)),
        ('type="box" pos="0 0 -0.2" size="0.02 0.03 0.25"', (0, 0, -0.45)),
        ('type="sphere" pos="0 0 -0.3" size="0.1"', (0, 0, -0.3)),
    ],
)
def test_without_sites_a_payload_hangs_at_the_end_of_the_farthest_geom(geom, end):
    body = LOWER + f'<geom {geom} mass="0"/>'
    model = mujoco.MjModel.from_xml_string(ARM.replace(LOWER, body))
    (lower,) = (b for b in moving_bodies(model) if b.is_last)
    assert lower.point == pytest.approx(end)
    tip = '<site pos="0 0 -0.05"/>'
    model = mujoco.MjModel.from_xml_string(ARM.replace(LOWER, body + tip))
    (lower,) = (b for b in moving_bodies(model) if b.is_last)
    assert lower.point == pytest.approx((0, 0, -0.05))


def test_an_inertia_in_axes_of_its_own_is_kept():
    tilted = LOWER.replace("/>", ' quat="0.9 0.1 0.3 -0.2"/>')
    heavy = tilted.replace('mass="0.5" diaginertia="0.01 0.01 0.005"',
                           'mass="0.6" diaginertia="0.012 0.012 0.006"')  # fmt: skip
    plant = joint_plant(ARM.replace(LOWER, tilted), (), LOG)
    found = run(plant, LOG, **{"mass_mismatch.dm@lower": 0.1})
    np.testing.assert_allclose(found, said(ARM.replace(LOWER, heavy)), rtol=0, atol=1e-10)
    I_c = frame_inertia(np.array([1.0, 2.0, 2.5]), np.array([0.5, 0.5, -0.5, 0.5]))
    np.testing.assert_allclose(frame_inertia(*principal(I_c)), I_c, atol=1e-12)


def test_a_mass_may_be_free_and_wrong_at_once():
    log = slider_log(steps(100))
    one = run(slider(), log, mass=2.5, **{"mass_mismatch.dm@cart": 0.5})
    np.testing.assert_allclose(one, run(slider(), log, mass=3.0), rtol=0, atol=1e-12)
    known = slider().with_values({"mass_mismatch.dm@cart": 0.5})
    assert known.model.body("cart").mass == 2.5
    again = known.with_values({"mass": 2.5})
    assert again.model.body("cart").mass == 3.0
    np.testing.assert_array_equal(run(again, log), one)
    np.testing.assert_array_equal(run(known, log, mass=2.5), one)
    np.testing.assert_array_equal(
        run(known, log, **{"mass_mismatch.dm@cart": 0.0}), run(slider(), log)
    )


def test_each_simulation_of_a_batch_has_a_body_of_its_own():
    from identification.model.predictor import Predictor

    names = ("mass_mismatch.dm@lower", "com_offset.x@upper")
    sets = np.array([[0.0, 0.0], [0.1, 0.0], [0.1, 0.02]])
    many = Predictor(arm(), LOG, names).predict(sets)
    for row, values in zip(many, sets, strict=True):
        alone = run(arm(), LOG, **dict(zip(names, values, strict=True)))
        np.testing.assert_allclose(row, alone, rtol=0, atol=1e-12)
    np.testing.assert_allclose(many[0], run(arm(), LOG), rtol=0, atol=1e-10)


def test_what_no_body_can_be_is_refused(refusal):
    log = slider_log(steps(20))
    assert "mass of -1 kg" in refusal(run, slider(), log, **{"mass_mismatch.dm@cart": -3.0})
    thin = {"inertia_mismatch.delta@lower": -1.5}
    assert "that no body has" in refusal(run, arm(), LOG, **thin)


def test_what_cannot_be_felt_is_no_candidate():
    known = {e.name: e for e in body_effects(mujoco.MjSpec.from_string(SLIDER))}
    assert known.keys() == {"mass_mismatch"}
    known = {e.name: e for e in body_effects(mujoco.MjSpec.from_string(ARM))}
    names = {"mass_mismatch", "com_offset", "inertia_mismatch", "payload", "load"}
    assert known.keys() == names
    assert [s.name for s in known["com_offset"].sizes] == ["x", "z"]  # they turn about y
    assert known["payload"].places == {"body lower": "@lower"}
    assert known["payload"].sizes[0].sign == 1
    assert known["load"].places == {"body upper": "@upper", "body lower": "@lower"}
    assert [s.name for s in known["load"].shapes] == ["x", "z"]
