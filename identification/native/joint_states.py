"""The effects of joints with states of their own, inside MuJoCo's callbacks.

    mjcb_passive     friction and forces, as in `identification.native.joint_friction`; where gears
                     swing, of the joint behind its gear
    mjcb_act_dyn     rates of θ, ω and p
    mjcb_act_bias    τ in place of the drives' force, by the actuator that carries θ and ω

`identification.native.gear` has the laws. MuJoCo asks all actuators for rates before it asks any
for its force: the first one with states finds τ for all joints (`native.transmission`). A
semi-implicit step moves q by the new rate, so that the rates of θ and p are those at the end of
such a step too; without the damping that such steps take implicitly.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification.native.access import double, integer, word
from identification.native.compose import total
from identification.native.decorators import inlined
from identification.native.element import Function, Term
from identification.native.gear import (
    GEARS,
    GRIP,
    INERTIA,
    INTEGRATOR,
    IS_JOINT,
    MOTOR,
    RK4,
    SLIP,
    TIMESTEP,
    D,
    M,
    felt,
    gears_of,
    is_geared,
    motor_force,
)
from identification.native.joint_callback import FIRST, JOINT, LAST, drive_force
from identification.native.joint_callback import D as JOINT_D
from identification.native.joint_callback import M as JOINT_M
from identification.native.joint_friction import passive_force, with_sign
from identification.native.memory import load_constant, load_double, load_int, store_double
from identification.native.transmission import is_ours, transmit


def width(terms: Sequence[Term]) -> int:
    """Returns how many entries a joint's row has with some effects and its states' numbers."""
    return FIRST + sum(len(term.names) for term in terms) + GEARS + LAST


def callbacks(terms: Sequence[Term], key: float) -> dict[str, Function]:
    """Returns the callbacks of a set of joint effects in a plant with states, to be compiled.

    Args:
        terms: the effects without states, their columns counted from the first parameter of a row.
        key: of the set.
    """
    friction, entries = total(JOINT, terms, "friction"), width(terms)

    @inlined
    def felt_of(m, d, j, row, end):  # type: ignore[no-untyped-def]
        gears, p = end - 8 * (GEARS + LAST), 0.0
        s, more = felt(m, d, j, row, gears)
        c = load_constant(gears + 8 * SLIP)
        if c != 0.0:
            p = double(d, D.act, np.int64(load_constant(gears + 8 * GRIP)))
        return s, more, c, p

    @inlined
    def mine(m, i):  # type: ignore[no-untyped-def]
        """Returns the joint of an actuator that carries states of this law; -1 if it does not."""
        if (
            i < 0
            or word(m, JOINT_M.nuser_jnt) < entries
            or integer(m, M.actuator_trntype, i) != IS_JOINT
            or integer(m, M.actuator_actadr, i) < 0
        ):
            return -1
        j, place = integer(m, M.actuator_trnid, 2 * i), integer(m, M.actuator_actadr, i)
        if not is_ours(m, j, key):
            return -1
        gears = gears_of(m, j)
        own = np.int64(load_constant(gears + 8 * MOTOR)), np.int64(load_constant(gears + 8 * GRIP))
        return j if place in own else -1

    def act_dyn(m, d, i):  # type: ignore[no-untyped-def]
        j = mine(m, i)
        if j < 0:
            return 0.0
        gears, place = gears_of(m, j), integer(m, M.actuator_actadr, i)
        dof = integer(m, JOINT_M.jnt_dofadr, j)
        out, h = word(d, D.act_dot) + 8 * place, load_constant(m + TIMESTEP)
        semi = 0.0 if load_int(m + INTEGRATOR) == RK4 else h  # such a step moves q by the new v
        if mine(m, i - 1) < 0:  # these actuators stand in a row
            transmit(m, d, key, semi != 0.0)
        if np.int64(load_constant(gears + 8 * MOTOR)) == place:
            store_double(out, 0.0)
            store_double(out + 8, 0.0)
            if is_geared(gears):
                f_m, _, _ = motor_force(m, d, j, gears)
                tau = load_double(word(d, D.qfrc_actuator) + 8 * dof)
                rate = (f_m - tau) / load_constant(gears + 8 * INERTIA)
                store_double(out, double(d, D.act, place + 1) + semi * rate)
                store_double(out + 8, rate)
            return 0.0
        c = load_constant(gears + 8 * SLIP)
        if np.int64(load_constant(gears + 8 * GRIP)) != place or c == 0.0:
            return 0.0
        row = gears + 8 * (GEARS + LAST - entries)
        s, _ = felt(m, d, j, row, gears)
        v, p = s.v, double(d, D.act, place)
        if semi != 0.0:
            v += semi * load_double(word(d, D.qacc_smooth) + 8 * dof)
        b = max(0.0, friction(with_sign(s, (1.0 if v > 0.0 else -1.0,)), row + 8 * FIRST, 0))
        if b == 0.0:
            return -p / h
        return (v - abs(v) * p / b) / max(c, abs(v) * h / b)

    def act_bias(m, d, i):  # type: ignore[no-untyped-def]
        j = mine(m, i)
        if j < 0:
            return 0.0
        gears = gears_of(m, j)
        if np.int64(load_constant(gears + 8 * MOTOR)) != integer(m, M.actuator_actadr, i):
            return 0.0
        if not is_geared(gears):
            return 0.0
        dof = integer(m, JOINT_M.jnt_dofadr, j)
        q = double(d, JOINT_D.qpos, integer(m, JOINT_M.jnt_qposadr, j))
        v = double(d, JOINT_D.qvel, dof)
        return load_double(word(d, D.qfrc_actuator) + 8 * dof) - drive_force(m, d, j, q, v)

    passive = passive_force(terms, key, entries, felt_of)
    return {"passive": passive, "act_dyn": act_dyn, "act_bias": act_bias}
