"""Laws, compiled and installed in this process, and the share of one actuator in their rates.

A law is the passive force, and what else MuJoCo asks callbacks for, of one set of effects. Several
laws work side by side (see `identification.native.table`).

    M q̈ = f + Σ_i f_i(q, v, a_i, p_i),    ȧ_i = g_i(q, v, a_i, p_i)

f_i are the forces of actuator i with all that its law adds, a_i its activations, p_i the numbers
that it alone reads: its share. Another value of p_i or a_i changes nothing but f_i and g_i, so that
the change of the rates is M⁻¹ Δf_i and Δg_i. The same holds of the angle and the rate of a balanced
rotor that turns in the frame (`is_balanced_rotor`). It costs the law of one actuator and no other
law, no actuators and no kinematics. It holds where no constraint acts, which would answer the
force, and where nothing else adds forces to those of the actuator.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache
from threading import Lock
from typing import Any

import mujoco
import numpy as np

from identification.native import structs
from identification.native.cache import compile_once
from identification.native.element import Function
from identification.native.memory import internal, load_word
from identification.native.table import (
    KINDS,
    SHARE,
    SIGNATURES,
    callback,
    caller,
    enter,
    hold,
    refuse_foreign,
    table,
)

# (array of the model, row in it) or (field of the state, index in it) -> actuator
Owners = Mapping[tuple[str, int], int]

_ENTERING = Lock()  # one thread at a time enters a law
_ENTERED: dict[tuple[str, float], Law] = {}  # the laws of this process


@dataclass(frozen=True, eq=False)
class Law:
    """Callbacks of one set of effects."""

    name: str  # of what they act on, e.g. "joints".
    # what its models carry; two laws with one key are one law, of which the newer counts
    key: float
    # kind of callback ("passive", "act_dyn", …) -> the function to be compiled; the kind "share"
    # where an actuator's share is given too
    functions: Mapping[str, Function]
    fields: frozenset[str]  # the fields of mjModel and mjData that they touch
    # raises `InputError` where a function of an effect cannot be compiled
    check: Callable[[], None]
    # which numbers of a model an actuator of this law alone reads; none of a model that carries
    # another key
    owners: Callable[[mujoco.MjModel], Owners] = field(default=lambda model: {})


def install(law: Law) -> None:
    """Install a law in this process; does nothing when it is installed already."""
    with _ENTERING:
        for kind in KINDS & law.functions.keys():
            refuse_foreign(kind)
        compiled = _compiled(law)
        for kind, address in _addresses(law).items():
            laws = enter(kind, law.key, address)
            if kind != SHARE:
                hold(kind, compiled[kind] if laws == 1 else None)
        _ENTERED[law.name, law.key] = law


@cache  # for the life of the process: MuJoCo holds bare pointers
def _compiled(law: Law) -> Mapping[str, Any]:
    structs.require(law.fields)
    try:
        return {
            kind: compile_once(function, SIGNATURES[kind])
            for kind, function in law.functions.items()
        }
    except Exception:
        law.check()
        raise


@cache
def _addresses(law: Law) -> Mapping[str, int]:
    pointers = {k: ctypes.cast(f, ctypes.c_void_p).value for k, f in _compiled(law).items()}
    return {kind: address for kind, address in pointers.items() if address is not None}


_BITS = mujoco.mjtDisableBit
_ANSWERED, _LEFT_OUT = (
    int(_BITS.mjDSBL_CONSTRAINT), int(_BITS.mjDSBL_ACTUATION | _BITS.mjDSBL_DAMPER)
)  # fmt: skip

# What limits the force of an actuator, or adds to it what its share does not have.
_OTHER_FORCES = (
    "actuator_forcelimited", "actuator_actlimited", "jnt_actfrclimited", "jnt_actgravcomp",
    "actuator_gainprm", "actuator_damping", "actuator_dampingpoly", "tendon_stiffness",
    "tendon_stiffnesspoly", "tendon_damping", "tendon_dampingpoly", "dof_dampingpoly",
    "jnt_stiffnesspoly",
)  # fmt: skip

_laws_of, _call = table(SHARE), caller(SIGNATURES[SHARE])


def has_shares(model: mujoco.MjModel) -> bool:
    """Returns whether the share of an actuator may be taken alone, where its law gives one."""
    option = model.opt
    is_free = option.disableflags & _ANSWERED and not option.disableflags & _LEFT_OUT
    rest = [np.any(getattr(model, field)) for field in _OTHER_FORCES]
    rest += [option.density, option.viscosity, option.disableactuator]
    return bool(is_free) and not any(rest)


def is_balanced_rotor(model: mujoco.MjModel, joint: int) -> bool:
    """Returns whether a joint turns a body in the frame whose angle no gravity or spring feels."""
    body = int(model.jnt_bodyid[joint])
    off = np.cross(model.body_ipos[body] - model.jnt_pos[joint], model.jnt_axis[joint])
    return bool(
        model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_HINGE
        and model.body_dofnum[body] == 1
        and not model.body_weldid[model.body_parentid[body]]
        and body not in model.body_parentid[1:]
        and not model.jnt_stiffness[joint]
        and not off.any()
        and not (model.site_bodyid == body).any()
    )


@internal
def add_share(m, d, i):
    """Add f_i to `qfrc_passive`, and put g_i into `act_dot`."""
    laws = _laws_of()
    for k in range(load_word(laws) - 1, -1, -1):
        if _call(callback(laws, k), (m, d, i)) != 0.0:
            return


def owners_of(model: mujoco.MjModel) -> Owners:
    """Returns which numbers of a model one actuator alone reads, by array and row."""
    if not has_shares(model):
        return {}
    return {entry: i for law in [*_ENTERED.values()] for entry, i in law.owners(model).items()}
