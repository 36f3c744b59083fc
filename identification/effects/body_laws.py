"""The laws of body effects: the ten numbers (m, h, I_O) that each adds to those of a body.

    mass mismatch       Δm (1, c, I_O/m)        a heavier body of unchanged shape
    offset of centre    (0, m d, |c+d|² .. )    the same body, displaced by d in its frame
    inertia mismatch    δ (0, 0, I_c)           inertia about the centre of mass
    payload             M (1, p, |p|² 1 - p pᵀ) a point mass at p

Each keeps a possible body possible (a positive pseudo-inertia; Wensing, Kim, Slotine 2018), as long
as Δm > -m, δ > -1, M >= 0. s: see `identification.effects.body.Body`; p: the sizes.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from numba import njit


@njit
def point_inertia(m, x, y, z):  # type: ignore[no-untyped-def]
    """Returns m (|c|² 1 - c cᵀ) as (xx, yy, zz, xy, xz, yz)."""
    return (
        m * (y * y + z * z), m * (x * x + z * z), m * (x * x + y * y),
        -m * x * y, -m * x * z, -m * y * z,
    )  # fmt: skip


@njit
def mass_mismatch(s, p):  # type: ignore[no-untyped-def]
    """Δm (1, c, I_O/m)."""
    (dm,) = p
    k, o = dm / s.m, point_inertia(dm, s.cx, s.cy, s.cz)
    return (
        dm, dm * s.cx, dm * s.cy, dm * s.cz,
        k * s.Ixx + o[0], k * s.Iyy + o[1], k * s.Izz + o[2],
        k * s.Ixy + o[3], k * s.Ixz + o[4], k * s.Iyz + o[5],
    )  # fmt: skip


@cache
def displaced(axes: str) -> Any:
    """Returns the law of a centre of mass that is displaced along some axes of the body's frame.

    Args:
        axes: of "xyz", one for each size.
    """
    ix, iy, iz = (axes.find(a) for a in "xyz")

    @njit
    def com_offset(s, p):  # type: ignore[no-untyped-def]
        x, y, z = (p[ix] * (ix >= 0), p[iy] * (iy >= 0), p[iz] * (iz >= 0))
        old = point_inertia(s.m, s.cx, s.cy, s.cz)
        new = point_inertia(s.m, s.cx + x, s.cy + y, s.cz + z)
        return (
            0.0, s.m * x, s.m * y, s.m * z,
            new[0] - old[0], new[1] - old[1], new[2] - old[2],
            new[3] - old[3], new[4] - old[4], new[5] - old[5],
        )  # fmt: skip

    return com_offset


@njit
def inertia_mismatch(s, p):  # type: ignore[no-untyped-def]
    """δ (0, 0, I_c)."""
    (k,) = p
    return (
        0.0, 0.0, 0.0, 0.0, k * s.Ixx, k * s.Iyy, k * s.Izz, k * s.Ixy, k * s.Ixz, k * s.Iyz
    )  # fmt: skip


@njit
def payload(s, p):  # type: ignore[no-untyped-def]
    """M (1, p, |p|² 1 - p pᵀ)."""
    (m,) = p
    o = point_inertia(m, s.px, s.py, s.pz)
    return m, m * s.px, m * s.py, m * s.pz, o[0], o[1], o[2], o[3], o[4], o[5]
