"""Candidate effects of the bodies that a robot moves; their laws are in `body_laws`."""

from __future__ import annotations

from collections.abc import Sequence

import mujoco

from identification.effects import body_laws as laws
from identification.effects.effect import Effect, Size
from identification.effects.moving_bodies import Felt, MovingBody, movable, moving_bodies

PROBE = 0.02  # of the largest plausible size
LEAST = 1e-2  # a body that reaches no farther than this is taken to reach so far [m]
WENSING = "Wensing, Kim, Slotine 2018"


def body_effects(spec: mujoco.MjSpec) -> tuple[Effect, ...]:
    """Returns all candidates of the bodies of a robot: each acts on one body.

    A size of which no body's motion says anything is left out: a displacement of the centre of mass
    along the axis about which the robot turns, an inertia of what only slides.

    Args:
        spec: of the robot, which is not changed.
    """
    model = movable(spec)
    bodies = moving_bodies(model)
    if not bodies:
        return ()
    felt = Felt(model)
    turning = [b for b in bodies if felt.is_turning(b)]
    off = [b for b in bodies if felt.axes(b)]
    last = [b for b in off if b.is_last]
    mass = max(b.mass for b in bodies)
    way = 0.3 * max(LEAST, *(b.reach for b in bodies))
    axes = [a for a in "xyz" if any(a in felt.axes(b) for b in off)]
    out = [_effect("mass_mismatch", "m + Δm, shape unchanged",
                   (_size("dm", "kg", 0.3 * mass, "what its mass has more"),), bodies,
                   "body: another mass")]  # fmt: skip
    if off:
        sizes = tuple(_size(a, "m", way, f"displacement along {a} of its frame") for a in axes)
        out.append(_effect("com_offset", "c + d, d in the body's frame", sizes, off,
                           "body: centre of mass displaced"))  # fmt: skip
    if turning:
        out.append(_effect("inertia_mismatch", "(1 + δ) I_c",
                           (_size("delta", "", 0.5, "relative, about its centre of mass"),),
                           turning, "body: another inertia"))  # fmt: skip
    if last:
        at = "; ".join("{}: ({:.3g}, {:.3g}, {:.3g}) m".format(b.label, *b.point) for b in last)
        out.append(_effect("payload", f"a point mass M at the farthest point of its frame ({at})",
                           (Size("M", "kg", 2 * mass, 0.01 * mass, 1, "mass of the payload"),),
                           last, "body: a payload at its end"))  # fmt: skip
    return tuple(out)


def _size(name: str, unit: str, largest: float, about: str) -> Size:
    return Size(name, unit, largest, PROBE * largest, 0, about)


def _effect(
    name: str, law: str, sizes: tuple[Size, ...], bodies: Sequence[MovingBody], phrase: str
) -> Effect:
    functions = {"mass_mismatch": laws.mass_mismatch, "inertia_mismatch": laws.inertia_mismatch,
                 "payload": laws.payload}  # fmt: skip
    function = functions.get(name) or laws.displaced("".join(s.name for s in sizes))
    return Effect(
        name, law, sizes, places={f"body {b.label}": f"@{b.label}" for b in bodies},
        phrase=phrase, reference=WENSING, hooks={"inertia": function},
    )  # fmt: skip
