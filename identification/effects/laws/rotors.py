"""Another rotor inertia at a joint: the drawing of a link seldom has that of its motor.

    M_jj = M_jj(bodies) + a + Δa          a: armature of the joint, Δa: the size of the effect

A rotor of the inertia J_m behind a gear of the ratio N has a = N² J_m. It does not move with the
link, so that the joints before its own do not feel it: it is no inertia of a body, but for a joint
on the frame, where the two act alike. The law is called before the simulation, as plain Python.
"""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np
from numba import njit

from identification.effects.effect import Effect
from identification.effects.laws.joint_group import Group
from identification.effects.values import Values, is_present, table_at
from identification.errors import InputError
from identification.model.paths import Slot
from identification.model.predictor import Numbers
from identification.native.element import Element, Hook

HOOK = "armature"
Rotor: Any = namedtuple("Rotor", "a")  # armature as the robot's own parameters make it
ROTOR = Element("rotor", Rotor, (Hook(HOOK, ("armature [kg m²] or [kg]",)),))
LARGEST = 2.0  # of the largest inertia that a joint swings: behind a large gear a rotor has more


@njit
def rotor_inertia(s, p):
    (more,) = p
    return more


def rotor_effects(g: Group, timestep: float) -> list[Effect]:
    """Returns the candidate of some joints; none where no inertia of theirs is known.

    Args:
        g: the joints.
        timestep: of the model [s].
    """
    inertias = [timestep**2 / a.give for a in g.axes if a.give > 0]
    if not inertias:
        return []
    unit = "kg m^2" if g.kind == "hinge" else "kg"
    size = g.size("a", LARGEST * max(inertias), unit, "inertia that is added to its armature")
    return [g.effect(HOOK, rotor_inertia, "armature + a", "motor: another rotor inertia", size)]


def rotor_numbers(
    model: mujoco.MjModel, effects: Sequence[Effect], joints: Sequence[str],
    names: Sequence[str], values: Values, own: Numbers, n: int,
) -> Numbers:  # fmt: skip
    """Returns the armatures that effects change, in n value sets.

    Raises:
        InputError: an armature would be negative.
    """
    acting = [e for e in effects if HOOK in e.hooks]
    out: list[tuple[Slot, np.ndarray]] = []
    for joint in joints:
        here = [e for e in acting if e.parameters_at(joint)]
        touched = {p for e in here for parts in e.parameters_at(joint) for p in parts}
        if not (touched & {*names} or any(is_present(e, [joint], values) for e in here)):
            continue
        dof = int(model.joint(joint).dofadr[0])
        a = np.full(n, float(model.dof_armature[dof]))
        for slot, column in own:
            if slot.field == "dof_armature" and dof in slot.rows:
                a = np.array(np.broadcast_to(column, n))
        for e in here:
            table = table_at([e], joint, values, n)
            law = e.hooks[HOOK].py_func  # type: ignore[attr-defined]
            a += [law(Rotor(before), tuple(p)) for before, p in zip(a, table, strict=True)]
        if np.any(a < 0):
            raise InputError(
                f"joint {joint!r} would have a rotor inertia of {a.min():.3g}; take other sizes"
            )
        out.append((Slot("dof_armature", (dof,), None), a))
    return out
