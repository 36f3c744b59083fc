"""The plant: names, places, what it refuses, and company in one process."""

import mujoco
import numpy as np
import pytest
from joint_cases import (
    DAMPING,
    MASS,
    SLIDER,
    STEP,
    arm,
    arm_log,
    run,
    slider,
    slider_log,
    steps,
    stopping_time,
)
from plain_logs import plain_log

from identification import InputError, Parameter
from identification.effects.axes import Axis, axes
from identification.effects.catalogue import joint_effects
from identification.effects.plant.joint_plant import joint_plant
from identification.native.joints.joint_callback import STEPS
from identification.native.table import uninstall
from identification.windows.window_error import window_error
from identification.windows.window_estimate import estimate_windows


def test_common_and_single_sizes_add_up():
    log = arm_log(steps(80, 2))
    both = run(arm(), log, **{"stiffness.k": 0.5, "stiffness.k@elbow": 0.25})
    each = run(arm(), log, **{"stiffness.k@shoulder": 0.5, "stiffness.k@elbow": 0.75})
    np.testing.assert_array_equal(both, each)


def test_axes_are_read_off_the_log_and_hinges_apart_from_slides():
    u = 0.5 * np.ones((200, 1))
    t = np.arange(200) * STEP
    plant = joint_plant(SLIDER, (), slider_log(u, 0.2 * np.sin(3 * t)[:, None]))
    assert stopping_time(plant, "slide") == STEPS * plant.model.opt.timestep
    (size,) = next(e for e in plant.effects if e.name == "offset").sizes
    assert size.largest == pytest.approx(0.2 * 2.5)
    assert size.unit == "N"
    mixed = joint_effects((Axis("h", "hinge", 1, 1, 1), Axis("s", "slide", 1, 1, 1, plain=False)))
    names = {e.name: e for e in mixed}
    assert len(names) == len(mixed)
    assert names["slide_offset"].sizes[0].unit == "N"
    assert names["offset"].sizes[0].unit == "N m"
    assert "slide_load_dependent_friction" not in names


HOIST = """<mujoco><worldbody>
<body><joint name="lift" type="slide" axis="0 0 1"/><geom size="0.1" mass="2"/>
<body><joint name="swing" type="hinge" axis="0 1 0"/><geom size="0.05" pos="0 0 -0.5" mass="1"/>
</body></body></worldbody>
<actuator><motor name="winch" joint="lift"/></actuator>
<sensor><jointpos name="height" joint="lift"/><jointpos name="angle" joint="swing"/></sensor>
</mujoco>"""


def test_laws_of_a_drive_ask_for_one_and_friction_by_weight_for_a_weight_that_changes():
    rng = np.random.default_rng(0)
    u, y = 30 + rng.standard_normal((200, 1)), np.cumsum(rng.standard_normal((200, 2)), axis=0)
    log = plain_log(u, 1e-2 * y, "winch", "height angle", STEP)
    lift, swing = axes(mujoco.MjModel.from_xml_string(HOIST), log)
    assert (lift.plain, lift.heavy, lift.tilts) == (True, True, False)
    assert (swing.plain, swing.heavy, swing.tilts) == (False, True, True)
    places = {e.name: {*e.places} for e in joint_effects((lift, swing))}
    assert (
        places["slide_voltage_limit"] == places["slide_load_dependent_friction"] == {"joint lift"}
    )
    assert places["gravity_load_friction"] == places["gravity_force"] == {"joint swing"}
    assert places["slide_gravity_force"] == {"joint lift"}
    assert not {"slide_gravity_load_friction", "voltage_limit", "curve_load"} & {*places}


def test_the_largest_force_of_a_servo_is_what_it_gave_and_not_what_its_command_alone_would():
    t = np.arange(400) * STEP
    q = 0.3 * np.sin(3 * t)
    motor = 'gear="5" ctrlrange="-3 3" ctrllimited="true"'
    servo = 'gear="2" gainprm="40" biastype="affine" biasprm="0 -40 -3"'
    model = mujoco.MjModel.from_xml_string(SLIDER.replace(motor, servo))
    log = slider_log((2 * q + 0.01)[:, None], q[:, None])  # 0.01 before the lead of 2 q
    (axis,) = axes(model, log)
    force = 2 * (40 * (log.inputs[:, 0] - 2 * q) - 3 * 2 * 0.9 * np.cos(3 * t))
    assert axis.force == pytest.approx(np.abs(force).max(), rel=1e-3)
    assert axis.force < 0.4 * 2 * 40 * np.abs(log.inputs).max()


def test_a_drive_at_a_tendon_acts_on_the_joint_over_which_it_runs():
    t = np.arange(400) * STEP
    q = 0.3 * np.sin(3 * t)
    start, end = SLIDER.index("<actuator>"), SLIDER.index("</actuator>")
    joint = mujoco.MjModel.from_xml_string(SLIDER).joint(0).name
    tendon = f'<tendon><fixed name="rope"><joint joint="{joint}" coef="0.5"/></fixed></tendon>'
    pull = '<actuator><motor name="u" tendon="rope" gear="4"/>'
    model = mujoco.MjModel.from_xml_string(SLIDER[:start] + tendon + pull + SLIDER[end:])
    log = slider_log((2 * q + 0.01)[:, None], q[:, None])
    (axis,) = axes(model, log)
    assert axis.force == pytest.approx(0.5 * 4 * np.abs(log.inputs).max(), rel=1e-3)


def test_what_cannot_be_is_refused():
    with pytest.raises(InputError, match="in which it moves"):
        joint_plant(SLIDER, (), slider_log(steps(50), np.zeros((50, 1))))
    with pytest.raises(InputError, match="hinge or slide joint"):
        joint_plant(SLIDER, (), slider_log(steps(50)), joints=(Axis("x", "slide", 1, 1, 1),))
    with pytest.raises(InputError, match="no such folder: no/such"):
        joint_plant("no/such/file.xml", (), slider_log(steps(50)))
    with pytest.raises(InputError, match="unknown parameter"):
        run(slider(), slider_log(steps(50)), **{"coulomb.f": 1.0})


def test_an_effect_of_an_input_is_that_input_changed():
    u = steps(100)
    late = np.vstack([np.zeros((3, 1)), u[:-3]])
    log = slider_log(u)
    np.testing.assert_array_equal(
        run(slider(), log, **{"delay.tau@force": 3 * STEP}), run(slider(), slider_log(late))
    )
    sets = np.array([[0.0], [0.02]])
    held = slider().inputs(("delay.tau@force",), sets, np.repeat(u, 5, axis=0), 0.002)
    assert held.shape == (2, 500, 1)
    np.testing.assert_array_equal(held[0], np.repeat(u, 5, axis=0))


def test_joints_and_cables_live_in_one_process():
    from inca_mj import build_twin, make_input, simulate
    from inca_mj.twin import native

    log = slider_log(steps(60))
    before = run(slider(), log, **{"offset.f_0@slide": 0.2})
    cables = simulate(build_twin(), make_input("prbs", 0.2)).angles
    np.testing.assert_array_equal(before, run(slider(), log, **{"offset.f_0@slide": 0.2}))
    uninstall()
    np.testing.assert_array_equal(before, run(slider(), log, **{"offset.f_0@slide": 0.2}))
    native.install()
    np.testing.assert_array_equal(cables, simulate(build_twin(), make_input("prbs", 0.2)).angles)


def test_windows_see_what_the_plant_makes_of_its_inputs():
    u = steps(200, hold=7)
    delay = {"delay.tau@force": 0.017}
    log = slider_log(u, run(slider(), slider_log(u), **delay))
    late = window_error(slider(), log, 0.25, delay)
    assert np.abs(late).max() < 1e-8 < 1e-4 < np.abs(window_error(slider(), log, 0.25)).max()
    fit = estimate_windows(slider(), log, ("mass", "damping"), 0.25, {"mass": 2.3, **delay})
    assert fit.values["mass"] == pytest.approx(2.0, rel=1e-5)


def test_a_window_is_explained_as_well_among_others_where_the_joint_sticks_as_by_itself():
    """Stiff friction forgets the first rate at once; an undamped step from there goes anywhere.

    What is less than half of the noise's own square does not matter.
    """
    u = np.where(np.arange(400)[:, None] % 100 < 50, steps(400, hold=10), 0.3)
    clean = run(slider(), slider_log(u), **{"coulomb_friction.f_c@slide": 4.0})
    log = slider_log(u, clean + 1e-4 * np.random.default_rng(5).standard_normal(clean.shape))
    more = {"coulomb_friction.f_c@slide": 4.6}
    among = window_error(slider(), log, 0.2, more)
    for k, error in enumerate(among):
        rows = slice(20 * k, 20 * k + 20)
        alone = window_error(slider(), slider_log(u[rows], log.outputs[rows]), 0.2, more)
        assert np.sum(error**2) < 1.05 * np.sum(alone**2) + 0.5 * error.size * 1e-4**2, k


def test_a_friction_that_the_data_do_not_want_goes_to_nothing_and_no_search_fails():
    u = steps(200, hold=10)
    log = slider_log(u, run(slider(), slider_log(u)))
    unwanted = Parameter(
        name="coulomb_friction.f_c@slide", value=0.1, unit="N", where="effect", lower=0.0
    )
    plant = joint_plant(SLIDER, (MASS, DAMPING, unwanted), log)
    too_much = {"damping": 4.0}  # so that the rest should push
    fit = estimate_windows(plant, log, ("mass", unwanted.name), 0.2, too_much)
    assert fit.values[unwanted.name] < 1e-9
    assert fit.std[1] == np.inf


def test_a_wave_is_tried_only_where_two_periods_of_it_are_seen():
    def waves(travel):
        known = (Axis(joint="j", kind="hinge", force=1.0, speed=2.0, travel=travel),)
        return next((e.shapes[0].grid for e in joint_effects(known) if e.name == "cogging"), ())

    assert waves(0.1) == ()  # less than two periods of the highest harmonic
    assert min(waves(2 * np.pi)) == 2.0
    assert min(waves(4 * np.pi)) == 1.0
