"""The model of a robot as one MJCF with the values that were found, for any program of MuJoCo.

What a fit changes in a model stands in the file: masses and inertias, those of named effects too,
dampings, armatures, gains of servos, and more (`FIELDS`). What acts beside the model does not:
effects on joints, inputs and sensors are functions that MuJoCo calls, and values of a start belong
to a log. The comment at the head of the file names them. MuJoCo writes numbers with six digits.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import mujoco
import numpy as np

from identification.effects.effect import Effect
from identification.effects.laws.bodies import BODY
from identification.effects.laws.rotors import ROTOR
from identification.model.looks import fix_inertia
from identification.model.plant import start_place
from identification.robot.robot import Robot
from identification.storage.files import write_text

# Array of the compiled model: the list of a spec's elements, what counts them, and their attribute.
FIELDS = {
    **{f"body_{name}": ("bodies", "", name) for name in ("mass", "ipos", "iquat", "inertia")},
    **{f"dof_{name}": ("joints", "jnt_dofadr", name)
       for name in ("damping", "armature", "frictionloss")},
    "jnt_stiffness": ("joints", "", "stiffness"), "jnt_range": ("joints", "", "range"),
    "qpos_spring": ("joints", "jnt_qposadr", "springref"),
    **{f"actuator_{name}": ("actuators", "", name)
       for name in ("gainprm", "biasprm", "dynprm", "gear", "ctrlrange", "forcerange")},
    **{f"tendon_{name}": ("tendons", "", name)
       for name in ("stiffness", "damping", "frictionloss")},
}  # fmt: skip
ANGLES = ("jnt_range", "qpos_spring")  # of hinges in the unit of the spec's file
_HINGE = int(mujoco.mjtJoint.mjJNT_HINGE)
_CARRIED = {hook.name for element in (BODY, ROTOR) for hook in element.hooks}


def write_mjcf(
    robot: Robot, values: Mapping[str, float], path: Path, place: Path, remark: str = "",
    limits: Mapping[str, float] | None = None,
) -> Path:  # fmt: skip
    """Write the model of a robot with new values as one MJCF, with its steps and its sensors.

    Args:
        robot: the robot that was fitted.
        values: values of its free parameters and of the effects that it now has, by name.
        path: path of the file to write.
        place: the folder from which the file will be read, from which it names meshes.
        remark: one line about the values that stands at its head.
        limits: of the forces of some actuators, by name, in their units; None for no others than
            those of the model.
    """
    plant, spec = robot.plant.with_values(values), robot.plant.spec.copy()
    base, model = spec.compile(), plant.model
    for field, (kind, at, attribute) in FIELDS.items():
        before, after = getattr(base, field), getattr(model, field)
        for thing in getattr(spec, kind):
            row = int(getattr(base, at)[thing.id]) if at else int(thing.id)
            if row < 0 or np.array_equal(before[row], after[row]):
                continue
            number = after[row]
            if field in ANGLES and spec.compiler.degree and base.jnt_type[thing.id] == _HINGE:
                number = np.rad2deg(number)
            if kind == "bodies":
                fix_inertia(thing, model, row)
            else:
                _put(thing, attribute, number)
    for name, most in (limits or {}).items():
        actuator = spec.actuator(name)
        actuator.forcelimited, actuator.forcerange = True, [-most, most]
    spec.option.gravity = model.opt.gravity
    root = ElementTree.fromstring(spec.to_xml())
    for folder in ("meshdir", "texturedir"):
        _find_from(place, root, spec, folder)
    left = _beside(plant.effects, {**robot.file.fixed, **values}, model)
    said = filter(None, (
        f"{robot.file.model.name} with the values of robot.toml.", remark,
        f"MJCF has no place for {', '.join(left)}." if left else "",
    ))  # fmt: skip
    root.insert(0, ElementTree.Comment(" ".join(said).replace("--", "- -")))
    ElementTree.indent(root)
    return write_text(path, ElementTree.tostring(root, encoding="unicode") + "\n")


def _put(thing: Any, attribute: str, number: Any) -> None:
    old = getattr(thing, attribute)
    if np.ndim(old):
        new = np.atleast_1d(number)
        old[: len(new)] = new
    else:
        setattr(thing, attribute, float(number))


def _find_from(
    place: Path, root: ElementTree.Element, spec: mujoco.MjSpec, folder: str
) -> None:  # fmt: skip
    """Lets a folder of assets be found from the place of the new file."""
    compiler = root.find("compiler")
    if compiler is not None and any((spec.meshes, spec.textures, spec.hfields, spec.skins)):
        at = Path(spec.modelfiledir) / getattr(spec, folder)
        compiler.set(folder, os.path.relpath(at, place))


def _beside(
    effects: Sequence[Effect], values: Mapping[str, float], model: mujoco.MjModel
) -> list[str]:
    """Returns the values, with their numbers, of which nothing stands in a model."""
    sizes = {n for e in effects if not _CARRIED & {*e.hooks} for n in _names(e)}
    return [
        f"{name} = {value:.6g}"
        for name, value in values.items()
        if (name.partition("@")[0] in sizes and value) or start_place(name, model) is not None
    ]


def _names(effect: Effect) -> list[str]:
    names = [*(size.name for size in effect.sizes), *(shape.name for shape in effect.shapes)]
    return [f"{effect.name}.{name}" for name in names]
