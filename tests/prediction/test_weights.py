"""Weights of the outputs do not run away where a model cannot follow all of them."""

from functools import cache

import mujoco
import numpy as np
import pytest
from plain_logs import model_log, noise, stepped

from identification import fit, read_robot
from identification.prediction.fits import nominal_fit

NOISE = 1e-5  # [m]
# The mass of the second body is felt along both slides. In the world a rotor that the model lacks
# moves with the second slide, so that no mass serves both.
MJCF = """<mujoco><option timestep="0.005" integrator="RK4"/><worldbody>
  <body><joint name="a" type="slide" axis="1 0 0" damping="1" stiffness="5"/>
    <geom size="0.1" mass="1" contype="0" conaffinity="0"/>
    <body name="second"><joint name="b" type="slide" axis="0 1 0" damping="1" stiffness="5"
      armature="{rotor}"/><geom size="0.1" mass="1" contype="0" conaffinity="0"/></body></body>
  </worldbody><actuator><motor name="u" joint="a"/><motor name="w" joint="b"/></actuator>
  <sensor><jointpos name="qa" joint="a"/><jointpos name="qb" joint="b"/></sensor></mujoco>"""


@cache
def logs(rotor):
    world = mujoco.MjModel.from_xml_string(MJCF.format(rotor=rotor))
    out = []
    for seed in range(2):
        chance = np.random.default_rng(seed)
        u = np.repeat(chance.uniform(-2, 2, (20, 2)), 20, axis=0)
        y = stepped(world, u)
        out.append(model_log(world, u, y + noise(y.shape, NOISE, seed), name=f"log_{seed}"))
    return out


def mass(folder, rotor):
    """The mass of the second body that a fit finds, whatever was known of it [kg]."""
    (folder / "robot.xml").write_text(MJCF.format(rotor=0), encoding="utf-8")
    toml = folder / "robot.toml"
    toml.write_text('model = "robot.xml"\nfree = ["body/second.mass"]\nhorizon = 0.4\n', "utf-8")
    first, second = logs(rotor)
    return fit(read_robot(toml, first, confirm=[second])).values["body/second.mass"]


def test_the_first_weights_stay_where_later_ones_would_give_an_output_up(tmp_path, monkeypatch):
    rotor = 1.0
    found = mass(tmp_path, rotor)
    assert 1.2 < found < 1.8  # between the masses that serve the first slide and the second one
    monkeypatch.setattr(nominal_fit, "MAX_RISE", np.inf)
    assert mass(tmp_path, rotor) == pytest.approx(1 + rotor, abs=1e-3)


def test_weights_change_no_value_of_a_right_model(tmp_path, monkeypatch):
    found = mass(tmp_path, 0.0)
    assert found == pytest.approx(1.0, abs=1e-3)
    monkeypatch.setattr(nominal_fit, "MAX_RISE", 1.0)
    assert mass(tmp_path, 0.0) == pytest.approx(found, abs=1e-4)
