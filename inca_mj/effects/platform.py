"""The platform: where its centre of mass is, and what pushes it.

com offset          (x, y, z)                          the platform is heavier on one side
external force      G at the platform's centre         something pulls, always the same way
pull                G at the point b_G of the platform, with the torque R b_G × G
air drag            -c |v|^(n-1) v                     v in m/s
"""

from math import sqrt

from numba import njit

from identification.effects.sizes import Shape, Size
from inca_mj.effects.hooks import ON_PLATFORM, by_law


@njit
def com_offset(s, p):
    return p[0], p[1], p[2]


@njit
def external_force(s, p):
    return p[0], p[1], p[2], 0.0, 0.0, 0.0


@njit
def pull(s, p):
    x, y, z = p[0], p[1], p[2]
    bx = s.R11 * p[3] + s.R12 * p[4] + s.R13 * p[5]
    by = s.R21 * p[3] + s.R22 * p[4] + s.R23 * p[5]
    bz = s.R31 * p[3] + s.R32 * p[4] + s.R33 * p[5]
    return x, y, z, by * z - bz * y, bz * x - bx * z, bx * y - by * x


@njit
def air_drag(s, p):
    c, n = p
    k = -c * sqrt(s.vx**2 + s.vy**2 + s.vz**2) ** (n - 1)
    return k * s.vx, k * s.vy, k * s.vz, 0.0, 0.0, 0.0


def _sizes(unit: str, largest: float, probe: float, what: str) -> tuple[Size, ...]:
    return tuple(Size(a, unit, largest, probe, about=what.format(a)) for a in "xyz")


OF_PLATFORM = (
    by_law(com_offset, "centre", "centre of mass moved by (x, y, z), body axes",
           _sizes("m", 0.02, 1e-3, "offset of the centre of mass"), places=ON_PLATFORM,
           phrase="platform: centre of mass is elsewhere", reference="thesis 2.36"),
    by_law(external_force, "wrench", "constant force (x, y, z) on the platform, fixed frame",
           _sizes("N", 1.0, 0.05, "force along {}"), places=ON_PLATFORM,
           phrase="platform: constant force", reference="thesis 2.35"),
    by_law(air_drag, "wrench", "-c |v| v on the platform, or another power of |v|",
           (Size("c", "N s²/m²", 0.5, 0.01, sign=1, about="drag per power of speed"),),
           (Shape("n", "", (1.5, 2.0), 1.2, 4.0, free=False, about="the power"),),
           places=ON_PLATFORM, phrase="platform: air drag",
           reference="Hoerner 1965, Fluid-Dynamic Drag"),
)  # fmt: skip
# The user's own hand in a simulation. It is in no catalogue: a discovery looks for a force at the
# centre of mass, which is the only place that it need not guess.
PULL = by_law(
    pull, "wrench",
    "constant force G = (x, y, z) at the point b_G of the platform, fixed frame",
    _sizes("N", 20.0, 0.05, "force along {}"),
    tuple(Shape(f"b_{a}", "m", (0.0,), -1.0, 1.0, free=False, about=f"b_G along {a}")
          for a in "xyz"),
    places=ON_PLATFORM, phrase="platform: constant force at a point",
    reference="thesis 2.35, 2.36",
)  # fmt: skip
