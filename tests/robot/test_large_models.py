"""A model that may be large is compiled by a process that can be ended; a usual one is not."""

import os
import re
import sys

import pytest
from joint_cases import SLIDER

from identification import InputError
from identification.effects.rows import read_model
from identification.files import is_file
from identification.model import compile_child, large
from identification.model.hostile import refuse_hostile

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
        "identification.effects.rows.refuse_endless",
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


@pytest.mark.parametrize("part", LARGE)
def test_what_ends_within_the_bound_is_read(part):
    assert read_model(with_part(LARGE[part])).compile().nu == 1


def test_what_a_model_includes_and_names_counts_too(tmp_path, compiled_by_another):
    inside = LARGE["replicas"] + "</worldbody>"
    (tmp_path / "part.xml").write_text(f"<mujocoinclude>{inside}</mujocoinclude>")
    (tmp_path / "arm.xml").write_text(with_part('<include file="part.xml"/><worldbody>'))
    read_model(tmp_path / "arm.xml")
    assert [where for _, where in compiled_by_another] == [f"the model {tmp_path / 'arm.xml'}"]
    with (tmp_path / "box.stl").open("wb") as file:
        file.truncate(large.BYTES + 1)
    mesh = '<compiler meshdir="."/><asset><mesh name="m" file="box.stl"/></asset><worldbody>'
    assert refuse_hostile(with_part(mesh), "the model", tmp_path).may_be_large


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
    monkeypatch.setattr(compile_child, "__file__", str(tmp_path / "child.py"))
    if "sleep" in child:
        monkeypatch.setattr(large, "_WAITING", 0.05)
    if not ENDS[child]:
        large.refuse_endless("<mujoco/>", "the model", large.Amount())
        return
    with pytest.raises(InputError, match=rf"{ENDS[child]}.*lower its counts"):
        large.refuse_endless("<mujoco/>", "the model", large.Amount())
    assert is_file(tmp_path / "child.py")


@pytest.mark.parametrize(
    "name",
    [
        "nuser_body",
    ],
)
@pytest.mark.parametrize("count", [2 * 10**7, pytest.param(3 * 10**8, marks=pytest.mark.long)])
def test_user_data_without_end_are_refused_by_their_name(name, count):
    """The larger count meets the bounds of memory and time, which takes ten seconds each."""
    asked = re.escape(f"lower {name}, which asks for {count:.3g} numbers of each element")
    told = f"(takes more than 8 GB|MB when it is compiled|is not compiled by MuJoCo).*{asked}"
    with pytest.raises(InputError, match=told):
        read_model(with_part(f'<size nuser_geom="4" {name}="{count}"/><worldbody>'))


def test_a_model_too_large_to_be_copied_is_refused(monkeypatch):
    monkeypatch.setattr("identification.model.large.LARGEST", 2**8)
    with pytest.raises(InputError, match="MB when it is compiled, more than the 0 MB"):
        read_model(SLIDER)


@pytest.mark.parametrize("value", ["enable", "disable"])
def test_bodies_that_sleep_are_refused(value):
    text = SLIDER.replace("<worldbody>", f'<option><flag sleep="{value}"/></option><worldbody>')
    if value == "disable":
        assert read_model(text).compile().nu == 1
        return
    with pytest.raises(InputError, match='write <flag sleep="disable"/>'):
        read_model(text)
