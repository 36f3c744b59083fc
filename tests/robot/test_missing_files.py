"""Files of a model that are missing are left out where they tell its look, and asked for else."""

import mujoco
import numpy as np
import pytest
from touching_cases import make_robot, simulated

from identification import read_robot
from identification.effects.plant.rows import read_model, read_told_model
from identification.robot.file.model_file import robot_spec

ARM = """<mujoco><compiler meshdir="meshes" texturedir="pictures"/>{option}
<default><default class="visual"><geom type="mesh" contype="0" conaffinity="0" group="2" mass="0"/>
  <default class="dark"><geom rgba="0 0 0 1"/></default></default>
  <joint damping="0.3"/><position kp="9" kv="0.6"/></default>
<asset>{asset}</asset>
<worldbody><body name="base">{base}<body name="upper"><joint name="q1" axis="0 1 0"/>
  <inertial pos="0 0 -0.1" mass="0.6" diaginertia="0.004 0.004 0.001"/>{upper}
  <body name="lower" pos="0 0 -0.3"><joint name="q2" axis="0 1 0"/>{lower}
  <geom name="rod" type="capsule" fromto="0 0 0 0 0 -0.2" size="0.02"/>
  </body></body></body></worldbody>{more}
<actuator><position name="u1" joint="q1"/><position name="u2" joint="q2"/></actuator>
<sensor><jointpos name="q1" joint="q1"/><jointpos name="q2" joint="q2"/>{sensor}</sensor>
<keyframe><key name="home" qpos="0.3 0.2" ctrl="0.3 0.2"/></keyframe></mujoco>"""
PARTS = ("option", "asset", "base", "upper", "lower", "more", "sensor")
LOOK = """<mesh name="link" file="d/link.stl"/><mesh file="unused.obj"/><mesh file="base.stl"/>
<texture name="wood" type="2d" file="wood.png"/><material name="wood" texture="wood"/>
<hfield name="hills" file="hills.png" size="1 1 1 1"/>"""
SHOWN = {
    "asset": LOOK,
    "base": """<geom class="visual" mesh="base"/>
    <geom type="hfield" hfield="hills" contype="0" conaffinity="0"/>""",
    "upper": '<geom name="v" class="dark" mesh="link" material="wood"/>',
    "lower": '<geom type="mesh" mesh="link" contype="0" conaffinity="0" density="0"/>',
    "sensor": '<framepos objtype="geom" objname="v"/>',
}


def arm(**parts):
    return ARM.format(**{**dict.fromkeys(PARTS, ""), **parts})


def bits(model):
    fields = ("body_mass", "body_inertia", "body_ipos", "dof_damping", "actuator_gainprm",
              "actuator_biasprm", "key_qpos", "key_ctrl")  # fmt: skip
    return [getattr(model, field).tobytes() for field in fields]


def test_what_only_shows_is_left_out_and_told(tmp_path):
    path = tmp_path / "arm.xml"
    path.write_text(arm(**SHOWN))
    spec, said = read_told_model(path)
    model, bare = spec.compile(), mujoco.MjModel.from_xml_string(arm())
    assert bits(model) == bits(bare)
    assert (model.ngeom, model.nmesh, model.ntex, model.nhfield) == (1, 0, 0, 0)
    every = ("d/link.stl", "unused.obj", "base.stl", "wood.png", "hills.png")
    assert "names 5 files that are missing" in said
    assert sum(file in said for file in every) == 3  # and not the dozens that an arm may lack
    assert f"and 2 more (looked for in {tmp_path / 'meshes' / 'd'}, {tmp_path / 'meshes'}" in said
    assert said.endswith("they were left out, with 4 geoms of that shape.")
    assert bits(read_model(path.read_text()).compile()) == bits(bare)


MESH = {"asset": '<mesh name="link" file="link.stl"/>'}
HULL = '<geom name="hull" type="mesh" mesh="link" {}/>'
UNTOUCHED = 'contype="0" conaffinity="0"'


@pytest.mark.parametrize(
    ("parts", "why", "cure"),
    [
        ({"lower": HULL.format(UNTOUCHED)}, "the inertia of body lower", "an <inertial> with mass"),
        ({"upper": HULL.format("")}, "other bodies may touch geom hull", 'contype="0"'),
        ({"base": HULL.format("")}, "other bodies may touch geom hull", 'contact="disable"'),
        (
            {"upper": HULL.format(UNTOUCHED), "option": '<compiler inertiafromgeom="true"/>'},
            "the inertia of body upper", 'inertiafromgeom="auto"',
        ),
        (
            {
                "upper": HULL.format(UNTOUCHED),
                "more": '<contact><pair geom1="hull" geom2="rod"/></contact>',
            },
            "a <pair> of contacts names geom hull", "delete the <pair>",
        ),
        (
            {
                "upper": HULL.replace('"mesh" m', '"sphere" m').format(UNTOUCHED)
                + '<site name="a" pos="1 0 0"/><site name="b" pos="-1 0 0"/>',
                "more": """<tendon><spatial name="t"><site site="a"/><geom geom="hull"/>
                <site site="b"/></spatial></tendon>""",
            },
            "a tendon is wound around geom hull", "without a mesh",
        ),
        (
            {
                "upper": HULL.format(f'{UNTOUCHED} fluidshape="ellipsoid"'),
                "option": '<option density="1.2"/>',
            },
            "a fluid acts on geom hull", 'fluidshape="none"',
        ),
    ],
)  # fmt: skip
def test_what_moves_is_asked_for(tmp_path, refusal, parts, why, cure):
    path = tmp_path / "arm.xml"
    path.write_text(arm(**MESH, **parts))
    said = refusal(read_told_model, path)
    assert f"{path} names the file meshes/link.stl, which is missing, and {why}" in said
    assert cure in said


@pytest.mark.parametrize(
    "parts",
    [
        {"upper": HULL.format(""), "option": '<option><flag contact="disable"/></option>'},
        {"base": HULL.format(UNTOUCHED)},  # of a body that cannot move
        {"lower": HULL.format(f'{UNTOUCHED} group="3"'),
         "option": '<compiler inertiagrouprange="0 1"/>'},
        {"upper": HULL.format(f'{UNTOUCHED} fluidshape="ellipsoid"')},  # there is no fluid
    ],
)  # fmt: skip
def test_where_nothing_depends_on_a_shape_it_is_left_out(tmp_path, parts):
    path = tmp_path / "arm.xml"
    path.write_text(arm(**MESH, **parts))
    spec, said = read_told_model(path)
    assert "link.stl" in said
    model = spec.compile()
    bare = mujoco.MjModel.from_xml_string(arm(**{k: v for k, v in parts.items() if k == "option"}))
    assert bits(model) == bits(bare)


def test_of_two_files_with_one_name_only_the_missing_one_goes(tmp_path):
    (tmp_path / "meshes" / "a").mkdir(parents=True)
    corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
    (tmp_path / "meshes" / "a" / "link.obj").write_text(corners)
    meshes = "".join(f'<mesh name="{x}" file="{x}/link.obj"/>' for x in "ab")
    geoms = "".join(f'<geom class="visual" mesh="{x}"/>' for x in "ab")
    path = tmp_path / "arm.xml"
    path.write_text(arm(asset=meshes, base=geoms))
    spec, said = read_told_model(path)
    assert [mesh.name for mesh in spec.meshes] == ["a"]
    assert "b/link.obj" in said


def test_an_included_part_with_its_defaults_and_keyframes_is_read_like_one_file(tmp_path):
    text = arm(
        **{**SHOWN, "base": SHOWN["base"].splitlines()[0], "asset": LOOK[: LOOK.index("<hf")]}
    )
    first, last = text.index("<default>"), text.index("<worldbody>")
    (tmp_path / "parts").mkdir()
    part = f"<mujocoinclude>{text[first:last]}</mujocoinclude>"
    (tmp_path / "parts" / "look.xml").write_text(part)
    keys = text[text.index("<keyframe>") : text.index("</mujoco>")]
    (tmp_path / "keys.xml").write_text(f"<mujoco>{keys}</mujoco>")
    whole = text[:first] + '<include file="parts/look.xml"/>' + text[last:]
    path = tmp_path / "arm.xml"
    path.write_text(whole.replace(keys, '<include file="keys.xml"/>'))
    (tmp_path / "whole.xml").write_text(text)
    parted, said = read_told_model(path)
    assert bits(parted.compile()) == bits(read_model(tmp_path / "whole.xml").compile())
    assert "d/link.stl" in said


def test_a_missing_include_or_a_broken_mesh_is_refused_as_before(tmp_path, refusal):
    path = tmp_path / "arm.xml"
    path.write_text(arm(more='<include file="none.xml"/>'))
    assert "none.xml" in refusal(read_told_model, path)
    (tmp_path / "meshes").mkdir()
    (tmp_path / "meshes" / "link.stl").write_text("version https://git-lfs.github.com/spec/v1\n")
    path.write_text(arm(**MESH, base=HULL.format(UNTOUCHED)))
    assert "cannot be read" in refusal(read_told_model, path)


def test_a_keyframe_is_no_start(tmp_path):
    path = make_robot(tmp_path, arm(), simulated(arm(), samples=60), "q1")
    robot = read_robot(path, tmp_path / "log.csv", trust=["start"])
    assert np.array_equal(robot.plant_of(robot.log).bare.start.qpos, [0.0, 0.0])
    assert robot_spec(robot.file)[0].compile().nkey == 1
