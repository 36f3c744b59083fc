"""Frictions of joints: what each adds to the friction that holds, and forces that grow with speed.

Friction resists the motion ahead, whose sign is s, with at most b, and holds what drives less than
that (see `identification.native.joints.joint_friction`):

    b =   f_c                                   Coulomb friction
        + f_a s                                 its difference by direction: f_c + f_a forward
        + f_s exp(-|v/v_s|^n)                   Stribeck peak
        + μ |f_u|                               friction that grows with the drive's force f_u
        + μ |f_u - f_g|                         ... with the load that the gears transmit
        + μ |f_g|                               ... with gravity's force f_g alone
        + μ |f_u - ρ f_g|                       ... with drive's force and gravity's, by shares
        + exp(-|v/v_s|) (q_e f_g² or q_m f_u²)  ... with the square of the smaller, if they oppose
        + μ_s |f_u - f_g| exp(-|v/v_s|)         ... a Stribeck peak that grows with that load
        + f_q q                                 Coulomb friction that changes along the way
        + a cos n q + b sin n q                 friction that repeats along the way

    f = - d_a |v|                               viscous friction by direction: d + d_a forward
        - c v |v|                               quadratic friction
        - d_p v |v|^(n-1)                       friction that grows less than viscous friction
        - d_q q v                               viscous friction that changes along the way

q, v: position and velocity [rad, rad/s or m, m/s]; f: torque or force [N m or N], as MuJoCo's
qfrc_passive counts it. Gears transmit |f_u - f_g|: what the drive pushes against what pulls at the
other end (Duclusaud, Passault, Padois, Ly 2024, models M3 to M6; they write μ |f_u - ρ f_g| as
|K_m f_u - K_e f_g|). Each function takes the joint's state s
(`identification.native.joints.joint_callback.Joint`) and the effect's parameters p, sizes first.
"""

from __future__ import annotations

from math import cos, exp, sin

from numba import njit

from identification.effects.effect import Effect
from identification.effects.laws.joint_group import Group, wave_sizes, waves
from identification.effects.sizes import Shape
from identification.quantities import per

SPEEDS = (0.03, 0.06, 0.12, 0.25, 0.5)  # Stribeck velocities to try, of the top speed
FEW_SPEEDS = (0.06, 0.25)  # where two sizes are tried with each
# Of the top speed: a peak that is wider than this is a level at nearly all speeds.
WIDEST = 0.6
LOAD = "Duclusaud, Passault, Padois, Ly 2024"
LEVEL = "coulomb_friction"  # what laws change that say how much more friction there is


@njit
def coulomb_friction(s, p):
    return p[0]


@njit
def asymmetric_friction(s, p):
    return p[0] * s.sign


@njit
def stribeck_friction(s, p):
    f_s, v_s, n = p
    return f_s * exp(-(abs(s.v / v_s) ** n))


@njit
def load_dependent_friction(s, p):
    return p[0] * abs(s.f_u)


@njit
def transmitted_load_friction(s, p):
    return p[0] * abs(s.f_u - s.f_g)


@njit
def gravity_load_friction(s, p):
    return p[0] * abs(s.f_g)


@njit
def two_load_friction(s, p):
    mu, rho = p
    return mu * abs(s.f_u - rho * s.f_g)


@njit
def quadratic_load_friction(s, p):
    q_e, q_m, v_s = p
    if s.f_u * s.f_g >= 0.0:
        return 0.0
    load = q_e * s.f_g * s.f_g if abs(s.f_u) > abs(s.f_g) else q_m * s.f_u * s.f_u
    return load * exp(-abs(s.v / v_s))


@njit
def load_stribeck_friction(s, p):
    mu_s, v_s = p
    return mu_s * abs(s.f_u - s.f_g) * exp(-abs(s.v / v_s))


@njit
def position_dependent_friction(s, p):
    return p[0] * s.q


@njit
def periodic_friction(s, p):
    a, b, n = p
    return a * cos(n * s.q) + b * sin(n * s.q)


@njit
def asymmetric_viscous_friction(s, p):
    return -p[0] * abs(s.v)


@njit
def quadratic_friction(s, p):
    return -p[0] * s.v * abs(s.v)


@njit
def sublinear_friction(s, p):
    d_p, n = p
    speed = abs(s.v)
    if speed == 0.0:
        return 0.0
    return -d_p * s.v * speed ** (n - 1.0)


@njit
def position_dependent_damping(s, p):
    return -p[0] * s.v * s.q


def friction_effects(g: Group) -> list[Effect]:
    """Returns frictions that hold; those without a place are left out by the caller."""
    F, A = g.F, g.A
    v_s, few = _peak(g, SPEEDS), _peak(g, FEW_SPEEDS)
    power = Shape("n", "", (1.0, 2.0), 0.5, 4.0, about="the power", usual=2.0)
    ratio = Shape("rho", "", (0.25, 0.5, 2.0, 4.0), 0.02, 50.0, usual=0.5,
                  about="share of gravity's force over that of the drive's")  # fmt: skip
    return [
        g.friction(coulomb_friction, "at most f_c, against the motion", "friction: Coulomb",
                   g.size("f_c", 0.3 * F, g.f, "level", 1)),
        g.friction(asymmetric_friction, "at most f_a more forward, less backward",
                   "friction: Coulomb level differs by direction",
                   g.size("f_a", 0.1 * F, g.f, "half the difference of the two directions"),
                   needs=g.prefix + LEVEL),
        g.friction(stribeck_friction, "at most f_s exp(-|v/v_s|^n) more",
                   "friction: Stribeck peak", g.size("f_s", 0.2 * F, g.f, "height of the peak"),
                   shapes=(v_s, power),
                   reference="Armstrong-Hélouvry, Dupont, Canudas de Wit 1994"),
        g.friction(load_dependent_friction, "at most μ |f_u| more, f_u the drive's force",
                   "friction: grows with the drive's force",
                   g.size("mu", 0.2, "", "share of the drive's force", 1),
                   places=g.plain, reference="Hamon, Gautier, Garrec 2010"),
        g.friction(transmitted_load_friction,
                   "at most μ |f_u - f_g| more, f_u the drive's force, f_g gravity's",
                   "friction: grows with the transmitted load",
                   g.size("mu", 0.2, "", "share of the load that the gears transmit", 1),
                   places=g.loaded, reference=LOAD),
        g.friction(gravity_load_friction, "at most μ |f_g| more, f_g gravity's force",
                   "friction: grows with gravity's load",
                   g.size("mu", 0.2, "", "share of gravity's force", 1),
                   places=g.tilting, reference=LOAD),
        g.friction(two_load_friction, "at most μ |f_u - ρ f_g| more",
                   "friction: grows with the drive's force and gravity's, each by its share",
                   g.size("mu", 0.2, "", "share of the drive's force", 1),
                   shapes=(ratio,), places=g.loaded, reference=LOAD),
        g.friction(quadratic_load_friction,
                   "at most q_e f_g² more where the drive lifts, q_m f_u² where it lowers,"
                   " times exp(-|v/v_s|)", "friction: grows with the square of the load",
                   g.size("q_e", 0.2 / F, per("1", g.f), "growth while lifting", 1),
                   g.size("q_m", 0.2 / F, per("1", g.f), "growth while lowering", 1),
                   shapes=(few,), places=g.loaded, reference=LOAD),
        g.friction(load_stribeck_friction, "at most μ_s |f_u - f_g| exp(-|v/v_s|) more",
                   "friction: Stribeck peak that grows with the transmitted load",
                   g.size("mu_s", 0.2, "", "share of the transmitted load, at rest"),
                   shapes=(v_s,), places=g.plain, reference=LOAD),
        g.friction(position_dependent_friction, "at most f_q q more",
                   "friction: Coulomb level changes along the way",
                   g.size("f_q", 0.3 * F / A, f"{g.f}/{g.x}", "growth along the way"),
                   needs=g.prefix + LEVEL),
        *(g.friction(periodic_friction, "at most a cos nq + b sin nq more",
                     "friction: repeats along the way", *wave_sizes(g), shapes=(n,),
                     needs=g.prefix + LEVEL) for n in waves(g)),
    ]  # fmt: skip


def drag_effects(g: Group) -> list[Effect]:
    """Returns forces that grow with speed."""
    F, V, A = g.F, g.V, g.A
    less = Shape("n", "", (0.33, 0.67), 0.1, 0.95, about="the power")
    return [
        g.force(asymmetric_viscous_friction, "-d_a |v|", "friction: viscous, differs by direction",
                g.size("d_a", 0.3 * F / V, f"{g.f} s/{g.x}",
                       "half the difference of the directions"),
                reference="Janot, Gautier, Brunot 2019"),
        g.force(quadratic_friction, "-c v |v|", "friction: grows with the square of speed",
                g.size("c", 0.3 * F / V**2, f"{g.f} s^2/{g.x}^2", "drag", 1)),
        g.force(sublinear_friction, "-d_p v |v|^(n-1)", "friction: grows less than speed",
                g.size("d_p", 0.3 * F / V**0.5, f"{g.f} s^n/{g.x}^n", "drag", 1), shapes=(less,)),
        g.force(position_dependent_damping, "-d_q q v", "friction: viscous, changes along the way",
                g.size("d_q", 0.3 * F / (V * A), f"{g.f} s/{g.x}^2", "growth along the way")),
    ]  # fmt: skip


def _peak(g: Group, speeds: tuple[float, ...]) -> Shape:
    return Shape("v_s", f"{g.x}/s", tuple(g.V * s for s in speeds), 0.01 * g.V, WIDEST * g.V,
                 about="rate at which the peak has fallen to 1/e")  # fmt: skip
