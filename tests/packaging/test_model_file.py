import mujoco
import numpy as np

from inca_mj.files import model_path
from inca_mj.twin.twin import build_twin


def test_the_model_file_is_the_twin():
    built, read = build_twin().model, mujoco.MjModel.from_xml_path(str(model_path()))
    for field in ("actuator_user", "tendon_user", "actuator_gear", "dof_armature", "dof_damping",
                  "body_mass", "body_inertia", "site_pos", "key_qpos", "key_act"):  # fmt: skip
        ours, theirs = getattr(built, field), getattr(read, field)
        np.testing.assert_allclose(ours, theirs, rtol=1e-12, err_msg=field)
    assert read.opt.timestep == built.opt.timestep
