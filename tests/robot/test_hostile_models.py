"""Models that would fill the memory or the day, or that have no motion, are refused at once."""

import numpy as np
import pytest
from joint_cases import SLIDER
from robot_cases import TOML, simulated

from identification import InputError, read_robot
from identification.effects.axes import Axis
from identification.effects.rows import read_model
from identification.logs.write import write_log

REPLICATE = (
    '<worldbody><replicate count="{0}"><replicate count="{0}"><body/></replicate></replicate>'
)
HOSTILE = {
    'mass="2"': {
        'mass="0"': "mass and inertia of moving bodies must be larger",
        'mass="nan"': "has mass='nan' in <inertial>; write numbers there",
    },
    'timestep="0.002"': {
        'timestep="0"': "has the timestep 0 s; give <option timestep> a number from",
        'timestep="-1"': "has the timestep -1 s",
        'timestep="nan"': "has timestep='nan' in <option>",
        'timestep="1e-12"': "has the timestep 1e-12 s",
    },
    "<worldbody>": {
        REPLICATE.format(100_000): "more than 20000; lower the counts of replicate",
        '<worldbody><replicate count="100000"><geom size="1"/></replicate>': "more than 20000",
        '<asset><hfield nrow="99999" ncol="99999" size="1 1 1 1"/></asset><worldbody>': "cells",
    },
    'gravity="0 0 0"': {'gravity="0 0 1e308"': r"has 1e\+308 in gravity, which no robot has"},
    'damping="3"': {'armature="inf"': "has an infinite number in dof_armature"},
    'gear="5"': {
        'gear="1e308"': r"has 1e\+308 in actuator_gear, which no robot has",
        'gear="1e-300"': "has force",
    },
    "</mujoco>": {
        "": "cannot be read", "</mujocc>": "cannot be read", 9999 * "<b>": "cannot be read",
    },
}  # fmt: skip
EVERY = [(old, new, said) for old, each in HOSTILE.items() for new, said in each.items()]


def write(folder, model, said=""):
    (folder / "slider.xml").write_text(model)
    (folder / "robot.toml").write_text(said + TOML)
    write_log(simulated({"damping": 3.0, "mass": 2.0}, 60), folder / "log.csv")
    return folder / "robot.toml", folder / "log.csv"


@pytest.mark.parametrize(("old", "new", "said"), EVERY, ids=[new[:40] for _, new, _ in EVERY])
def test_a_hostile_model_is_refused(tmp_path, capfd, old, new, said):
    assert old in SLIDER
    files = write(tmp_path, SLIDER.replace(old, new, 1))
    with pytest.raises(InputError, match=said) as refused:
        read_robot(*files)
    assert str(refused.value).isprintable()  # MuJoCo writes several lines
    assert capfd.readouterr().err == ""  # and warnings of its own


@pytest.mark.parametrize(
    "force",
    [
        1e51,
        0.0,
        np.nan,
    ],
)
def test_a_magnitude_that_no_robot_has_is_refused(refusal, force):
    assert "give one between 1e-50 and 1e+50" in refusal(Axis, "x", "slide", force, 1.0, 1.0)


def test_a_model_with_replicas_and_names_of_any_kind_is_read():
    text = SLIDER.replace(
        "</worldbody>",
        '<replicate count="3" offset="1 0 0"><body><geom size="0.1"/></body></replicate>'
        '<body name="nan"/></worldbody><sensor><framepos objtype="body" objname="nan"/></sensor>',
    )
    model = read_model(text).compile()
    assert model.nbody == 1 + 1 + 3 + 1
    assert np.isfinite(model.body_mass).all()
