"""What a model only shows is left out of the one that is simulated: meshes, textures and skins.

A search copies its model thousands of times, once for each set of values, and a model with meshes
and textures has some ten megabytes of which no equation of motion reads one. A mesh that nothing
touches becomes a small sphere where it was, so that all geoms keep their names, numbers and places,
and each body keeps the inertia that its meshes gave it.
"""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np

from identification.model.missing_files import acting_shape

SMALL = 1e-3  # radius of the spheres [m]
_MESH = mujoco.mjtGeom.mjGEOM_MESH


def without_looks(spec: mujoco.MjSpec, model: mujoco.MjModel) -> mujoco.MjSpec:
    """Returns a model without meshes, textures and skins that only show, with the same motion.

    Args:
        spec: of the model, which stays as it is.
        model: the same, compiled.
    """
    if not (model.nmesh or model.ntex or model.nskin):
        return spec
    spec = spec.copy()
    shown = [
        geom for geom in spec.geoms
        if geom.type == _MESH and geom.meshname and acting_shape(spec, geom) is None
    ]  # fmt: skip
    if shown:
        for body in spec.bodies:
            if body.name != "world" and model.body_mass[body.id] > 0:
                fix_inertia(body, model, body.id)
        spec.compiler.inertiafromgeom = mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_AUTO
    for geom in shown:
        row = geom.id
        geom.type, geom.meshname, geom.mass = mujoco.mjtGeom.mjGEOM_SPHERE, "", 0.0
        geom.size = [SMALL, 0.0, 0.0]
        geom.pos, geom.quat = model.geom_pos[row], model.geom_quat[row]
        geom.alt.type = mujoco.mjtOrientation.mjORIENTATION_QUAT
    for material in spec.materials:
        material.textures = [""] * len(material.textures)
    used = {geom.meshname for geom in spec.geoms}
    unused = [mesh for mesh in spec.meshes if mesh.name not in used]
    for part in (*spec.textures, *spec.skins, *unused):
        spec.delete(part)
    return spec


def fix_inertia(body: Any, model: mujoco.MjModel, row: int) -> None:
    """Gives a body of a spec the mass and inertia of a compiled model, whatever its geoms say."""
    body.explicitinertial = True
    body.fullinertia[0] = np.nan
    body.mass, body.ipos = float(model.body_mass[row]), model.body_ipos[row]
    body.iquat, body.inertia = model.body_iquat[row], model.body_inertia[row]
