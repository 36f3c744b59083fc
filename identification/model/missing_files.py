"""A model of which files are missing: what only shows is left out, and what moves is asked for.

A model file is often passed on without its meshes and textures. A shape matters to the dynamics
where

    the inertia of a body is computed from it       the body moves and has no <inertial> of its own
    other bodies may touch it                       its contype or conaffinity is not 0
    a <pair> of contacts has it, or a tendon is wound around it
    a fluid acts on it                              fluidshape="ellipsoid"

Nothing else of a mesh enters an equation of motion, and nothing of a texture or a skin does.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any
from warnings import catch_warnings, simplefilter

import mujoco

from identification.errors import InputError
from identification.logs.names import quoted

_NAMED = re.compile(r"opening file '(.+)'")  # MuJoCo's words of a file that is not there
_GEOM = mujoco.mjtObj.mjOBJ_GEOM
_TOLD = 3  # files that are told by name; a model of an arm may lack dozens
_LONGEST = 200  # letters of a path that are told
_ALWAYS = mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_TRUE
_NEVER = mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_FALSE


def compile_without_missing(
    spec: mujoco.MjSpec, where: str, is_asked: bool = True
) -> tuple[mujoco.MjModel, str]:
    """Returns a compiled model, and one sentence on what was left out of it, "" where nothing was.

    Meshes, textures, heightfields and skins whose files are missing are taken out of the spec, with
    the geoms that are made of them. Nothing is unless it is asked: what is left out of a very large
    model would hide from the other process, which compiles it first, how large the rest is.

    Raises:
        InputError: a file is missing on which inertia, contacts, tendons or a fluid depend.
        ValueError: MuJoCo cannot compile the model for another reason.
    """
    files: list[str] = []
    geoms = 0
    while True:
        try:
            with catch_warnings():
                simplefilter("error")
                return spec.compile(), _sentence(files, geoms, where, spec.modelfiledir)
        except ValueError as error:
            named = _NAMED.search(str(error))
            assets = [] if named is None else [*_read_from(spec, named[1])]
            if named is None or not assets or not is_asked:
                raise
        files.append(_short(named[1], spec.modelfiledir))
        for asset in assets:
            geoms += _leave_out(spec, asset, named[1], where)


def _read_from(spec: mujoco.MjSpec, file: str) -> Iterator[Any]:
    """Yields what is read from a file; MuJoCo names it with the folder of meshes or textures."""
    parts = Path(os.path.normpath(file)).parts
    for asset in (*spec.meshes, *spec.textures, *spec.hfields, *spec.skins):
        for name in (asset.file, *getattr(asset, "cubefiles", ())):
            given = tuple(p for p in Path(os.path.normpath(name)).parts if p != os.pardir)
            tail = given[-1:] if spec.strippath else given
            if name and parts[-len(tail) :] == tail:
                yield asset
                break


def _leave_out(spec: mujoco.MjSpec, asset: Any, file: str, where: str) -> int:
    """Takes what a missing file should give out of a model; returns how many geoms went with it."""
    geoms: list[mujoco.MjsGeom] = []
    if isinstance(asset, mujoco.MjsTexture):
        for material in spec.materials:
            material.textures = ["" if t == asset.name else t for t in material.textures]
    elif not isinstance(asset, mujoco.MjsSkin):
        of = "meshname" if isinstance(asset, mujoco.MjsMesh) else "hfieldname"
        geoms = [geom for geom in spec.geoms if getattr(geom, of) == asset.name]
    for geom in geoms:
        _refuse_needed(spec, geom, file, where)
    names = {geom.name for geom in geoms if geom.name}
    watching = [s for s in spec.sensors if s.objtype == _GEOM and s.objname in names]
    for part in (*watching, *geoms, asset):
        spec.delete(part)
    return len(geoms)


def _refuse_needed(spec: mujoco.MjSpec, geom: mujoco.MjsGeom, file: str, where: str) -> None:
    """Refuses a model whose motion depends on the shape of a geom that a missing file gives."""
    needed = _needed(spec, geom)
    if needed:
        raise InputError(
            f"{where} names the file {quoted(file, _LONGEST)}, which is missing, and {needed[0]};"
            f" put the file there, or {needed[1]}"
        )


def _needed(spec: mujoco.MjSpec, geom: mujoco.MjsGeom) -> tuple[str, str] | None:
    """Returns what depends on the shape of a geom, and what else cures that; None for nothing."""
    body = f"body {quoted(geom.parent.name)}"
    if _gives_inertia(spec, geom):
        cure = "give this body an <inertial> with mass, pos and diaginertia"
        if geom.parent.explicitinertial:
            cure = 'write inertiafromgeom="auto" into <compiler>, so that the <inertial> counts'
        return f"the inertia of {body} is computed from it", cure
    return acting_shape(spec, geom)


def acting_shape(spec: mujoco.MjSpec, geom: mujoco.MjsGeom) -> tuple[str, str] | None:
    """Returns what the shape of a geom may act on, and what cures that; None for nothing.

    Its part of the inertia of its body does not count.
    """
    body, option = f"body {quoted(geom.parent.name)}", spec.option
    called = f"geom {quoted(geom.name)} of {body}" if geom.name else f"a geom of {body}"
    touches = not option.disableflags & int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
    if touches and (geom.contype or geom.conaffinity):
        cure = (
            'write contype="0" conaffinity="0" into this geom where nothing touches it'
            ' (<option><flag contact="disable"/></option> switches all contacts off)'
        )
        return f"other bodies may touch {called}, which has its shape", cure
    if geom.name and any(geom.name in (p.geomname1, p.geomname2) for p in spec.pairs):
        return f"a <pair> of contacts names {called}, which has its shape", "delete the <pair>"
    if any(wrap.target == geom for tendon in spec.tendons for wrap in tendon.path):
        return f"a tendon is wound around {called}", "wind it around a geom without a mesh"
    if geom.fluid_ellipsoid and (option.density or option.viscosity):
        return f"a fluid acts on {called}", 'write fluidshape="none" into this geom'
    return None


def _gives_inertia(spec: mujoco.MjSpec, geom: mujoco.MjsGeom) -> bool:
    """Tells whether the inertia of a body that moves is computed from a geom."""
    body, compiler = geom.parent, spec.compiler
    low, high = compiler.inertiagrouprange
    if geom.mass == 0 or not (geom.mass > 0 or geom.density) or not low <= geom.group <= high:
        return False
    rule = compiler.inertiafromgeom
    if rule == _NEVER or (rule != _ALWAYS and body.explicitinertial):
        return False
    # `body.joints` of a body without any tells of the last failed compilation in its place.
    moving = [joint.parent for joint in spec.joints]
    while body is not None and body not in moving:  # what is fixed to a body moves with it
        body = body.parent
    return body is not None


def _short(file: str, folder: str) -> str:
    """Returns a file as a reader of the model knows it; MuJoCo names those of parts in full."""
    return os.path.relpath(file, folder) if folder and os.path.isabs(file) else file


def _sentence(files: list[str], geoms: int, where: str, folder: str) -> str:
    """Returns what was left out of a model in words; "" where nothing was.

    `folder` is that of the model, from which the files are told.
    """
    if not files:
        return ""
    sought = dict.fromkeys(
        os.path.normpath(os.path.join(folder, os.path.dirname(f))) for f in files
    )
    places = _first("the working folder" if p == os.curdir else p for p in sought)
    one = len(files) == 1
    what = "a file that is missing and tells" if one else "files that are missing and tell"
    made = f", with {geoms} geom{'s' * (geoms > 1)} of that shape" if geoms else ""
    return (
        f"{where[0].upper()}{where[1:]} names {what if one else f'{len(files)} {what}'} only its"
        f" look, {_first(files)} (looked for in {places}); {'it was' if one else 'they were'} left"
        f" out{made}."
    )


def _first(files: Iterable[str]) -> str:
    """Returns the first files or folders for a message, and how many more there are."""
    every = [quoted(file, _LONGEST) for file in files]
    more = f" and {len(every) - _TOLD} more" if len(every) > _TOLD else ""
    return ", ".join(every[:_TOLD]) + more
