"""Models that MuJoCo would read for hours, or with a warning of its own, are refused before.

An MJCF may ask for more than it writes: a `replicate` of a `replicate` multiplies what it holds.
"""

from __future__ import annotations

from xml.etree import ElementTree

import mujoco
import numpy as np

from identification.errors import InputError

MOST = 20_000  # elements, replicated ones counted each; robots have hundreds
STEP = (1e-7, 1.0)  # least and largest timestep [s]
HUGE = 1e50  # of any unit: squares and cubes of it are numbers too
_COUNTS = {"composite": "count", "flexcomp": "count"}
_GRIDS = {"hfield": ("nrow", "ncol"), "texture": ("width", "height")}
_CELLS = 2**26
_FINITE = (
    "body_mass", "body_inertia", "body_ipos", "body_pos", "dof_armature", "dof_damping",
    "dof_frictionloss", "jnt_stiffness", "jnt_pos", "qpos0", "actuator_gear", "actuator_gainprm",
    "actuator_biasprm", "actuator_dynprm",
)  # fmt: skip


def refuse_hostile(raw: str | bytes, where: str) -> None:
    """Refuse a model by its text.

    Args:
        raw: the MJCF.
        where: the model in messages, such as "the model slider.xml".

    Raises:
        InputError: it is no XML, has too many elements, or a value that is no number.
    """
    try:
        root = ElementTree.fromstring(raw)
        names = {str(element.get("name")) for element in root.iter()}
        _refuse_nan(root, names, where)
        count = _count(root, where)
    except (ElementTree.ParseError, ValueError, RecursionError) as error:
        if isinstance(error, InputError):
            raise
        said = "nested too deeply" if isinstance(error, RecursionError) else str(error)
        raise InputError(f"{where} cannot be read ({said}); correct it there") from error
    if count > MOST:
        raise InputError(
            f"{where} has {count:.3g} elements when all that repeat are counted, more than {MOST};"
            " lower the counts of replicate, composite and flexcomp"
        )


def refuse_numbers(model: mujoco.MjModel, where: str) -> None:
    """Refuse a compiled model that cannot be simulated for its numbers.

    Raises:
        InputError: its timestep [s] is none, or a number of its dynamics is infinite or huge.
    """
    (least, most), step = STEP, model.opt.timestep
    if not least <= step <= most:
        raise InputError(
            f"{where} has the timestep {step:g} s; give <option timestep> a number from {least:g}"
            f" to {most:g}"
        )
    numbers = {field: getattr(model, field) for field in _FINITE}
    numbers["gravity"] = model.opt.gravity
    for field, values in numbers.items():
        if not np.isfinite(values).all():
            raise InputError(f"{where} has an infinite number in {field}; write a finite one")
        if values.size and np.abs(values).max() > HUGE:
            raise InputError(
                f"{where} has {values.flat[np.abs(values).argmax()]:g} in {field}, which no robot"
                f" has; write a number up to {HUGE:g}"
            )


def _refuse_nan(root: ElementTree.Element, names: set[str], where: str) -> None:
    for element in root.iter():
        for name, value in element.items():
            if "nan" in value.lower().split() and value not in names:
                raise InputError(
                    f"{where} has {name}={value!r} in <{element.tag}>; write numbers there"
                )


def _count(element: ElementTree.Element, where: str) -> float:
    """How many elements one becomes, its parts among them."""
    sides = " ".join(element.get(name, "1") for name in _GRIDS.get(element.tag, ()))
    if _product(sides) > _CELLS:
        raise InputError(
            f"{where} has a <{element.tag}> of more than {_CELLS} cells; make it smaller"
        )
    times = _product(element.get(_COUNTS.get(element.tag, ""), "1"))
    if element.tag == "replicate":
        times = _product(element.get("count", "1"))
    return max(1.0, times) * (1 + sum(_count(part, where) for part in element))


def _product(text: str) -> float:
    """The product of the numbers of an attribute; 1 where they are none, which MuJoCo tells."""
    out = 1.0
    for word in text.split():
        try:
            out *= max(1.0, float(word))
        except ValueError:
            return 1.0
    return out
