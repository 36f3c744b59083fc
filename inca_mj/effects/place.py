"""True places of points, and what pushes the platform.

    pulley radius     Δd = r_p β + ℓ - √(h² + z²)          a swivelling pulley at the exit point
    anchor offset     Δd = |r - o| - |r|                   an exit point is not where it should be
    offset of the centre of mass                           the platform is heavier on one side
    external force    (x, y, z) at the platform's centre   something pulls, always the same way
    pull              G at the point b_G of the platform, with the torque R b_G × G
    air drag          -c |v|^(n-1) v on the platform

Of the pulley: the cable enters it at A along the vertical and leaves along the tangent towards the
connector B; the pulley swivels about that vertical. It enters upwards into a low pulley and
downwards into a high one, or, where it runs over, the other way: then it turns farther. With h the
horizontal and z the vertical distance from A to B, z in the direction of the entering cable:

    D² = (h - r_p)² + z²,  ℓ = √(D² - r_p²)                  tangent
    β  = angle over which the cable lies on the pulley

Its gradient is the tangent's direction less that of B - A.
"""

from math import atan2, cos, sin, sqrt

from numba import njit

from identification.effects.effect import Effect, Shape, Size
from inca_mj.effects.hooks import CABLES, ON_PLATFORM, ONE_DRIVE


@njit
def pulley_radius(s, p):  # type: ignore[no-untyped-def]
    """Δd and ∂Δd/∂r, r = B - A."""
    r_p, over = p
    across = sqrt(s.rx**2 + s.ry**2)
    sign = 1.0 if (s.rz >= 0.0) != (over != 0.0) else -1.0  # low drives look up, high ones down
    z = sign * s.rz
    straight = sqrt(across**2 + z**2)
    tangent = sqrt((across - r_p) ** 2 + z**2 - r_p**2)
    # B from the centre: tangent (sin β, cos β) + r_p (-cos β, sin β)
    beta = atan2(tangent * (across - r_p) + r_p * z, tangent * z - r_p * (across - r_p))
    out, up = sin(beta), sign * cos(beta)
    return (
        r_p * beta + tangent - straight,
        (out / across - 1.0 / straight) * s.rx,
        (out / across - 1.0 / straight) * s.ry,
        up - s.rz / straight,
    )


@njit
def anchor_offset(s, p):  # type: ignore[no-untyped-def]
    """Δd = |r - o| - |r|, with ∂Δd/∂r; r = B - A, o the offset of A."""
    x, y, z = s.rx - p[0], s.ry - p[1], s.rz - p[2]
    old, new = sqrt(s.rx**2 + s.ry**2 + s.rz**2), sqrt(x**2 + y**2 + z**2)
    return new - old, x / new - s.rx / old, y / new - s.ry / old, z / new - s.rz / old


@njit
def com_offset(s, p):  # type: ignore[no-untyped-def]
    """(x, y, z) of the centre of mass in body axes [m]."""
    return p[0], p[1], p[2]


@njit
def external_force(s, p):  # type: ignore[no-untyped-def]
    """(G, 0): a constant force in O at the platform's centre [N]."""
    return p[0], p[1], p[2], 0.0, 0.0, 0.0


@njit
def pull(s, p):  # type: ignore[no-untyped-def]
    """(G, R b_G × G): a constant force in O at a point of the platform [N, N m]."""
    x, y, z = p[0], p[1], p[2]
    bx = s.R11 * p[3] + s.R12 * p[4] + s.R13 * p[5]
    by = s.R21 * p[3] + s.R22 * p[4] + s.R23 * p[5]
    bz = s.R31 * p[3] + s.R32 * p[4] + s.R33 * p[5]
    return x, y, z, by * z - bz * y, bz * x - bx * z, bx * y - by * x


@njit
def air_drag(s, p):  # type: ignore[no-untyped-def]
    """(-c |v|^(n-1) v, 0) [N], v in m/s."""
    c, n = p
    k = -c * sqrt(s.vx**2 + s.vy**2 + s.vz**2) ** (n - 1)
    return k * s.vx, k * s.vy, k * s.vz, 0.0, 0.0, 0.0


PULLEY_RADIUS = Effect(
    "pulley_radius",
    "swivelling pulley of radius r_p at A_i",
    (Size("r_p", "m", 0.03, 1e-3, sign=1, about="radius of the pulley"),),
    (Shape("over", "", (0.0, 1.0), 0.0, 1.0, free=False, about="1: over it", usual=0.0),),
    places=CABLES,
    phrase="cable: pulley at the exit point",
    reference="Pott 2012, Influence of pulley kinematics on cable-driven parallel robots",
    hooks={"path": pulley_radius},
)
ANCHOR_OFFSET = Effect(
    "anchor_offset",
    "A_k moved by (x, y, z)",
    (
        Size("x", "m", 0.03, 1e-3, about="offset of the exit point"),
        Size("y", "m", 0.03, 1e-3, about="offset of the exit point"),
        Size("z", "m", 0.03, 1e-3, about="offset of the exit point"),
    ),
    places=ONE_DRIVE,
    phrase="geometry: an exit point is elsewhere",
    reference="Pott 2018, Cable-Driven Parallel Robots",
    hooks={"path": anchor_offset},
)
COM_OFFSET = Effect(
    "com_offset",
    "centre of mass moved by (x, y, z), body axes",
    (
        Size("x", "m", 0.02, 1e-3, about="offset of the centre of mass"),
        Size("y", "m", 0.02, 1e-3, about="offset of the centre of mass"),
        Size("z", "m", 0.02, 1e-3, about="offset of the centre of mass"),
    ),
    places=ON_PLATFORM,
    phrase="platform: centre of mass is elsewhere",
    reference="thesis 2.36",
    hooks={"centre": com_offset},
)
EXTERNAL_FORCE = Effect(
    "external_force",
    "constant force (x, y, z) on the platform, fixed frame",
    (
        Size("x", "N", 1.0, 0.05, about="force along x"),
        Size("y", "N", 1.0, 0.05, about="force along y"),
        Size("z", "N", 1.0, 0.05, about="force along z"),
    ),
    places=ON_PLATFORM,
    phrase="platform: constant force",
    reference="thesis 2.35",
    hooks={"wrench": external_force},
)
# The user's own hand in a simulation. It is in no catalogue: a discovery looks for a force at the
# centre of mass, which is the only place that it need not guess.
PULL = Effect(
    "pull",
    "constant force G = (x, y, z) at the point b_G of the platform, fixed frame",
    (
        Size("x", "N", 20.0, 0.05, about="force along x"),
        Size("y", "N", 20.0, 0.05, about="force along y"),
        Size("z", "N", 20.0, 0.05, about="force along z"),
    ),
    tuple(
        Shape(f"b_{axis}", "m", (0.0,), -1.0, 1.0, free=False, about=f"b_G along {axis}")
        for axis in "xyz"
    ),
    places=ON_PLATFORM,
    phrase="platform: constant force at a point",
    reference="thesis 2.35, 2.36",
    hooks={"wrench": pull},
)
AIR_DRAG = Effect(
    "air_drag",
    "-c |v| v on the platform, or another power of |v|",
    (Size("c", "N s²/m²", 0.5, 0.01, sign=1, about="drag per power of speed"),),
    (Shape("n", "", (1.5, 2.0), 1.2, 4.0, free=False, about="the power"),),
    places=ON_PLATFORM,
    phrase="platform: air drag",
    reference="Hoerner 1965, Fluid-Dynamic Drag",
    hooks={"wrench": air_drag},
)
