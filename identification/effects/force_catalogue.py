"""Candidate forces on joints: drag, springs, cogging, a weaker drive; see `joint_laws`."""

from __future__ import annotations

from identification.effects import joint_laws as laws
from identification.effects.effect import Effect, Shape
from identification.effects.joint_group import Group
from identification.effects.waves import wave_sizes, waves
from identification.quantities import per


def force_effects(g: Group) -> list[Effect]:
    """Returns forces on some joints; those without a place are left out by the caller."""
    F, A = g.F, g.A
    out = [
        *_drags(g),
        g.force(laws.offset, "f_0", (g.size("f_0", 0.2 * F, g.f, "constant force"),),
                "force: constant"),
        g.force(laws.stiffness, "-k q",
                (g.size("k", 0.3 * F / A, f"{g.f}/{g.x}", "of a spring", 1),),
                "spring: pulls back to zero"),
        g.force(laws.hardening, "-k_3 q³",
                (g.size("k_3", 0.3 * F / A**3, f"{g.f}/{g.x}^3",
                        "of a spring that hardens, or softens"),),
                "spring: grows with the cube of the way", "Duffing 1918"),
        g.force(laws.torque_saturation, "-c f_u³, f_u the drive's force",
                (g.size("c", 0.5 / F**2, per("1", g.f, 2),
                        "relative loss per square of force", 1),),
                "motor: weaker at high current", "Krishnan 2010", where=g.plain),
    ]  # fmt: skip
    if (n := waves(g)) is not None:
        out.append(g.force(laws.cogging, "a cos nq + b sin nq", wave_sizes(g), "motor: cogging",
                           "Krishnan 2010", (n,)))  # fmt: skip
    return out


def _drags(g: Group) -> list[Effect]:
    """Returns forces that grow with speed."""
    F, V, A = g.F, g.V, g.A
    less = Shape("n", "", (0.33, 0.67), 0.1, 0.95, about="the power")
    return [
        g.force(laws.asymmetric_viscous_friction, "-d_a |v|",
                (g.size("d_a", 0.3 * F / V, f"{g.f} s/{g.x}",
                        "half the difference of the directions"),),
                "friction: viscous, differs by direction", "Janot, Gautier, Brunot 2019"),
        g.force(laws.quadratic_friction, "-c v |v|",
                (g.size("c", 0.3 * F / V**2, f"{g.f} s^2/{g.x}^2", "drag", 1),),
                "friction: grows with the square of speed"),
        g.force(laws.sublinear_friction, "-d_p v |v|^(n-1)",
                (g.size("d_p", 0.3 * F / V**0.5, f"{g.f} s^n/{g.x}^n", "drag", 1),),
                "friction: grows less than speed", shapes=(less,)),
        g.force(laws.position_dependent_damping, "-d_q q v",
                (g.size("d_q", 0.3 * F / (V * A), f"{g.f} s/{g.x}^2", "growth along the way"),),
                "friction: viscous, changes along the way"),
    ]  # fmt: skip
