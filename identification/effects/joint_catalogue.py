"""Candidate effects of the hinge and slide joints of a robot; their laws are in `joint_laws`.

A size is plausible up to a share of what the drives can do: of F for a force, of F/V for what
grows with speed, of F/A for what grows along the way, A half the travel (see `axes`).
"""

from __future__ import annotations

from collections.abc import Sequence
from math import pi

from identification.effects import joint_laws as laws
from identification.effects.axes import Axis, Kind
from identification.effects.effect import Effect, Shape, Sign, Size
from identification.effects.places import places
from identification.native.element import Function

PROBE = 0.01  # of the largest plausible size
TURNS = (*map(float, range(1, 13)), 14.0, 16.0, 18.0, 20.0, 24.0, 28.0)  # harmonics of a turn
SPEEDS = (0.03, 0.06, 0.12, 0.25, 0.5)  # Stribeck velocities to try, of the top speed
WAVES = (2.0, 4.0, 8.0, 16.0)  # periods of a slide's travel
SEEN = 2.0  # periods within the travel, below which a curve is not seen to repeat


def joint_effects(axes: Sequence[Axis], turns: Sequence[float] = TURNS) -> tuple[Effect, ...]:
    """All candidates of some joints.

    Hinges and slides have units of their own; where a robot has both, the names of the slides'
    effects begin with `slide_`. Friction under load needs drives whose force is gain·u + bias.

    Args:
        axes: the joints.
        turns: periods in a turn of a hinge that are tried; a motor's are multiples of its poles
            and of its slots.
    """
    kinds: list[Kind] = ["hinge", "slide"]
    groups = [(kind, tuple(a for a in axes if a.kind == kind)) for kind in kinds]
    both = all(group for _, group in groups)
    return tuple(
        effect
        for kind, group in groups
        if group
        for effect in _catalogue(group, kind, turns, "slide_" if both and kind == "slide" else "")
    )


def _catalogue(
    axes: tuple[Axis, ...], kind: Kind, turns: Sequence[float], prefix: str
) -> list[Effect]:
    F, V, L = (max(getattr(a, word) for a in axes) for word in ("force", "speed", "travel"))
    A = L / 2
    f, x = ("N m", "rad") if kind == "hinge" else ("N", "m")
    at = places("joint", tuple(a.joint for a in axes))
    plain = tuple(a.joint for a in axes if a.plain)
    heavy = tuple(a.joint for a in axes if a.heavy)
    loaded = tuple(name for name in plain if name in heavy)

    def size(name: str, largest: float, unit: str, about: str, sign: Sign = 0) -> Size:
        return Size(name, unit, largest, PROBE * largest, sign, about)

    def effect(law: Function, said: str, sizes: tuple[Size, ...], phrase: str,
               reference: str = "", shapes: tuple[Shape, ...] = (), hook: str = "friction",
               where: dict[str, str] = at) -> Effect:  # fmt: skip
        return Effect(
            prefix + law.__name__, said, sizes, shapes, places=where, phrase=phrase,
            reference=reference, hooks={hook: law},
        )  # fmt: skip

    def force(law: Function, said: str, sizes: tuple[Size, ...], phrase: str,
              reference: str = "", shapes: tuple[Shape, ...] = ()) -> Effect:  # fmt: skip
        return effect(law, said, sizes, phrase, reference, shapes, "force")

    v_s = Shape("v_s", f"{x}/s", tuple(V * s for s in SPEEDS), 0.01 * V, 2 * V,
                about="half width of the peak")  # fmt: skip
    power = Shape("n", "", (1.0, 2.0), 0.5, 4.0, free=False, about="the power", usual=2.0)
    less = Shape("n", "", (0.33, 0.67), 0.1, 0.95, free=False, about="the power")
    n = _waves(kind, L, turns)
    waves = (
        size("a", 0.2 * F, f, "amplitude of the cosine"),
        size("b", 0.2 * F, f, "amplitude of the sine"),
    )
    load = "Duclusaud, Passault, Padois, Ly 2024"
    out = [
        effect(laws.coulomb_friction, "at most f_c, against the motion",
               (size("f_c", 0.3 * F, f, "level", 1),), "friction: Coulomb"),
        effect(laws.asymmetric_friction, "at most f_a more forward, less backward",
               (size("f_a", 0.1 * F, f, "half the difference of the two directions"),),
               "friction: Coulomb level differs by direction"),
        force(laws.asymmetric_viscous_friction, "-d_a |v|",
              (size("d_a", 0.3 * F / V, f"{f} s/{x}", "half the difference of the directions"),),
              "friction: viscous, differs by direction", "Janot, Gautier, Brunot 2019"),
        effect(laws.stribeck_friction, "at most f_s exp(-|v/v_s|^n) more",
               (size("f_s", 0.2 * F, f, "height of the peak"),), "friction: Stribeck peak",
               "Armstrong-Hélouvry, Dupont, Canudas de Wit 1994", (v_s, power)),
        force(laws.quadratic_friction, "-c v |v|",
              (size("c", 0.3 * F / V**2, f"{f} s^2/{x}^2", "drag", 1),),
              "friction: grows with the square of speed"),
        force(laws.sublinear_friction, "-d_p v |v|^(n-1)",
              (size("d_p", 0.3 * F / V**0.5, f"{f} s^n/{x}^n", "drag", 1),),
              "friction: grows less than speed", shapes=(less,)),
        effect(laws.load_dependent_friction, "at most μ |f_u| more, f_u the drive's force",
               (size("mu", 0.2, "", "share of the drive's force", 1),),
               "friction: grows with the drive's force", "Hamon, Gautier, Garrec 2010",
               where=places("joint", plain)),
        effect(laws.transmitted_load_friction,
               "at most μ |f_u - f_g| more, f_u the drive's force, f_g gravity's",
               (size("mu", 0.2, "", "share of the load that the gears transmit", 1),),
               "friction: grows with the transmitted load", load,
               where=places("joint", loaded)),
        effect(laws.gravity_load_friction, "at most μ |f_g| more, f_g gravity's force",
               (size("mu", 0.2, "", "share of gravity's force", 1),),
               "friction: grows with gravity's load", load, where=places("joint", heavy)),
        effect(laws.load_stribeck_friction, "at most μ_s |f_u - f_g| exp(-|v/v_s|) more",
               (size("mu_s", 0.2, "", "share of the transmitted load, at rest"),),
               "friction: Stribeck peak that grows with the transmitted load", load, (v_s,),
               where=places("joint", plain)),
        effect(laws.position_dependent_friction, "at most f_q q more",
               (size("f_q", 0.3 * F / A, f"{f}/{x}", "growth along the way"),),
               "friction: Coulomb level changes along the way"),
        force(laws.position_dependent_damping, "-d_q q v",
              (size("d_q", 0.3 * F / (V * A), f"{f} s/{x}^2", "growth along the way"),),
              "friction: viscous, changes along the way"),
        force(laws.offset, "f_0", (size("f_0", 0.2 * F, f, "constant force"),),
              "force: constant"),
        force(laws.stiffness, "-k q", (size("k", 0.3 * F / A, f"{f}/{x}", "of a spring", 1),),
              "spring: pulls back to zero"),
        force(laws.hardening, "-k_3 q³",
              (size("k_3", 0.3 * F / A**3, f"{f}/{x}^3", "of a spring that hardens, or softens"),),
              "spring: grows with the cube of the way", "Duffing 1918"),
    ]  # fmt: skip
    if n is not None:
        out += [
            effect(laws.periodic_friction, "at most a cos nq + b sin nq more", waves,
                   "friction: repeats along the way", shapes=(n,)),
            force(laws.cogging, "a cos nq + b sin nq", waves, "motor: cogging", "Krishnan 2010",
                  (n,)),
        ]  # fmt: skip
    return [e for e in out if e.places]


def _waves(kind: Kind, travel: float, turns: Sequence[float]) -> Shape | None:
    """How often a periodic force repeats: in a turn, or in 2π m of a slide.

    A wave of which the log shows fewer than `SEEN` periods is not seen to repeat: any curve would
    do as well. None where there is no wave to try.
    """
    least = 2 * pi * SEEN / travel
    if kind == "hinge":
        seen = tuple(n for n in turns if n >= least)
        if not seen:
            return None
        high = max(48.0, *seen)
        return Shape("n", "", seen, least, high, free=False, about="periods in a turn")
    grid = tuple(2 * pi * w / travel for w in WAVES)
    return Shape("n", "rad/m", grid, 0.9 * least, 4 * grid[-1], about="wave number")
