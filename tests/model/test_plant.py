"""Identification serves any model, without INCA."""

import subprocess
import sys
from pathlib import Path

import mujoco
import numpy as np
import pytest
from estimation_plants import SLIDER, SLIDER_PARAMETERS, record, slider

from identification import InputError, Parameter, ParameterSet
from identification.model.plant import ModelPlant
from identification.model.predictor import Predictor

ROOT = Path(__file__).parents[2]


def test_a_slider_is_fitted_where_inca_cannot_be_imported():
    code = """
import sys
sys.modules["inca_mj"] = None
from estimation_plants import record, slider
from identification.estimation.estimation import estimate
log = record(slider(), ("position",))
found = estimate(slider(), log, ("stiffness",), {"stiffness": 14.0}).values
sys.exit(abs(found["stiffness"] / 20 - 1) > 1e-6)
"""
    subprocess.run(
        [sys.executable, "-c", code], check=True, cwd=ROOT / "tests" / "cases",
        env={"PYTHONPATH": str(ROOT)},
    )  # fmt: skip


def test_values_moved_equal_values_written():
    values = {"mass": 1.4, "damping": 2.0, "stiffness": 31.0, "gear": 4.0, "x0": -0.2, "v0": 0.3}
    log = record(slider(**values), ("position", "rate"))
    moved = Predictor(slider(), log, tuple(values)).predict(np.array([list(values.values())]))[0]
    np.testing.assert_array_equal(moved, log.outputs)


def test_the_users_model_is_left_alone():
    model = mujoco.MjModel.from_xml_string(SLIDER)
    ModelPlant(model, SLIDER_PARAMETERS.with_values({"mass": 9.0}))
    assert model.body("cart").mass[0] == 2.0


@pytest.mark.parametrize(
    ("where", "said"),
    [
        ("joint/slid.damping", "did you mean 'slide'"),
        ("act[0]", "act has 0 entries"),
        ("body/cart.mass", "place of its own"),
    ],
)
def test_a_wrong_place_is_refused_at_once(where, said):
    records = (SLIDER_PARAMETERS["mass"], Parameter(name="p", value=1.0, unit="", where=where))
    with pytest.raises(InputError, match=said.replace("[", r"\[")):
        ModelPlant(mujoco.MjModel.from_xml_string(SLIDER), ParameterSet("p", records))


def test_an_armature_moves_the_constants_that_follow_from_it():
    """A friction loss is a constraint, and constraints weigh with what mj_setConst derives."""
    xml = SLIDER.replace('damping="3"', 'damping="3" frictionloss="1" armature="0.5"')
    records = (positive_armature(0.5),)
    model = mujoco.MjModel.from_xml_string(xml)
    log = record(ModelPlant(model, ParameterSet("p", (positive_armature(4.0),))), ("position",))
    moved = Predictor(ModelPlant(model, ParameterSet("p", records)), log, ("armature",))
    np.testing.assert_array_equal(moved.predict(np.array([[4.0]]))[0], log.outputs)


def positive_armature(value):
    return Parameter(
        name="armature", value=value, unit="kg", where="joint/slide.armature", lower=0.0
    )


MOTOR = """<mujoco><option timestep="0.001" gravity="0 0 0" integrator="RK4"/>
  <worldbody><body><joint name="shaft" type="hinge" axis="0 0 1"/>
    <inertial pos="0 0 0" mass="0.5" diaginertia="6e-4 6e-4 6e-4"/></body></worldbody>
  <actuator><dcmotor name="motor" joint="shaft" motorconst="0.05" resistance="1" {more}/></actuator>
  <sensor><jointpos name="angle" joint="shaft"/></sensor></mujoco>"""
LUGRE, INDUCTANCE = 'lugre="3 0.01 0.02 0.03 0.5"', 'inductance="0.01"'


def motor(path, more=""):
    model = mujoco.MjModel.from_xml_string(MOTOR.format(more=more))
    given = Parameter(name="p", value=0.02, unit="", where=f"actuator/motor.{path}", lower=0.0)
    return ModelPlant(model, ParameterSet("motor", (given,)))


@pytest.mark.parametrize(
    ("path", "term"),
    [
    ("biasprm[3]", LUGRE), ("dynprm[5]", LUGRE),
],
)  # fmt: skip
def test_a_number_of_a_dcmotor_that_nothing_reads_is_refused(refusal, path, term):
    said = refusal(motor, path)
    word = "LuGre friction" if term is LUGRE else "inductance"
    assert said.startswith(f"p (actuator/motor.{path}) is ")
    assert f"of the {word} of the dcmotor motor, which this model does not have" in said
    assert "actuator/motor.gainprm[0] (resistance R)" in said
    assert motor(path, term).parameters["p"].value == 0.02
    other = INDUCTANCE if term is LUGRE else LUGRE  # what can be freed is what the file gives
    listed = "dynprm[0] (time constant" if term is LUGRE else "biasprm[3] (τ_c)"
    assert listed in refusal(motor, path, other).rpartition("free another")[2]
    assert listed not in said.rpartition("free another")[2]
