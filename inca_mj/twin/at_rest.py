"""The change of the start by candidate effects: the cables' paths, the load, the elasticity.

The usual start is that of the nominal model, with the true lengths of the cables: T(0) holds the
nominal robot, the drum springs balance T(0), and d₀(0) = λ d/(λ + T(0)). The effects act from then
on, as on a robot that was held before. A `settled` robot has stood by itself for a while with its
effects: T(0) takes into account how they change the cables' paths and the platform's load, the drum
springs balance T(0) at the true radius of the roller, and d₀(0) follows from the law of the cable:

    T(0) = λ ε + ΔT(ε)        solved for ε by secant steps
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from identification.effects.effect import Effect
from inca_mj.effects.hooks import DRIVE, PLATFORM, Drive, Layout, Platform
from inca_mj.effects.values import drive_values, present
from inca_mj.kinematics.rotations import rotation
from inca_mj.robot.geometry import DRIVES, Geometry
from inca_mj.robot.spread import at_drives

SECANTS = 12  # more than enough, because secant steps converge faster than linearly
UNKNOWN = dict.fromkeys(Drive._fields, np.nan)


@dataclass(frozen=True, kw_only=True)
class Change:
    """The change of the robot at rest by the effects that are present."""

    longer: np.ndarray  # Δd of each cable, shape (8,) [m]
    turned: np.ndarray  # ∂Δd/∂r of each cable, in O, shape (8, 3)
    # what is added to the wrench that the cables carry, in O, about the platform's frame, shape
    # (6,) [N, N m]
    load: np.ndarray
    wider: np.ndarray  # ΔR of each roller, shape (8,) [m]
    d: np.ndarray  # length of each cable, shape (8,) [m]
    values: Mapping[str, float]  # of all parameters, in SI units
    stiffening: tuple[Effect, ...]  # effects that add to the tension

    def strain(self, T: np.ndarray) -> np.ndarray:
        """Returns ε(0) at tensions T, shape (8,)."""
        lambda_ = at_drives("lambda", self.values)
        strain, last, error = T / lambda_, np.zeros(DRIVES), -T
        for _ in range(SECANTS if self.stiffening else 0):
            wrong = lambda_ * strain + self._added(strain) - T
            moved = (strain != last) & (wrong != error)
            slope = np.divide(wrong - error, strain - last, where=moved, out=lambda_.copy())
            last, error, strain = strain, wrong, strain - wrong / slope
        return strain

    def _added(self, strain: np.ndarray) -> np.ndarray:
        out = np.zeros(DRIVES)
        R, lambda_, b = (at_drives(name, self.values) for name in ("R", "lambda", "b"))
        for effect in self.stiffening:
            p = drive_values(effect, self.values)
            for k in range(DRIVES):
                x = _started(effect, strain[k], tuple(p[:, k]))
                s = _drive(time=0.0, strain=strain[k], strain_rate=0.0, omega=0.0, x=x,
                           d=self.d[k], d_0=self.d[k] / (1 + strain[k]),
                           R=R[k], lambda_=lambda_[k], b=b[k])  # fmt: skip
                out[k] += _evaluate(effect, "tension", s, p[:, k])
        return out


def change_at_rest(
    values: Mapping[str, float], pose: np.ndarray, geometry: Geometry, layout: Layout
) -> Change | None:
    """Returns the change by effects present in `values`; None if nothing changes.

    `geometry` has its connectors relative to the centre of mass, whose pose is given. All values
    are in SI units.
    """
    acting = [e for e in layout.effects if _touches(e, layout.settled) and present(e, values)]
    if not acting:
        return None
    R = rotation(*pose[3:])
    r = pose[:3] + geometry.B @ R.T - geometry.A
    way, load, wider = np.zeros((DRIVES, 4)), np.zeros(6), np.zeros(DRIVES)
    radius = at_drives("R", values)
    for effect in acting:
        p = drive_values(effect, values)
        for k in range(DRIVES):
            s = _drive(rx=r[k, 0], ry=r[k, 1], rz=r[k, 2], d=float(np.linalg.norm(r[k])),
                       phi=0.0, omega=0.0, x=0.0, R=radius[k])  # fmt: skip
            if "path" in effect.hooks:
                way[k] += _evaluate(effect, "path", s, p[:, k])
            if "force" in effect.hooks:
                F = np.array(_evaluate(effect, "force", s, p[:, k]))
                load -= np.concatenate([F, np.cross(geometry.B[k] @ R.T, F)])
            if "radius" in effect.hooks:
                wider[k] += _evaluate(effect, "radius", s, p[:, k])
        if "wrench" in effect.hooks:
            still = Platform(0.0, *pose[:3], *np.zeros(6), *R.ravel())
            load -= np.array(_evaluate(effect, "wrench", still, p[:, 0]))
    d = np.linalg.norm(r, axis=1) + way[:, 0]
    at_rest = layout.settled
    return Change(
        longer=way[:, 0],
        turned=at_rest * way[:, 1:],
        load=at_rest * load,
        wider=wider if at_rest else np.zeros(DRIVES),
        d=d,
        values=values,
        stiffening=tuple(e for e in acting if "tension" in e.hooks) if at_rest else (),
    )


def _evaluate(effect: Effect, hook: str, s: Drive | Platform, p: np.ndarray) -> Any:
    """Returns what a hook of an effect adds; NaN where its law has no value."""
    law: Any = effect.hooks[hook]
    try:
        return law.py_func(s, tuple(p.tolist()))
    except (ValueError, ZeroDivisionError, OverflowError):  # compiled laws give NaN or infinity
        element = PLATFORM if hook == "wrench" else DRIVE
        return np.nan * np.asarray(element.hook(hook).zero)


def own_states(values: Mapping[str, float], strain: np.ndarray, layout: Layout) -> np.ndarray:
    """Returns the states of the effects at the start, shape (8, states), at strains ε(0)."""
    by_name = {effect.name: effect for effect in layout.effects}
    out = np.zeros((DRIVES, layout.states - 1))
    for term in layout.on_drives:
        effect = by_name[term.effect]
        if "start" not in effect.hooks:
            continue
        p = drive_values(effect, values)
        for k in range(DRIVES):
            out[k, term.state - 1] = _started(effect, strain[k], tuple(p[:, k]))
    return out


def _started(effect: Effect, strain: float, p: tuple[float, ...]) -> float:
    """Returns an effect's own state at the start of one drive; zero where it says nothing."""
    start: Any = effect.hooks.get("start")
    return 0.0 if start is None else float(start.py_func(_drive(strain=strain, x=0.0), p))


def _drive(**known: float) -> Any:
    return Drive(**{**UNKNOWN, **known})


def _touches(effect: Effect, settled: bool) -> bool:
    """Returns whether an effect can change anything at rest."""
    more = {"force", "tension", "wrench", "radius"} & effect.hooks.keys()
    return "path" in effect.hooks or (settled and bool(more))
