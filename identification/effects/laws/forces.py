"""Forces on joints that do not come from friction, and all that changes with time t of the record.

    f =   f_0                                   constant force
        - α f_g                                 gravity that is not what the model has
        - k q                                   spring
        - k_3 q³                                its hardening
        - c f_u³                                a drive that weakens where it pushes hard
        + c (clip(f_u, -f_m (1 + v/v_0), f_m (1 - v/v_0)) - f_u)        the limit of its voltage
        + a cos n q + b sin n q                 cogging
        + f_t t                                 a force that drifts
        - d_t t v                               viscous friction that drifts
        - d_j r(t - t_j) v                      ... that jumps
        + f_p (r(t - t_0) - r(t - t_0 - t_p))   a push that begins and ends

    b = + f_t t                                 Coulomb friction that drifts
        + f_j r(t - t_j)                        ... that jumps

    r(x) = clip(½ + x/w, 0, 1)                  from none to all within w about x = 0

The letters are those of `identification.effects.laws.friction`. A drive that compensates gravity
has α = 1, a robot that is mounted upside down α = 2, one that stands where g is less, or on a
slope, some α between. A motor that turns makes a voltage of its own, so that what its supply can
still drive through it falls with its speed: f_m is its force at a standstill and v_0 the speed at
which none is left. c is 1 where there is such a limit. Time is that of the record, from its first
sample on, also in its parts and in windows of it. A jump takes a short time w so that the outputs
follow its time smoothly, and its time can be searched.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, cos, log, sin

from numba import njit

from identification.effects.effect import Effect
from identification.effects.laws.joint_group import Group, wave_sizes, waves
from identification.effects.sizes import Shape, Size
from identification.quantities import per

MOMENTS = 8  # times of a record at which a jump or a push is tried
# Of forces and top speeds of joints, the least and the most that are tried, and the ratio of
# neighbours: a limit acts where f_u/f_m + v/v_0 > 1. No joint is faster than v_0, and a servo asks
# for many times f_m as its setpoint steps.
STANDSTILL, NO_LOAD = (0.15, 1.4, 1.7), (1.1, 4.0, 2.0)
EDGE = 0.02  # of the record: how long a jump takes, so that its time can be searched


@njit
def offset(s, p):
    return p[0]


@njit
def gravity_force(s, p):
    return -p[0] * s.f_g


@njit
def stiffness(s, p):
    return -p[0] * s.q


@njit
def hardening(s, p):
    return -p[0] * s.q * s.q * s.q


@njit
def torque_saturation(s, p):
    return -p[0] * s.f_u * s.f_u * s.f_u


@njit
def voltage_limit(s, p):
    c, f_m, v_0 = p
    most, least = f_m * (1.0 - s.v / v_0), -f_m * (1.0 + s.v / v_0)
    return c * (max(least, min(most, s.f_u)) - s.f_u)


@njit
def cogging(s, p):
    a, b, n = p
    return a * cos(n * s.q) + b * sin(n * s.q)


@njit
def risen(x, w):
    """Returns r: how much of a change that takes w about x = 0 has happened at x, 0 to 1."""
    return min(1.0, max(0.0, 0.5 + x / w))


@njit
def friction_drift(s, p):
    return p[0] * s.time


@njit
def friction_jump(s, p):
    f_j, t_j, w = p
    return f_j * risen(s.time - t_j, w)


@njit
def force_drift(s, p):
    return p[0] * s.time


@njit
def viscous_friction_drift(s, p):
    return -p[0] * s.time * s.v


@njit
def viscous_friction_jump(s, p):
    d_j, t_j, w = p
    return -d_j * risen(s.time - t_j, w) * s.v


@njit
def push(s, p):
    f_p, t_0, t_p, w = p
    return f_p * (risen(s.time - t_0, w) - risen(s.time - t_0 - t_p, w))


def force_effects(g: Group) -> list[Effect]:
    """Returns forces of position and drive; those without a place are left out by the caller."""
    F, A = g.F, g.A
    single = {where: at for where, at in g.plain.items() if at}
    return [
        g.force(offset, "f_0", "force: constant", g.size("f_0", 0.2 * F, g.f, "constant force"),
                of_records="force: constant, and differs between the records"),
        g.force(gravity_force, "-α f_g, f_g gravity's force",
                "force: gravity's is not what the model has",
                g.size("alpha", 2.0, "", "share of gravity's force that is missing: 1 where the"
                       " drive compensates it, 2 where the robot hangs upside down"),
                places=g.heavy),
        g.force(stiffness, "-k q", "spring: pulls back to zero",
                g.size("k", 0.3 * F / A, f"{g.f}/{g.x}", "of a spring", 1)),
        g.force(hardening, "-k_3 q³", "spring: grows with the cube of the way",
                g.size("k_3", 0.3 * F / A**3, f"{g.f}/{g.x}^3",
                       "of a spring that hardens, or softens"), reference="Duffing 1918"),
        g.force(torque_saturation, "-c f_u³, f_u the drive's force",
                "motor: weaker at high current",
                g.size("c", 0.5 / F**2, per("1", g.f, 2), "relative loss per square of force", 1),
                places=g.plain, reference="Krishnan 2010"),
        g.force(voltage_limit, "f_u clipped at -f_m (1 + v/v_0) and f_m (1 - v/v_0)",
                "motor: weaker the faster it turns, at the limit of its voltage",
                Size("c", "", 1.0, 0.02, 1, "share of the clipping, 1 when there is a limit", 1.0),
                shapes=(
                    _spread("f_m", g.f, [a.force for a in g.axes], STANDSTILL,
                            "force at a standstill"),
                    _spread("v_0", f"{g.x}/s", [a.speed for a in g.axes], NO_LOAD,
                            "speed at which no force is left"),
                ), places=single, reference="Krishnan 2010"),
        *(g.force(cogging, "a cos nq + b sin nq", "motor: cogging", *wave_sizes(g), shapes=(n,),
                  reference="Krishnan 2010") for n in waves(g)),
    ]  # fmt: skip


def time_effects(g: Group) -> list[Effect]:
    """Returns drifts, jumps and pushes; none where the records' duration is not known."""
    F, V, T = g.F, g.V, g.T
    if T <= 0:
        return []
    edge = Shape("w", "s", (EDGE * T,), 0.1 * EDGE * T, 10 * EDGE * T, free=False,
                 about="how long the change takes")  # fmt: skip
    jump = (_moment("t_j", T, "when"), edge)
    lasting = Shape("t_p", "s", (T / MOMENTS,), 2 * EDGE * T, T, about="how long it lasts")
    drag = 0.3 * F / V
    return [
        g.friction(friction_drift, "at most f_t t more", "friction: Coulomb level drifts",
                   g.size("f_t", 0.3 * F / T, f"{g.f}/s", "growth with time")),
        g.force(force_drift, "f_t t", "force: drifts",
                g.size("f_t", 0.3 * F / T, f"{g.f}/s", "growth with time")),
        g.force(viscous_friction_drift, "-d_t t v", "friction: viscous, drifts",
                g.size("d_t", drag / T, f"{g.f}/{g.x}", "growth with time")),
        g.friction(friction_jump, "at most f_j more from t_j on", "friction: Coulomb level jumps",
                   g.size("f_j", 0.3 * F, g.f, "height of the jump"), shapes=jump),
        g.force(viscous_friction_jump, "-d_j v from t_j on", "friction: viscous, jumps",
                g.size("d_j", drag, f"{g.f} s/{g.x}", "height of the jump"), shapes=jump),
        g.force(push, "f_p from t_0 to t_0 + t_p", "force: a push that begins and ends",
                g.size("f_p", 0.5 * F, g.f, "the push"), places=g.each,
                shapes=(_moment("t_0", T, "when it begins", 0.0), lasting, edge)),
    ]  # fmt: skip


def _spread(
    name: str, unit: str, each: Sequence[float], of: tuple[float, float, float], about: str
) -> Shape:
    """Returns a shape that is tried from the least to the largest of some joints' magnitudes.

    Args:
        name: of the shape.
        unit: of the magnitudes.
        each: the magnitude of each joint.
        of: what is tried of the least and of the largest, and the ratio of neighbours.
        about: the shape in words.
    """
    low, high, ratio = of
    least, most = low * min(each), high * max(each)
    count = 1 + ceil(log(most / least) / log(ratio))
    grid = tuple(least * (most / least) ** (k / (count - 1)) for k in range(count))
    return Shape(name, unit, grid, 0.1 * least, 5 * most, about=about)


def _moment(name: str, T: float, about: str, first: float = 0.5) -> Shape:
    grid = tuple(T * max(EDGE, (k + first) / MOMENTS) for k in range(MOMENTS))
    return Shape(name, "s", grid, 0.5 * EDGE * T, T, about=about)
