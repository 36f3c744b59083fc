import mujoco
import pytest

from identification.errors import InputError
from inca_mj.files import model_path
from inca_mj.twin import build_twin


def test_the_model_file_is_the_twin():
    built, read = build_twin().model, mujoco.MjModel.from_xml_path(str(model_path()))
    for field in ("actuator_user", "tendon_user", "actuator_gear", "dof_armature", "dof_damping",
                  "body_mass", "body_inertia", "site_pos", "key_qpos", "key_act"):  # fmt: skip
        assert (getattr(built, field) == getattr(read, field)).all(), field
    assert read.opt.timestep == built.opt.timestep


@pytest.mark.skipif(mujoco.__version__ != "3.17.0", reason="the text is that of the locked MuJoCo")
def test_the_model_file_is_what_the_builder_writes_today(tmp_path):
    fresh = build_twin().save(tmp_path / "inca6d.xml").read_text(encoding="utf-8")
    assert model_path().read_text(encoding="utf-8") == fresh, (
        "write it anew: build_twin().save('models/inca6d.xml')"
    )


def test_a_missing_model_says_where_it_was_looked_for():
    with pytest.raises(InputError, match=r"none\.xml is in neither .*models.* install"):
        model_path("none.xml")
