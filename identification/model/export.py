"""MJCF text that holds every number to the last bit.

MuJoCo's writer prints six digits and rounds numbers below 1e-12 to zero, so that such a file does
not give back the model that was saved. Here the text is written by MuJoCo, and its numbers are
replaced by those of the spec.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import mujoco
import numpy as np

from identification.storage.files import write_text

# MJCF attribute -> attribute of the MjSpec element, for the elements a parameter may reach
_EXACT = {
    "body": {"pos": "pos", "quat": "quat"},
    "inertial": {"mass": "mass", "pos": "ipos", "quat": "iquat", "diaginertia": "inertia"},
    "joint": {n: n for n in ("armature", "axis", "pos", "ref", "range", "springref")}
    | {"solreffriction": "solref_friction"},
    "site": {"pos": "pos", "quat": "quat"},
    "spatial": {"user": "userdata"} | {n: n for n in ("range", "armature", "springlength")},
    "fixed": {"user": "userdata"} | {n: n for n in ("range", "armature", "springlength")},
    "general": {n: n for n in ("gear", "gainprm", "biasprm", "dynprm", "ctrlrange", "forcerange")}
    | {"user": "userdata"},
    "key": {n: n for n in ("qpos", "qvel", "act", "ctrl")},
}
_TENDON = ("damping", "stiffness")
_SCALARS = {"joint": (*_TENDON, "frictionloss"), "spatial": _TENDON, "fixed": _TENDON}


def to_xml(spec: mujoco.MjSpec) -> str:
    """Returns the MJCF of a spec with exact numbers: its text compiles to the model of the spec.

    The spec's comment stands at its head, so that a file that is saved again keeps it.
    """
    spec.compile()
    keep = ElementTree.XMLParser(target=ElementTree.TreeBuilder(insert_comments=True))
    root = ElementTree.fromstring(spec.to_xml(), keep)
    _settle(root.find("option"), spec.option, {"timestep": "timestep", "gravity": "gravity"})
    for tag, element, found in _elements(root, spec):
        _settle(element, found, _EXACT[tag])
        _settle(element, found, {name: name for name in _SCALARS.get(tag, ())})
        if tag in ("spatial", "fixed") and found.springlength[0] < 0:
            element.attrib.pop("springlength", None)  # taken from qpos0 at compilation
        if tag == "fixed":
            for part, wrapped in zip(element.findall("joint"), found.path, strict=True):
                part.set("coef", _join([wrapped.coef]))
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode") + "\n"


def write_xml(spec: mujoco.MjSpec, path: str | Path) -> Path:
    """Write `to_xml(spec)` to a file, whole or not at all; returns its path."""
    return write_text(path, to_xml(spec))


def _elements(root: Any, spec: mujoco.MjSpec) -> Iterator[tuple[str, Any, Any]]:
    """Yields named elements of the text, each with its counterpart in the spec."""
    for tag, finder in (
        ("body", spec.body),
        ("joint", spec.joint),
        ("site", spec.site),
        ("spatial", spec.tendon),
        ("fixed", spec.tendon),
        ("general", spec.actuator),
        ("key", spec.key),
    ):
        for element in root.iter(tag):
            found = finder(element.get("name")) if element.get("name") else None
            if found is None:
                continue
            yield tag, element, found
            inertial = element.find("inertial") if tag == "body" else None
            if inertial is not None:
                yield "inertial", inertial, found


def _settle(element: Any, source: Any, names: dict[str, str]) -> None:
    """Replace the numbers of an element's attributes by the source's, at full precision."""
    if element is None:
        return
    for attribute, field in names.items():
        text = element.get(attribute)
        if text is None:
            continue
        exact = np.atleast_1d(np.asarray(getattr(source, field), float)).ravel()
        element.set(attribute, _join(exact[: len(text.split())]))


def _join(numbers: Iterable[float]) -> str:
    return " ".join(np.format_float_positional(x, trim="-") if 1e-4 <= abs(x) < 1e6 or x == 0
                    else repr(float(x)) for x in numbers)  # fmt: skip
