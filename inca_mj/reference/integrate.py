"""Simulate the reference: currents in, a sampled trajectory out, by DOP853.

Currents are a zero-order hold: row k applies from t_k to t_{k+1}, so the last row applies to
nothing.

Tolerances. A cable turns an error of length into tension with λ/d₀ ≈ 1.4e4 N/m, so
a relative 1e-11 of 2 m of cable is 3e-7 N in the worst case. Measured over 10 s of PRBS against
1e-13: angles right to 1e-11 rad, tensions to 3e-10 N, four digits below the 1e-7 rad to which the
twin is compared, in 2 to 3 s. Tighter costs much (ten times at 1e-13): with strains of 1e-4 the
rounding of (d − d₀)/d₀ is seen as an error. 1e-9 halves the time and keeps 2e-11 rad, as most
steps are bounded by stability (the stiff, damped rotation of the platform), not by accuracy.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import degrees

import numpy as np
from scipy.integrate import DOP853

from identification.errors import DivergenceError, InputError
from identification.model.parameter import ParameterSet
from inca_mj.reference import layout as at
from inca_mj.reference.equations import cables, derivative
from inca_mj.reference.numbers import NO_FORCE, pack, rest
from inca_mj.robot.geometry import Geometry

RTOL = 1e-11  # relative tolerance
ATOL = 1e-12  # absolute tolerance, in the unit of each state
SINGULAR = np.radians(89.0)  # largest pitch [rad]: Euler rates are up to 57 times ω there


@dataclass(frozen=True)
class ReferenceRun:
    """A trajectory of the reference, sampled; its arrays are read-only."""

    time: np.ndarray  # sample times, shape (n,) [s]
    state: np.ndarray  # the 36 states in the order of `layout`, shape (n, 36)
    tension: np.ndarray  # cable tensions, shape (n, 8) [N]

    def __post_init__(self) -> None:
        for array in (self.time, self.state, self.tension):
            array.setflags(write=False)

    @property
    def position(self) -> np.ndarray:
        """Position of the platform in O, shape (n, 3) [m]."""
        return self.state[:, at.POSITION]

    @property
    def angles(self) -> np.ndarray:
        """Motor angles, positive winds in, shape (n, 8) [rad]."""
        return self.state[:, at.ANGLES]


def simulate_reference(
    parameters: ParameterSet,
    geometry: Geometry,
    time: np.ndarray,
    currents: np.ndarray,
    *,
    start: np.ndarray | None = None,
    force: Sequence[float] = NO_FORCE,
    force_at: Sequence[float] = NO_FORCE,
) -> ReferenceRun:
    """Simulate the 36 states of the thesis at increasing times (n,) [s], under currents (n, 8) [A].

    The first state is the rest at the start pose if `start` (36,) gives no other; the drum springs
    balance the pretension of that pose in both cases. `pack` says what the force is.

    Raises:
        InputError: shapes or times are not as above, or no rest exists.
        DivergenceError: the state left the finite numbers, or the pitch came to 89° or more.
    """
    q = pack(parameters, geometry, force=force, force_at=force_at)
    t, u = _samples(time, currents)
    x = np.empty((len(t), at.STATES))
    x[0] = rest(parameters, geometry).state if start is None else _start(start)
    _refuse_bad_state(t[0], x[0])
    _fill(t, u, q, x)
    return ReferenceRun(t, x, np.array([cables(row, q)[0] for row in x]))


def _fill(t: np.ndarray, u: np.ndarray, q: np.ndarray, x: np.ndarray) -> None:
    """Fill x[1:] by DOP853, restarted only where the currents change."""
    changes = np.flatnonzero((u[1:-1] != u[:-2]).any(axis=1)) + 1
    for first, last in pairwise(np.unique([0, *changes, len(t) - 1]).tolist()):
        i, k = u[first], first + 1
        # Overflow is no surprise here: the state is checked after every step.
        with np.errstate(all="ignore"):
            solver = DOP853(
                lambda _, y, i=i: derivative(y, i, q), t[first], x[first], t[last],
                rtol=RTOL, atol=ATOL,
            )  # fmt: skip
            while solver.status == "running":
                solver.step()
                if solver.status == "failed":
                    raise _left_finite(solver.t)
                _refuse_bad_state(solver.t, solver.y)
                if k < last and t[k] <= solver.t:
                    inside = solver.dense_output()
                    while k < last and t[k] <= solver.t:
                        x[k] = inside(t[k])
                        k += 1
        x[last] = solver.y


def _samples(time: np.ndarray, currents: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    t, u = np.array(time, dtype=float), np.array(currents, dtype=float)
    if t.ndim != 1 or len(t) == 0 or not np.isfinite(t).all() or (np.diff(t) <= 0).any():
        raise InputError("time must be a row of increasing finite numbers [s]")
    if u.shape != (len(t), at.DRIVES) or not np.isfinite(u).all():
        raise InputError(
            f"currents must be finite numbers [A] of shape ({len(t)}, {at.DRIVES}), one row per"
            f" time; their shape is {u.shape}"
        )
    return t, u


def _start(start: np.ndarray) -> np.ndarray:
    x = np.array(start, dtype=float)
    if x.shape != (at.STATES,) or not np.isfinite(x).all():
        raise InputError(f"start must be {at.STATES} finite numbers, its shape is {x.shape}")
    return x


def _refuse_bad_state(t: float, x: np.ndarray) -> None:
    if not np.isfinite(x).all():
        raise _left_finite(t)
    pitch = x[at.EULER][1]
    if abs(pitch) > SINGULAR:
        raise DivergenceError(
            f"the platform's pitch reached {degrees(pitch):.1f}° at t = {t:.6g} s, where roll,"
            " pitch and yaw are singular; lower the currents, or use the MuJoCo twin, whose"
            " quaternion is not"
        )


def _left_finite(t: float) -> DivergenceError:
    return DivergenceError(
        f"the reference left the finite numbers at t = {t:.6g} s; check lambda, b, J and the"
        " currents for a wrong unit"
    )
