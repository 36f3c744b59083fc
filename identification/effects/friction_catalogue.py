"""Candidate frictions of joints, which hold what drives less; their laws are in `joint_laws`."""

from __future__ import annotations

from identification.effects import joint_laws as laws
from identification.effects.effect import Effect, Shape
from identification.effects.joint_group import Group
from identification.effects.waves import wave_sizes, waves
from identification.quantities import per

SPEEDS = (0.03, 0.06, 0.12, 0.25, 0.5)  # Stribeck velocities to try, of the top speed
FEW_SPEEDS = (0.06, 0.25)  # where two sizes are tried with each
RATIO = Shape("rho", "", (0.25, 0.5, 2.0, 4.0), 0.02, 50.0, usual=0.5,
              about="share of gravity's force over that of the drive's")  # fmt: skip
LOAD = "Duclusaud, Passault, Padois, Ly 2024"


LEVEL = "coulomb_friction"  # what laws change that say how much more friction there is


def friction_effects(g: Group) -> list[Effect]:
    """Returns frictions of some joints; those without a place are left out by the caller."""
    F, A = g.F, g.A
    v_s = _peak(g, SPEEDS)
    power = Shape("n", "", (1.0, 2.0), 0.5, 4.0, about="the power", usual=2.0)
    out = [
        g.friction(laws.coulomb_friction, "at most f_c, against the motion",
                   (g.size("f_c", 0.3 * F, g.f, "level", 1),), "friction: Coulomb"),
        g.friction(laws.asymmetric_friction, "at most f_a more forward, less backward",
                   (g.size("f_a", 0.1 * F, g.f, "half the difference of the two directions"),),
                   "friction: Coulomb level differs by direction", needs=LEVEL),
        g.friction(laws.stribeck_friction, "at most f_s exp(-|v/v_s|^n) more",
                   (g.size("f_s", 0.2 * F, g.f, "height of the peak"),), "friction: Stribeck peak",
                   "Armstrong-Hélouvry, Dupont, Canudas de Wit 1994", (v_s, power)),
        *_under_load(g, v_s),
        g.friction(laws.position_dependent_friction, "at most f_q q more",
                   (g.size("f_q", 0.3 * F / A, f"{g.f}/{g.x}", "growth along the way"),),
                   "friction: Coulomb level changes along the way", needs=LEVEL),
    ]  # fmt: skip
    if (n := waves(g)) is not None:
        said, phrase = "at most a cos nq + b sin nq more", "friction: repeats along the way"
        out.append(
            g.friction(
                laws.periodic_friction, said, wave_sizes(g), phrase, shapes=(n,), needs=LEVEL
            )
        )
    return out


def _under_load(g: Group, v_s: Shape) -> list[Effect]:
    """Returns frictions that grow with the load of drives and gravity."""
    return [
        g.friction(laws.load_dependent_friction, "at most μ |f_u| more, f_u the drive's force",
                   (g.size("mu", 0.2, "", "share of the drive's force", 1),),
                   "friction: grows with the drive's force", "Hamon, Gautier, Garrec 2010",
                   where=g.plain),
        g.friction(laws.transmitted_load_friction,
                   "at most μ |f_u - f_g| more, f_u the drive's force, f_g gravity's",
                   (g.size("mu", 0.2, "", "share of the load that the gears transmit", 1),),
                   "friction: grows with the transmitted load", LOAD, where=g.loaded),
        g.friction(laws.gravity_load_friction, "at most μ |f_g| more, f_g gravity's force",
                   (g.size("mu", 0.2, "", "share of gravity's force", 1),),
                   "friction: grows with gravity's load", LOAD, where=g.heavy),
        g.friction(laws.two_load_friction, "at most μ |f_u - ρ f_g| more",
                   (g.size("mu", 0.2, "", "share of the drive's force", 1),),
                   "friction: grows with the drive's force and gravity's, each by its share", LOAD,
                   (RATIO,), g.loaded),
        g.friction(laws.quadratic_load_friction,
                   "at most q_e f_g² more where the drive lifts, q_m f_u² where it lowers,"
                   " times exp(-|v/v_s|)",
                   (g.size("q_e", 0.2 / g.F, per("1", g.f), "growth while lifting", 1),
                    g.size("q_m", 0.2 / g.F, per("1", g.f), "growth while lowering", 1)),
                   "friction: grows with the square of the load", LOAD, (_peak(g, FEW_SPEEDS),),
                   where=g.loaded),
        g.friction(laws.load_stribeck_friction, "at most μ_s |f_u - f_g| exp(-|v/v_s|) more",
                   (g.size("mu_s", 0.2, "", "share of the transmitted load, at rest"),),
                   "friction: Stribeck peak that grows with the transmitted load", LOAD, (v_s,),
                   where=g.plain),
    ]  # fmt: skip


def _peak(g: Group, speeds: tuple[float, ...]) -> Shape:
    return Shape("v_s", f"{g.x}/s", tuple(g.V * s for s in speeds), 0.01 * g.V, 2 * g.V,
                 about="rate at which the peak has fallen to 1/e")  # fmt: skip
