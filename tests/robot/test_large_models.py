"""A model that may be large is compiled by a process that can be ended; a usual one is not."""

import os
import re
import sys

import numpy as np
import pytest
from joint_cases import SLIDER
from robot_cases import write_slider

from identification import InputError, read_robot
from identification.effects.plant.rows import read_model
from identification.model import hostile
from identification.model.hostile import refuse_hostile
from identification.runtime import child as child_process
from identification.storage.files import is_file

SMALL = '<geom size="0.01" contype="0" conaffinity="0" mass="0"/>'
LARGE = {
    "replicas": f'<worldbody><replicate count="2100" offset="0.1 0 0">{SMALL}</replicate>',
    "heightfield": '<asset><hfield name="h" nrow="1100" ncol="1100" size="1 1 1 1"/></asset>'
    "<worldbody>",
    "user data": '<size nuser_geom="20000"/><worldbody>',
}
ENDS = {
    "print(100)": "",
    "print(10**9)": "has 954 MB when it is compiled",
    "import sys; sys.exit(3)": "",
    "import sys; sys.exit(4)": "takes more than 8 GB of memory while MuJoCo compiles it",
    "import os, signal; os.kill(os.getpid(), signal.SIGXCPU)": "is not compiled by MuJoCo within",
    "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)": "is not compiled by MuJoCo within",
    "import time; time.sleep(60)": "is not compiled by MuJoCo in time",
}


@pytest.fixture
def compiled_by_another(monkeypatch):
    """What another process was asked to compile."""
    asked = []
    monkeypatch.setattr(
        "identification.effects.plant.rows.refuse_endless",
        lambda source, where, amount: asked.append((source, where)),
    )
    return asked


def with_part(part):
    assert SLIDER.count("<worldbody>") == 1
    return SLIDER.replace("<worldbody>", part)


@pytest.mark.parametrize("part", LARGE)
def test_only_what_may_be_large_is_compiled_by_another_process(compiled_by_another, part):
    read_model(SLIDER)
    assert compiled_by_another == []
    read_model(with_part(LARGE[part]))
    assert [where for _, where in compiled_by_another] == ["the model"]


def test_what_a_model_includes_and_names_counts_too(tmp_path, compiled_by_another):
    inside = LARGE["replicas"] + "</worldbody>"
    (tmp_path / "part.xml").write_text(f"<mujocoinclude>{inside}</mujocoinclude>")
    (tmp_path / "arm.xml").write_text(with_part('<include file="part.xml"/><worldbody>'))
    read_model(tmp_path / "arm.xml")
    assert [where for _, where in compiled_by_another] == [f"the model {tmp_path / 'arm.xml'}"]
    with (tmp_path / "box.stl").open("wb") as file:
        file.truncate(hostile.BYTES + 1)
    mesh = '<compiler meshdir="."/><asset><mesh name="m" file="box.stl"/></asset><worldbody>'
    assert refuse_hostile(with_part(mesh), "the model", tmp_path).much


@pytest.mark.skipif(os.name != "posix", reason="pipes of POSIX")
@pytest.mark.parametrize("part", [
    '<include file="pipe"/><worldbody>',
    '<compiler meshdir="meshes"/><asset><mesh name="m" file="../pipe"/></asset><worldbody>',
])  # fmt: skip
def test_a_pipe_that_a_model_names_is_not_waited_for(tmp_path, part):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "meshes").mkdir()
    (tmp_path / "arm.xml").write_text(with_part(part))
    with pytest.raises(InputError, match="pipe is not a regular file"):
        read_model(tmp_path / "arm.xml")


def test_a_model_that_includes_itself_is_refused(tmp_path):
    (tmp_path / "arm.xml").write_text(with_part('<include file="arm.xml"/><worldbody>'))
    with pytest.raises(InputError, match="includes itself; take the <include> out"):
        read_model(tmp_path / "arm.xml")


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
@pytest.mark.parametrize("child", ENDS)
def test_a_compilation_without_end_is_refused(tmp_path, monkeypatch, child):
    (tmp_path / "child.py").write_text(child)
    monkeypatch.setattr(child_process, "__file__", str(tmp_path / "child.py"))
    if "sleep" in child:
        monkeypatch.setattr(hostile, "_WAITING", 0.05)
    if not ENDS[child]:
        hostile.refuse_endless("<mujoco/>", "the model", hostile.Amount())
        return
    with pytest.raises(InputError, match=rf"{ENDS[child]}.*lower its counts"):
        hostile.refuse_endless("<mujoco/>", "the model", hostile.Amount())
    assert is_file(tmp_path / "child.py")


@pytest.mark.parametrize("count", [2 * 10**7, pytest.param(3 * 10**8, marks=pytest.mark.long)])
def test_user_data_without_end_are_refused_by_their_name(count):
    """The larger count meets the bounds of memory and time, which takes ten seconds each."""
    asked = re.escape(f"lower nuser_body, which asks for {count:.3g} numbers of each element")
    told = f"(takes more than 8 GB|MB when it is compiled|is not compiled by MuJoCo).*{asked}"
    with pytest.raises(InputError, match=told):
        read_model(with_part(f'<size nuser_geom="4" nuser_body="{count}"/><worldbody>'))


def test_a_model_too_large_to_be_copied_is_refused(monkeypatch):
    monkeypatch.setattr("identification.model.hostile.LARGEST", 2**8)
    with pytest.raises(InputError, match="MB when it is compiled, more than the 0 MB"):
        read_model(SLIDER)


def test_bodies_that_sleep_are_refused():
    text = with_part('<option><flag sleep="enable"/></option><worldbody>')
    with pytest.raises(InputError, match='write <flag sleep="disable"/>'):
        read_model(text)


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


@pytest.mark.parametrize(("old", "new", "said"), EVERY, ids=[new[:40] for _, new, _ in EVERY])
def test_a_hostile_model_is_refused(tmp_path, capfd, old, new, said):
    assert old in SLIDER
    files = write_slider(tmp_path, 60, model=SLIDER.replace(old, new, 1))
    with pytest.raises(InputError, match=said) as refused:
        read_robot(*files)
    assert str(refused.value).isprintable()  # MuJoCo writes several lines
    assert capfd.readouterr().err == ""  # and warnings of its own


def test_a_model_with_replicas_and_names_of_any_kind_is_read():
    text = SLIDER.replace(
        "</worldbody>",
        '<replicate count="3" offset="1 0 0"><body><geom size="0.1"/></body></replicate>'
        '<body name="nan"/></worldbody><sensor><framepos objtype="body" objname="nan"/></sensor>',
    )
    model = read_model(text).compile()
    assert model.nbody == 1 + 1 + 3 + 1
    assert np.isfinite(model.body_mass).all()
