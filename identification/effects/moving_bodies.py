"""The bodies of a model that move and have a mass, and what of their inertia is felt."""

from __future__ import annotations

import copy
import math
from dataclasses import dataclass

import mujoco
import numpy as np

from identification.runtime.engine import derive, quiet

POSES = 4  # random states in which forces are compared
FELT = 1e-9  # of the largest force: a smaller change of it is round-off
STEP = 0.1  # of a number of a body, relative to its size


@dataclass(frozen=True, kw_only=True)
class MovingBody:
    """A body that joints move."""

    label: str  # its name, or that of its first joint where it has none
    index: int  # in the model
    mass: float  # [kg]
    # where a payload would sit, in its frame: its farthest site, else the farthest end of its geoms
    # (of a capsule, cylinder or box; of others the centre), else twice as far as its centre of
    # mass, where a uniform link ends, shape (3,) [m]
    point: tuple[float, float, float]
    reach: float  # distance of the farthest site or centre of a geom from its frame [m]
    is_last: bool  # whether it carries no other moving body


def movable(spec: mujoco.MjSpec) -> mujoco.MjModel:
    """Returns the compiled model whose bodies may be given another centre of mass and other axes.

    MuJoCo simplifies a body whose inertial frame is its own frame; here it may not, and computes
    the same numbers the longer way.
    """
    spec = spec.copy()
    for body in spec.bodies:
        if body.name != "world" and hasattr(body, "simple"):  # MuJoCo 3.17 has it
            body.simple = False
    model = spec.compile()
    model.body_sameframe[:] = 0
    return model


@np.errstate(over="ignore", invalid="ignore")  # a geom of 1e308 m, which a damaged file may have
def moving_bodies(model: mujoco.MjModel) -> tuple[MovingBody, ...]:
    """Returns the bodies with a name that move and have mass, in the model's order."""
    moving = [b for b in range(model.nbody) if model.body_weldid[b] and model.body_mass[b] > 0]
    carrying = {int(model.body_weldid[model.body_parentid[int(model.body_weldid[b])]])
                for b in moving}  # fmt: skip
    out = []
    for b in moving:
        if not (label := _label(model, b)):
            continue
        points = _points(model, b) or [2 * model.body_ipos[b]]
        # The squares of a length of 1e200 m, which a damaged file may have, exceed all floats.
        reach = max(math.hypot(*p) for p in (*points, model.body_ipos[b]))
        far = max(_ends(model, b) or points, key=lambda p: math.hypot(*p))
        out.append(
            MovingBody(
                label=label, index=b, mass=float(model.body_mass[b]), reach=reach,
                point=(float(far[0]), float(far[1]), float(far[2])),
                is_last=int(model.body_weldid[b]) not in carrying,
            )
        )  # fmt: skip
    return tuple(out)


class Felt:
    """The inertia of bodies that the forces of inverse dynamics feel, in random states.

    Args:
        model: of `movable`.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self.model, self.states = model, _states(model)
        self.nominal = _forces(model, self.states)

    def axes(self, body: MovingBody) -> str:
        """Returns the axes of its frame, of "xyz", on which a displaced centre of mass is felt."""
        far = STEP * (body.reach or 1.0)
        return "".join(a for k, a in enumerate("xyz") if self._is("body_ipos", body.index, k, far))

    def is_turning(self, body: MovingBody) -> bool:
        """Returns whether its inertia is felt."""
        return bool(self.inertias(body.index).any())

    def inertias(self, body: int) -> np.ndarray:
        """Returns which of the principal inertias of a body are felt, shape (3,)."""
        more = STEP * (float(self.model.body_inertia[body].max()) or 1.0)
        return np.array([self._is("body_inertia", body, k, more) for k in range(3)])

    def _is(self, field: str, body: int, k: int, more: float) -> bool:
        other = copy.copy(self.model)
        getattr(other, field)[body, k] += more
        derive(other)
        change = np.abs(_forces(other, self.states) - self.nominal).max()
        return bool(change > FELT * max(float(np.abs(self.nominal).max()), 1e-300))


def _label(model: mujoco.MjModel, b: int) -> str:
    """Returns the name of a body, or that of its first joint."""
    name = model.body(b).name
    return name or (model.joint(model.body_jntadr[b]).name if model.body_jntnum[b] else "")


def _points(model: mujoco.MjModel, b: int) -> list[np.ndarray]:
    """Returns the sites of a body, or else the centres of its geoms."""
    for n, of, pos in (
        (model.nsite, model.site_bodyid, model.site_pos),
        (model.ngeom, model.geom_bodyid, model.geom_pos),
    ):
        places = [np.array(pos[i]) for i in range(n) if of[i] == b]
        if any(p.any() for p in places):
            return places
    return []


def _ends(model: mujoco.MjModel, b: int) -> list[np.ndarray]:
    """Returns the ends of the geoms of a body that has no site away from its frame."""
    sites = [model.site_pos[i] for i in range(model.nsite) if model.site_bodyid[i] == b]
    if any(p.any() for p in sites):
        return []
    return [
        model.geom_pos[i] + sign * half
        for i in range(model.ngeom) if model.geom_bodyid[i] == b
        for half in _half_axes(model, i) for sign in (-1, 1)
    ]  # fmt: skip


def _half_axes(model: mujoco.MjModel, i: int) -> list[np.ndarray]:
    """Returns vectors from a geom's centre to the middle of its ends, in the body's frame [m]."""
    R = np.zeros(9)
    mujoco.mju_quat2Mat(R, model.geom_quat[i])
    kind, size, axes = mujoco.mjtGeom(model.geom_type[i]), model.geom_size[i], R.reshape(3, 3).T
    if kind in (mujoco.mjtGeom.mjGEOM_CAPSULE, mujoco.mjtGeom.mjGEOM_CYLINDER):
        return [size[1] * axes[2]]
    if kind == mujoco.mjtGeom.mjGEOM_BOX:
        return [half * axis for half, axis in zip(size, axes, strict=True)]
    return [np.zeros(3)]


def _states(model: mujoco.MjModel) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Returns random positions, velocities and accelerations."""
    rng, out = np.random.default_rng(0), []
    for _ in range(POSES):
        qpos = np.array(model.qpos0)
        mujoco.mj_integratePos(model, qpos, rng.normal(0, 1, model.nv), 1.0)
        out.append((qpos, rng.normal(0, 1, model.nv), rng.normal(0, 1, model.nv)))
    return out


@quiet()
def _forces(
    model: mujoco.MjModel, states: list[tuple[np.ndarray, np.ndarray, np.ndarray]]
) -> np.ndarray:
    """Returns the forces M v̇ + c of inverse dynamics, shape (states, nv)."""
    data, out = mujoco.MjData(model), []
    for qpos, qvel, qacc in states:
        data.qpos, data.qvel = qpos, qvel
        mujoco.mj_forward(model, data)
        moved = np.zeros(model.nv)
        mujoco.mj_mulM(model, data, moved, qacc)
        out.append(moved + data.qfrc_bias)
    return np.array(out)
