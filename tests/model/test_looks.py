"""Meshes and textures that only show are left out of simulations, and nothing else changes."""

import mujoco
import numpy as np
import pytest
from plain_logs import plain_log

from identification.effects.plant.joint_plant import joint_plant
from identification.model.looks import without_looks

WEDGE = "0 0 0  0.3 0 0  0 0.04 0  0 0 0.06"
MJCF = """<mujoco><compiler angle="radian"{inertia}/>
<option timestep="0.002" integrator="RK4"{flag}/>
<default><default class="look"><geom {touch}/></default></default>
<asset><mesh name="wedge" vertex="{wedge}"/><mesh name="other" vertex="{wedge}" scale="2 1 1"/>
  <texture name="sky" type="skybox" builtin="gradient" width="64" height="64"/>
  <texture name="grid" type="2d" builtin="checker" width="256" height="256"/>
  <material name="paint" texture="grid"/></asset>
<worldbody><geom name="floor" type="plane" size="1 1 0.1" pos="0 0 -2" material="paint"/>
 <body name="link"><joint name="j" axis="0 1 0" damping="0.05"/>
  <geom class="look" type="mesh" mesh="wedge" pos="0.02 0 0.01" euler="0.3 0.2 0.1" mass="0.4"/>
  <geom name="horn" class="look" type="mesh" mesh="other" pos="0.1 0 0" mass="0.1"
   material="paint"/>
  <geom name="ball" type="sphere" size="0.02" pos="0.3 0 0" mass="0.2" contype="0"
   conaffinity="0"/>
  <body name="tip" pos="0.4 0 0"><joint name="k" axis="0 1 0" damping="0.02"/>
   <inertial pos="0.1 0 0" mass="0.3" diaginertia="1e-3 2e-3 2e-3"/>
   <geom class="look" type="mesh" mesh="wedge"/></body></body></worldbody>
<actuator><motor name="u" joint="j"/></actuator>
<sensor><jointpos name="y" joint="j"/><jointpos name="z" joint="k"/></sensor></mujoco>"""
LOOK, TOUCH = 'contype="0" conaffinity="0"', 'contype="1" conaffinity="1"'
OF_GEOMS = ("geom_pos", "geom_quat", "geom_bodyid", "geom_contype", "geom_conaffinity")
OF_MOTION = ("body_mass", "body_inertia", "body_ipos", "body_iquat", "dof_M0", "dof_invweight0")


def spec(touch=LOOK, inertia="", flag=""):
    text = MJCF.format(touch=touch, inertia=inertia, flag=flag, wedge=WEDGE)
    return mujoco.MjSpec.from_string(text)


def moved(model):
    """The way of a model under a sine."""
    data, out = mujoco.MjData(model), []
    for k in range(400):
        data.ctrl[:] = 0.8 * np.sin(0.03 * k)
        mujoco.mj_step(model, data)
        out.append(data.qpos.copy())
    return np.array(out)


@pytest.mark.parametrize("how", [
    {}, {"inertia": ' inertiafromgeom="true"'},
    {"flag": ' density="1.2" viscosity="1e-3"'},
])  # fmt: skip
def test_nothing_but_the_look_is_left_out(how):
    whole = spec(**how)
    model = whole.compile()
    less = without_looks(whole, model).compile()
    assert less.nmesh == less.ntex == 0
    assert mujoco.mj_sizeModel(less) < 0.1 * mujoco.mj_sizeModel(model)
    for field in (*OF_GEOMS, *OF_MOTION):
        np.testing.assert_array_equal(getattr(less, field), getattr(model, field))
    assert [less.geom(i).name for i in range(less.ngeom)] == [
        model.geom(i).name for i in range(model.ngeom)
    ]
    np.testing.assert_array_equal(moved(less), moved(model))
    assert len(whole.meshes) == 2  # the given model stays as it is


def test_a_mesh_that_may_touch_keeps_its_shape():
    whole = spec(touch=TOUCH)
    model = whole.compile()
    less = without_looks(whole, model).compile()
    assert (less.nmesh, less.ntex) == (2, 0)
    np.testing.assert_array_equal(less.geom_type, model.geom_type)


def test_a_model_without_looks_is_itself():
    whole = mujoco.MjSpec.from_string("<mujoco><worldbody><body/></worldbody></mujoco>")
    assert without_looks(whole, whole.compile()) is whole


def test_a_plant_predicts_without_the_looks_of_its_model_and_keeps_them_in_its_file():
    t = 0.01 * np.arange(50)
    log = plain_log(np.sin(t)[:, None], 0.1 * np.sin(np.outer(t, [3, 4])), "u", "y z", 0.01)
    plant = joint_plant(spec(), (), log)
    assert plant.model.nmesh == plant.model.ntex == 0
    assert len(plant.spec.meshes) == 2
