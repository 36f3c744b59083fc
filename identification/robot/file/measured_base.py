"""A free joint whose pose a log measures, as three slides and three hinges.

    <freejoint name="base"/>   ->   slides base_x, base_y, base_z along the axes of the world,
                                    hinges base_yaw, base_pitch, base_roll, each with a sensor

    R = R_z(yaw) R_y(pitch) R_x(roll) = R_0 R(a_1, yaw - yaw_0) R(a_2, ...) R(a_3, ...)

R_0 is the rotation in the model's file, and the axes a stand in the frame of the body there, so
that the model stays where it was and equalities and tendons keep their lengths. The motion is that
of the free joint. All that holds for slides and hinges then holds for a base: where windows begin,
and what may be missing along and about each axis. `identification.logs.poses` makes the same six
numbers of a log's pose.

The pose is told by `[columns]` of the robot's file, by the name of the free joint (or of its body)
with seven columns, or by those of its framepos (three) and framequat (four) sensors.
"""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from identification.errors import InputError
from identification.logs.formats.arrays import names_of
from identification.logs.names import listed
from identification.logs.poses import AXES, Pose, angles
from identification.robot.file.completed import add_position
from identification.robot.file.file import RobotFile

_FREE = int(mujoco.mjtJoint.mjJNT_FREE)
_KINDS = {int(mujoco.mjtSensor.mjSENS_FRAMEPOS): 3, int(mujoco.mjtSensor.mjSENS_FRAMEQUAT): 4}
_OBJECTS = {  # of such sensors, by the word of their arrays; "" where the object is the body
    int(mujoco.mjtObj.mjOBJ_BODY): "", int(mujoco.mjtObj.mjOBJ_XBODY): "",
    int(mujoco.mjtObj.mjOBJ_SITE): "site", int(mujoco.mjtObj.mjOBJ_GEOM): "geom",
}  # fmt: skip
_ON_JOINTS = (int(mujoco.mjtTrn.mjTRN_JOINT), int(mujoco.mjtTrn.mjTRN_JOINTINPARENT))


@dataclass(frozen=True)
class _Base:
    """A free joint of a compiled model."""

    name: str  # of the joint, or of its body
    words: frozenset[str]  # names that may stand under [columns] with seven columns
    body: int  # its number


def base_poses(model: mujoco.MjModel, file: RobotFile) -> tuple[Pose, ...]:
    """Returns the poses of free joints that a robot's file says to be measured.

    Raises:
        InputError: columns are given in a list for what has no pose, or one of position and
            orientation is missing, or there are not as many columns as numbers.
    """
    bases = _bases(model)
    found, used = [], set()
    for base in bases:
        word = next((w for w in base.words if w in file.poses), None)
        if word is not None:
            found.append(Pose(base.name, _counted(file, word, 7)))
            used.add(word)
            continue
        frames = {
            width: (name, offset)
            for width, name, offset in _frames(model, base)
            if name in (*file.poses, *file.outputs)
        }
        if not frames:
            continue
        if len(frames) < 2:
            (width, (name, _)) = next(iter(frames.items()))
            raise InputError(
                f"{file.path} has the sensor {name!r} of {base.name!r} alone, and a pose is a"
                f" position and an orientation; name a"
                f" {'framequat' if width == 3 else 'framepos'} sensor too, or write"
                f" {base.name} = [seven columns x, y, z, w, x, y, z] under [columns]"
            )
        columns: list[str] = []
        for width in (3, 4):
            name = frames[width][0]
            used.add(name)
            given = name in file.poses
            columns += _counted(file, name, width) if given else names_of(name, width)
        found.append(Pose(base.name, tuple(columns), *frames[3][1][:1], *frames[4][1][1:]))
    stray = [name for name in file.poses if name not in used]
    if stray:
        good = listed(f"{b.name} (7)" for b in bases) if bases else "none"
        raise InputError(
            f"columns.{stray[0]} in {file.path} is a list of columns, which only a free joint has,"
            f" or its framepos (3) and framequat (4) sensors; free joints of the model: {good}"
        )
    return tuple(found)


def pose_names(model: mujoco.MjModel, sensor: str) -> tuple[str, ...]:
    """Returns the six positions that a framepos or framequat sensor of a base tells, or none."""
    k = int(model.sensor(sensor).id)
    owner = _owner(model, k)
    if owner is None:
        return ()
    first, count = int(model.body_jntadr[owner]), int(model.body_jntnum[owner])
    names = tuple(model.joint(first + i).name for i in range(count))
    stems = {n.removesuffix(f"_{axis}") for n, axis in zip(names, AXES, strict=False)}
    return names if count == len(AXES) and len(stems) == 1 else ()


def with_measured_base(spec: mujoco.MjSpec, file: RobotFile) -> tuple[str, ...]:
    """Put slides and hinges with sensors in the place of measured free joints; say so of each base.

    Raises:
        InputError: an actuator acts on the free joint itself.
    """
    if not any(joint.type == _FREE for joint in spec.joints):
        if file.poses:
            base_poses(spec.copy().compile(), file)  # which refuses them
        return ()
    model = with_free_joints(spec)
    said = []
    for pose in base_poses(model, file):
        number = next(b.body for b in _bases(model) if b.name == pose.name)
        joint = next(j for j in spec.joints
                     if j.type == _FREE and (j.name or j.parent.name) == pose.name)  # fmt: skip
        for k in range(model.nu):
            if int(model.actuator_trntype[k]) in _ON_JOINTS and int(
                model.actuator_trnid[k, 0]
            ) == int(model.body_jntadr[number]):
                raise InputError(
                    f"the actuator {model.actuator(k).name!r} acts on the free joint"
                    f" {pose.name!r}, which is measured and becomes slides and hinges; let it act"
                    " on a site of that body: site = NAME in place of joint, with the same gear"
                )
        _replace(spec, joint, pose.name, model.body_pos[number], model.body_quat[number])
        said.append(
            f"The pose of {pose.name} is measured by {listed(pose.columns)}: its free joint became"
            f" slides and hinges {listed(pose.names)}, with R = R_z(yaw) R_y(pitch) R_x(roll)."
        )
    if said:
        for key in [*spec.keys]:  # their positions are of the free joint; a keyframe is no start
            spec.delete(key)
    return tuple(said)


def with_free_joints(spec: mujoco.MjSpec) -> mujoco.MjModel:
    """Returns the model whose bodies with free joints have the frames that its file gives them."""
    spec = spec.copy()
    spec.compiler.alignfree = False
    for joint in spec.joints:
        joint.align = mujoco.mjtAlignFree.mjALIGNFREE_FALSE
    return spec.compile()


def _replace(
    spec: mujoco.MjSpec, joint: mujoco.MjsJoint, name: str, p: np.ndarray, q: np.ndarray
) -> None:
    """Puts slides and hinges in the place of a free joint, whose body begins at p and q."""
    body = joint.parent
    given = {
        "damping": joint.damping, "armature": joint.armature, "frictionloss": joint.frictionloss
    }  # fmt: skip
    spec.delete(joint)
    R = np.zeros(9)
    mujoco.mju_quat2Mat(R, q)
    (yaw, pitch, roll) = angles(np.array([q]))[0]
    to_body = R.reshape(3, 3).T
    pitch_axis = np.array((0.0, np.cos(roll), -np.sin(roll)))
    hinges = (to_body[:, 2], pitch_axis, np.array((1.0, 0.0, 0.0)))
    unit = 180 / np.pi if spec.compiler.degree else 1.0
    slide, hinge = mujoco.mjtJoint.mjJNT_SLIDE, mujoco.mjtJoint.mjJNT_HINGE
    each = [(slide, to_body[:, k], float(p[k])) for k in range(3)]
    each += [(hinge, a, unit * r) for a, r in zip(hinges, (yaw, pitch, roll), strict=True)]
    for suffix, (kind, axis, ref) in zip(AXES, each, strict=True):
        added = body.add_joint(
            name=f"{name}_{suffix}", type=kind, axis=axis, ref=ref, pos=(0, 0, 0)
        )
        added.limited = mujoco.mjtLimited.mjLIMITED_FALSE
        added.actfrclimited = mujoco.mjtLimited.mjLIMITED_FALSE
        added.stiffness = 0 * added.stiffness
        added.springref = ref
        for attribute, value in given.items():
            setattr(added, attribute, value)
        add_position(spec, f"{name}_{suffix}", f"{name}_{suffix}")


def _counted(file: RobotFile, name: str, width: int) -> tuple[str, ...]:
    """Returns the columns under a name; refuses another number of them."""
    columns = file.poses[name]
    if len(columns) != width:
        raise InputError(
            f"columns.{name} in {file.path} has {len(columns)} columns, and it has {width} numbers:"
            f" {'x, y, z' * (width != 4)}{', ' * (width == 7)}{'w, x, y, z' * (width > 3)}"
        )
    return columns


def _bases(model: mujoco.MjModel) -> list[_Base]:
    """Returns the free joints of a model that have a name, or whose body has one."""
    out = []
    for j in np.flatnonzero(model.jnt_type == _FREE):
        body = int(model.jnt_bodyid[j])
        words = [w for w in (model.joint(int(j)).name, model.body(body).name) if w]
        if words:
            out.append(_Base(words[0], frozenset(words), body))
    return out


def _owner(model: mujoco.MjModel, k: int) -> int | None:
    """Returns the body whose place or orientation in the world sensor k measures; None if none."""
    kind, at = int(model.sensor_objtype[k]), int(model.sensor_objid[k])
    if int(model.sensor_type[k]) not in _KINDS or int(model.sensor_refid[k]) >= 0:
        return None
    if kind not in _OBJECTS:
        return None
    word = _OBJECTS[kind]
    return int(getattr(model, f"{word}_bodyid")[at]) if word else at


def _frames(
    model: mujoco.MjModel, base: _Base
) -> list[tuple[int, str, tuple[tuple[float, ...], tuple[float, ...]]]]:
    """Returns the framepos and framequat sensors on a base: width, name, and frame in the body."""
    out = []
    for k in np.flatnonzero([_owner(model, k) == base.body for k in range(model.nsensor)]):
        kind, at = int(model.sensor_objtype[k]), int(model.sensor_objid[k])
        frame: tuple[np.ndarray, np.ndarray] = (np.zeros(3), np.array([1.0, 0, 0, 0]))
        if word := _OBJECTS[kind]:
            frame = (getattr(model, f"{word}_pos")[at], getattr(model, f"{word}_quat")[at])
        elif kind == int(mujoco.mjtObj.mjOBJ_BODY):
            frame = (model.body_ipos[at], model.body_iquat[at])
        p, q = (tuple(map(float, x)) for x in frame)
        out.append((_KINDS[int(model.sensor_type[k])], str(model.sensor(int(k)).name), (p, q)))
    return out
