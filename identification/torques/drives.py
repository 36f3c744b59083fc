"""Joints without a drive, and the forces that the model's masses need for the measured motion."""

from __future__ import annotations

import mujoco
import numpy as np

from identification.torques.base import all_columns
from identification.torques.bodies import read_numbers
from identification.torques.equations import Equations
from identification.torques.smoothing import ATTENUATION


def known_numbers(model: mujoco.MjModel) -> np.ndarray:
    """Returns a model's numbers of bodies and armatures, as `all_columns` has them."""
    return np.concatenate([read_numbers(model).ravel(), model.dof_armature])


def list_passive(model: mujoco.MjModel, equations: Equations) -> np.ndarray:
    """Returns which joints have no drive, or none that gives more than noise, shape (nv,).

    As much noise as a band leaves in accelerations hides a force of this share of the inertia's.
    """
    used = equations.stacked("used")
    force = np.where(used, equations.stacked("drives").sum(axis=2), 0.0)
    needed = np.where(used, model_forces(model, equations), 0.0)
    given, felt = ((x**2).sum(axis=0) for x in (force, needed))
    return np.asarray(used.any(axis=0) & (given <= ATTENUATION * felt))


def model_forces(model: mujoco.MjModel, equations: Equations) -> np.ndarray:
    """Returns the forces that the model's masses alone need for the motion, shape (N, nv)."""
    X = all_columns(equations.stacked("bodies"), equations.stacked("a"))
    return np.asarray(X @ known_numbers(model))
