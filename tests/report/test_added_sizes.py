"""The size of an effect that is added to a number of the model is told beside that number."""

from types import SimpleNamespace

import numpy as np
import pytest
from arm_cases import LOG

from identification import read_robot
from identification.effects.effect import Candidate
from identification.effects.plant.joint_plant import candidates, joint_plant
from identification.quantities import quantity
from identification.report.words.effects import ADDED_TO, _already, describe_sizes

MODEL = """<mujoco><option integrator="RK4"/><worldbody><body name="arm">
  <joint name="swing" axis="0 1 0" damping="0.05" {numbers}/>
  <geom type="capsule" size="0.02" fromto="0 0 0 0 0 -0.4" mass="0.5" contype="0" conaffinity="0"/>
  </body></worldbody><actuator><motor name="torque" joint="swing"/></actuator>
  <sensor><jointpos name="angle" joint="swing"/></sensor></mujoco>"""
OWN = {"frictionloss": 0.08, "stiffness": 0.3, "armature": 0.02}


def plant(folder, numbers):
    (folder / "arm.xml").write_text(MODEL.format(numbers=numbers))
    toml = (
        'model = "arm.xml"\nfree = ["joint/swing.damping"]\ntrust = ["wiring", "units", "steps"]\n'
    )
    (folder / "arm.toml").write_text(toml)
    time = np.arange(400) / 100
    angle = np.sin(3 * time - 0.5) + np.random.default_rng(0).normal(0, 0.01, 400)
    rows = np.stack([time, np.sin(3 * time), angle], axis=1)
    log = folder / "log.csv"
    np.savetxt(log, rows, delimiter=",", header="time,torque,angle", comments="")
    return read_robot(folder / "arm.toml", log).plant


@pytest.mark.parametrize("has", [True, False])
def test_it_is_told_beside_the_number_that_it_adds_to(tmp_path, has):
    numbers = " ".join(f'{n}="{value}"' for n, value in OWN.items()) if has else ""
    of, seen = plant(tmp_path, numbers), set()
    for effect in of.effects:
        (where, *_), (size, *_) = effect.places, effect.sizes
        found = SimpleNamespace(
            candidate=Candidate(effect, where, {}), parameters={size.name: (0.5, 0.01, size.unit)}
        )
        said, added = describe_sizes(found, of), ADDED_TO.get(effect.name, "").rpartition(".")[2]
        value = {"mass": 0.5, **(OWN if has else {})}.get(added)
        if value:
            assert f"in addition to the {quantity(value, unit=size.unit)} of the model" in said
            seen.add(added)
        else:
            assert "addition" not in said
    assert seen == ({*OWN} if has else set()) | (seen & {"mass"})


ARM = """<mujoco><worldbody><body><joint name="j1" axis="0 1 0" frictionloss="0.08"/>
  <geom size="0.1" pos="0 0 -0.2" mass="0.5"/>
  <body name="tip" pos="0 0 -0.4"><joint name="j2" axis="0 1 0"/>
  <geom size="0.1" mass="0.25"/></body>
  </body></worldbody>
  <actuator><motor name="one" joint="j1"/><motor name="two" joint="j2"/></actuator>
  <sensor><jointpos name="a" joint="j1"/><jointpos name="b" joint="j2"/></sensor></mujoco>"""


def test_a_body_without_a_name_is_no_error():
    plant = joint_plant(ARM, (), LOG)
    effect = next(e for e in candidates(plant, ()) if e.name == "mass_mismatch")
    first = next(w for w, suffix in effect.places.items() if suffix)
    assert _already(Candidate(effect, first, {}), plant) == ""
