"""The effects of joints with states of their own, inside MuJoCo's callbacks.

    mjcb_passive     friction and forces, as in `identification.native.joint_callback`; where gears
                     swing, of the joint behind its gear
    mjcb_act_dyn     rates of θ, ω and p
    mjcb_act_bias    τ in place of the drives' force, by the actuator that carries θ and ω

`identification.native.gear` has the laws. A semi-implicit step moves q by the new rate, so that the
rates of θ and p are those at the end of such a step too.
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
    RESOLVED,
    RK4,
    SLIP,
    TIMESTEP,
    D,
    M,
    felt,
    gears_of,
    is_geared,
    through,
    with_sign,
)
from identification.native.joint_callback import FIRST, JOINT, LAST, STOP, TAG, drive_force
from identification.native.joint_callback import D as JOINT_D
from identification.native.joint_callback import M as JOINT_M
from identification.native.memory import load_constant, load_double, load_int, store_double
from identification.native.table import is_compiled


def width(terms: Sequence[Term]) -> int:
    """Entries of a joint's row with some effects, and with the numbers of its states."""
    return FIRST + sum(len(term.names) for term in terms) + GEARS + LAST


def callbacks(terms: Sequence[Term], key: float) -> dict[str, Function]:
    """The callbacks of a set of joint effects in a plant with states, to be compiled.

    Args:
        terms: the effects without states, their columns counted from the first parameter of a row.
        key: of the set.
    """
    force, friction = total(JOINT, terms, "force"), total(JOINT, terms, "friction")
    entries = width(terms)

    @inlined
    def mine(m, i):  # type: ignore[no-untyped-def]
        """The joint of an actuator that carries states of this law; -1 where it does not."""
        if (
            word(m, JOINT_M.nuser_jnt) < entries
            or integer(m, M.actuator_trntype, i) != IS_JOINT
            or integer(m, M.actuator_actadr, i) < 0
        ):
            return -1
        j = integer(m, M.actuator_trnid, 2 * i)
        end = gears_of(m, j) + 8 * (GEARS + LAST)
        if load_constant(end - 8) != TAG or load_constant(end - 16) != key:
            return -1
        return j

    def passive(m, d):  # type: ignore[no-untyped-def]
        columns = word(m, JOINT_M.nuser_jnt)
        if columns < LAST:
            return
        for j in range(word(m, JOINT_M.njnt)):
            end = word(m, JOINT_M.jnt_user) + 8 * columns * (j + 1)
            if load_constant(end - 8) != TAG:
                continue
            dof = integer(m, JOINT_M.jnt_dofadr, j)
            at = word(d, JOINT_D.qfrc_passive) + 8 * dof
            own = load_constant(end - 16)
            if own != key:
                if not is_compiled(own):
                    store_double(at, np.nan)
                continue
            row, gears = end - 8 * entries, end - 8 * (GEARS + LAST)
            stop = load_constant(row + 8 * STOP)
            s, M_jj = felt(m, d, j, row, gears, load_constant(m + TIMESTEP))
            f = force(s, row + 8 * FIRST, 0)
            driven = f + s.f_g + load_double(at)
            if s.f_u == s.f_u:  # where it is known
                driven += s.f_u
            r = driven + M_jj * s.v / stop
            c = load_constant(gears + 8 * SLIP)
            if c != 0.0:
                held = min(1.0, c * M_jj * (RESOLVED / load_constant(m + TIMESTEP)) ** 2)
                p = word(d, D.act) + 8 * np.int64(load_constant(gears + 8 * GRIP))
                r = (1.0 - held) * r + held * load_constant(p)
            ahead = 1.0 if r > 0.0 else -1.0
            b = max(0.0, friction(with_sign(s, (ahead,)), row + 8 * FIRST, 0))
            f -= max(-b, min(b, r))
            if f != 0.0:
                store_double(at, load_double(at) + f)

    def act_dyn(m, d, i):  # type: ignore[no-untyped-def]
        j = mine(m, i)
        if j < 0:
            return 0.0
        gears, place = gears_of(m, j), integer(m, M.actuator_actadr, i)
        row = gears + 8 * (GEARS + LAST - entries)
        out, h = word(d, D.act_dot) + 8 * place, load_constant(m + TIMESTEP)
        semi = 0.0 if load_int(m + INTEGRATOR) == RK4 else h  # such a step moves q by the new v
        if np.int64(load_constant(gears + 8 * MOTOR)) == place:
            store_double(out, 0.0)
            store_double(out + 8, 0.0)
            if is_geared(gears):
                tau, f_m = through(m, d, j, gears, key, h)
                rate = (f_m - tau) / load_constant(gears + 8 * INERTIA)
                store_double(out, double(d, D.act, place + 1) + semi * rate)
                store_double(out + 8, rate)
            return 0.0
        c = load_constant(gears + 8 * SLIP)
        if np.int64(load_constant(gears + 8 * GRIP)) != place or c == 0.0:
            return 0.0
        s, M_jj = felt(m, d, j, row, gears, h)
        f = load_double(word(d, JOINT_D.qfrc_passive) + 8 * integer(m, JOINT_M.jnt_dofadr, j))
        f += s.f_g
        if s.f_u == s.f_u:
            f += s.f_u
        v, p = s.v + semi * f / M_jj, double(d, D.act, place)
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
        tau, _ = through(m, d, j, gears, key, load_constant(m + TIMESTEP))
        q = double(d, JOINT_D.qpos, integer(m, JOINT_M.jnt_qposadr, j))
        v = double(d, JOINT_D.qvel, integer(m, JOINT_M.jnt_dofadr, j))
        return tau - drive_force(m, d, j, q, v)

    return {"passive": passive, "act_dyn": act_dyn, "act_bias": act_bias}
