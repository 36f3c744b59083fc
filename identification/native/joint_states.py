"""The effects of joints with states of their own, inside MuJoCo's callbacks.

A motor behind the gear of a joint, at θ with the rate ω and the inertia J:

    J dω/dt = f_m - τ,    dθ/dt = ω                 f_m: force of the joint's own drives
    the joint feels τ in place of its drives         δ = θ - q,  dδ/dt = ω - v
    τ = (δ - dz(δ))/c + d dδ/dt                      dz: dead zone of half width ε
    d = 2 ζ √(J/c)

and friction that gives before it slips (Dahl 1968), whose force is p:

    c dp/dt = v - |v| p/b                            b: the largest friction

A step h resolves springs up to κ = m (X/h)² only, m being the inertia that swings on them. A stiffer
one is replaced by one that settles within some steps, and carries its load T beside: with r = κ c,
which is 1 where it is resolved,

    τ = (1 - r) T + κ (δ ∓ ε) + D dδ/dt,   T = m (f_m/J - a),   1/m = 1/J + 1/M_jj
    friction = min(max((1 - r) (M v/T_s + load) + r p, -b), b)

so that c = 0 is a rigid gear, and friction that holds as in `identification.native.joint_callback`.
a: acceleration of the joint without τ. Behind the parameters of the other effects a joint's row has
`GEARS` numbers more. The states are activations: θ and ω of one actuator, p of another.
"""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Sequence
from math import sqrt
from typing import Any

import mujoco
import numpy as np

from identification.native import structs
from identification.native.access import double, integer, offsets, word
from identification.native.compose import total
from identification.native.decorators import inlined
from identification.native.element import Element, Function, Hook, Term
from identification.native.joint_callback import FIELDS as JOINT_FIELDS
from identification.native.joint_callback import (
    FIRST,
    JOINT,
    LAST,
    STEPS,
    STOP,
    TAG,
    Joint,
    drive_force,
    inertia,
    joint,
)
from identification.native.joint_callback import D as JOINT_D
from identification.native.joint_callback import M as JOINT_M
from identification.native.memory import load_constant, load_double, load_int, store_double
from identification.native.table import is_compiled
from identification.native.tuples import replacer

GEARS = 8  # numbers of a row behind the parameters:
MOTOR, GRIP = 0, 1  # where θ and p stand among the activations, -1 where there is none
SIDE = 2  # 1: the drive's own feedback sees θ, 0: it sees q
COMPLIANCE, GAP, INERTIA, RATIO, SLIP = 3, 4, 5, 6, 7  # c, ε, J, ζ, and the friction's c
RESOLVED = 1.0  # X: RK4 then damps a swing by 7e-3 a step; semi-implicit Euler is stable up to 2
# κ h²/m and D h/m of what is far too stiff: each step halves what is left of δ and its rate, so that
# teeth that meet do not rebound ((1 - z)² and 1 - z² for two real roots z = 1/2 of such a step).
SETTLED, DAMPED = 0.25, 0.75
MOST_DAMPED = 1.2  # largest D h/m; with X such a step is stable up to 1.5

# What an effect with states sees of a joint: its inertia as its drive feels it [kg m² or kg]
Gear: Any = namedtuple("Gear", "inertia")

GEAR = Element(
    "gear",
    Gear,
    (
        Hook(
            "series",
            (
                "compliance [rad/(N m)] or [m/N]", "half the gap [rad] or [m]",
                "inertia of the motor [kg m²] or [kg]", "damping ratio",
                "1 where the encoder sits on the motor's side, 0 on the link's",
            ),
        ),
        Hook("slip", ("compliance of the friction that holds [rad/(N m)] or [m/N]",)),
    ),
)  # fmt: skip

M = offsets("mjModel", "nv actuator_actadr actuator_trntype actuator_trnid jnt_user M_colind")
D = offsets("mjData", "act act_dot qfrc_bias qLD qLDiagInv qfrc_smooth")
INTEGRATOR = structs.inner_byte("mjModel", "opt", "integrator")
FIELDS = JOINT_FIELDS | {*M._fields, *D._fields, "opt.integrator"}
_RK4, _JOINT = int(mujoco.mjtIntegrator.mjINT_RK4), int(mujoco.mjtTrn.mjTRN_JOINT)
_with_drive = replacer(Joint, "f_u")
_with_sign = replacer(Joint, "sign")


@inlined
def _gears(m, j):  # type: ignore[no-untyped-def]
    """Address of the numbers of joint j, behind those of the other effects."""
    columns = word(m, JOINT_M.nuser_jnt)
    return word(m, M.jnt_user) + 8 * (columns * (j + 1) - LAST - GEARS)


@inlined
def _is_geared(gears):  # type: ignore[no-untyped-def]
    """Whether the motor of a joint moves by itself."""
    return load_constant(gears + 8 * COMPLIANCE) != 0.0 or load_constant(gears + 8 * GAP) != 0.0


@inlined
def _spring(gears, mobility, h):  # type: ignore[no-untyped-def]
    """m, κ, r and D of a gear; mobility: 1/M_jj."""
    c, J = load_constant(gears + 8 * COMPLIANCE), load_constant(gears + 8 * INERTIA)
    swinging = 1.0 / (1.0 / J + mobility)
    stiff = swinging / h**2
    x2 = stiff * c  # 1/(ω h)², ω of the swing
    kappa = stiff * (SETTLED + (1.0 - SETTLED) * x2)
    if x2 > 1.0:
        kappa = 1.0 / c
    r = kappa * c
    damping = 2.0 * load_constant(gears + 8 * RATIO) * sqrt(J * kappa)
    damping += max(0.0, 1.0 - x2) * DAMPED * swinging / h
    return swinging, kappa, r, min(damping, MOST_DAMPED * swinging / h)


@inlined
def transmitted(load, delta, rate, gap, kappa, r, damping, h):  # type: ignore[no-untyped-def]
    """τ: what a gear passes on of a load, deflected by δ; each flank of the teeth only pushes.

    A flank is damped by no more than what stops it within a step, so that τ has no jumps.
    """
    rest = (1.0 - r) * load + kappa * delta
    if gap == 0.0:
        return rest + damping * rate
    most = damping / (kappa * h)
    ahead, behind = max(0.0, rest - kappa * gap), min(0.0, rest + kappa * gap)
    f = max(0.0, ahead + min(max(damping * rate, -most * ahead), most * ahead))
    return f + min(0.0, behind + min(max(damping * rate, most * behind), -most * behind))


@inlined
def _motor_force(m, d, j, gears):  # type: ignore[no-untyped-def]
    """f_m, the force of the drives on the motor of joint j, and the motor's θ and ω."""
    at = word(d, D.act) + 8 * np.int64(load_constant(gears + 8 * MOTOR))
    theta, omega = load_constant(at), load_constant(at + 8)
    if load_constant(gears + 8 * SIDE) != 0.0:
        return drive_force(m, d, j, theta, omega), theta, omega
    q = double(d, JOINT_D.qpos, integer(m, JOINT_M.jnt_qposadr, j))
    v = double(d, JOINT_D.qvel, integer(m, JOINT_M.jnt_dofadr, j))
    return drive_force(m, d, j, q, v), theta, omega


@inlined
def _felt(m, d, j, row, gears, h):  # type: ignore[no-untyped-def]
    """The state of a joint with f_u as the joint feels it, and the inertia that friction stops.

    The load of a gear that is not resolved is taken for f_m here, as of a motor that rests.
    """
    s, M_jj = joint(m, d, j, row), inertia(m, d, integer(m, JOINT_M.jnt_dofadr, j))
    if not _is_geared(gears):
        return s, M_jj
    f_m, theta, omega = _motor_force(m, d, j, gears)
    swinging, kappa, r, damping = _spring(gears, 1.0 / M_jj, h)
    gap = load_constant(gears + 8 * GAP)
    f = transmitted(f_m, theta - s.q, omega - s.v, gap, kappa, r, damping, h)
    M_jj += (1.0 - r) * load_constant(gears + 8 * INERTIA)
    return _with_drive(s, (f,)), M_jj


@inlined
def solve(m, d, x):  # type: ignore[no-untyped-def]
    """M⁻¹ x in place, x an address; M = Lᵀ D L as MuJoCo has it factorised."""
    n, L = word(m, M.nv), word(d, D.qLD)
    for i in range(n - 1, -1, -1):
        first, count = integer(m, JOINT_M.M_rowadr, i), integer(m, JOINT_M.M_rownnz, i)
        for k in range(first, first + count - 1):
            at = x + 8 * integer(m, M.M_colind, k)
            store_double(at, load_double(at) - load_double(L + 8 * k) * load_double(x + 8 * i))
    for i in range(n):
        store_double(x + 8 * i, load_double(x + 8 * i) * double(d, D.qLDiagInv, i))
    for i in range(n):
        first, count = integer(m, JOINT_M.M_rowadr, i), integer(m, JOINT_M.M_rownnz, i)
        for k in range(first, first + count - 1):
            less = load_double(L + 8 * k) * load_double(x + 8 * integer(m, M.M_colind, k))
            store_double(x + 8 * i, load_double(x + 8 * i) - less)


@inlined
def _through(m, d, j, gears, key, h):  # type: ignore[no-untyped-def]
    """τ and f_m of joint j, behind MuJoCo's velocity stage; qfrc_smooth is used as room."""
    f_m, theta, omega = _motor_force(m, d, j, gears)
    dof, x = integer(m, JOINT_M.jnt_dofadr, j), word(d, D.qfrc_smooth)
    for i in range(word(m, M.nv)):
        store_double(x + 8 * i, 0.0)
    store_double(x + 8 * dof, 1.0)
    solve(m, d, x)
    swinging, kappa, r, damping = _spring(gears, load_double(x + 8 * dof), h)
    load = 0.0
    if r < 1.0:  # else it is not needed
        passive = word(d, JOINT_D.qfrc_passive)
        for i in range(word(m, M.nv)):
            f = load_double(passive + 8 * i) - double(d, D.qfrc_bias, i)
            store_double(x + 8 * i, f)
        for k in range(word(m, JOINT_M.njnt)):
            if k == j:
                continue
            f, own = 0.0, _gears(m, k)
            at = x + 8 * integer(m, JOINT_M.jnt_dofadr, k)
            tagged = own + 8 * (GEARS + LAST - 1)
            if load_constant(tagged) == TAG and load_constant(tagged - 8) == key:
                s, _ = _felt(m, d, k, own, own, h)
                f = s.f_u
            else:
                q = double(d, JOINT_D.qpos, integer(m, JOINT_M.jnt_qposadr, k))
                v = double(d, JOINT_D.qvel, integer(m, JOINT_M.jnt_dofadr, k))
                f = drive_force(m, d, k, q, v)
            if f == f:  # where it is known
                store_double(at, load_double(at) + f)
        solve(m, d, x)
        J = load_constant(gears + 8 * INERTIA)
        load = swinging * (f_m / J - load_double(x + 8 * dof))
    q = double(d, JOINT_D.qpos, integer(m, JOINT_M.jnt_qposadr, j))
    v = double(d, JOINT_D.qvel, dof)
    gap = load_constant(gears + 8 * GAP)
    return transmitted(load, theta - q, omega - v, gap, kappa, r, damping, h), f_m


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
            or integer(m, M.actuator_trntype, i) != _JOINT
            or integer(m, M.actuator_actadr, i) < 0
        ):
            return -1
        j = integer(m, M.actuator_trnid, 2 * i)
        end = _gears(m, j) + 8 * (GEARS + LAST)
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
            s, M_jj = _felt(m, d, j, row, gears, stop / STEPS)
            f = force(s, row + 8 * FIRST, 0)
            driven = f + s.f_g + load_double(at)
            if s.f_u == s.f_u:  # where it is known
                driven += s.f_u
            r = driven + M_jj * s.v / stop
            c = load_constant(gears + 8 * SLIP)
            if c != 0.0:
                held = min(1.0, c * M_jj * (RESOLVED * STEPS / stop) ** 2)
                p = word(d, D.act) + 8 * np.int64(load_constant(gears + 8 * GRIP))
                r = (1.0 - held) * r + held * load_constant(p)
            ahead = 1.0 if r > 0.0 else -1.0
            b = max(0.0, friction(_with_sign(s, (ahead,)), row + 8 * FIRST, 0))
            f -= max(-b, min(b, r))
            if f != 0.0:
                store_double(at, load_double(at) + f)

    def act_dyn(m, d, i):  # type: ignore[no-untyped-def]
        j = mine(m, i)
        if j < 0:
            return 0.0
        gears, place = _gears(m, j), integer(m, M.actuator_actadr, i)
        row = gears + 8 * (GEARS + LAST - entries)
        out, h = word(d, D.act_dot) + 8 * place, load_constant(row + 8 * STOP) / STEPS
        semi = 0.0 if load_int(m + INTEGRATOR) == _RK4 else h  # such a step moves q by the new v
        if np.int64(load_constant(gears + 8 * MOTOR)) == place:
            store_double(out, 0.0)
            store_double(out + 8, 0.0)
            if _is_geared(gears):
                tau, f_m = _through(m, d, j, gears, key, h)
                rate = (f_m - tau) / load_constant(gears + 8 * INERTIA)
                store_double(out, double(d, D.act, place + 1) + semi * rate)
                store_double(out + 8, rate)
            return 0.0
        c = load_constant(gears + 8 * SLIP)
        if np.int64(load_constant(gears + 8 * GRIP)) != place or c == 0.0:
            return 0.0
        s, M_jj = _felt(m, d, j, row, gears, h)
        f = load_double(word(d, JOINT_D.qfrc_passive) + 8 * integer(m, JOINT_M.jnt_dofadr, j))
        f += s.f_g
        if s.f_u == s.f_u:
            f += s.f_u
        v, p = s.v + semi * f / M_jj, double(d, D.act, place)
        b = max(0.0, friction(_with_sign(s, (1.0 if v > 0.0 else -1.0,)), row + 8 * FIRST, 0))
        if b == 0.0:
            return -p / h
        return (v - abs(v) * p / b) / max(c, abs(v) * h / b)

    def act_bias(m, d, i):  # type: ignore[no-untyped-def]
        j = mine(m, i)
        if j < 0:
            return 0.0
        gears = _gears(m, j)
        if np.int64(load_constant(gears + 8 * MOTOR)) != integer(m, M.actuator_actadr, i):
            return 0.0
        if not _is_geared(gears):
            return 0.0
        row = gears + 8 * (GEARS + LAST - entries)
        tau, _ = _through(m, d, j, gears, key, load_constant(row + 8 * STOP) / STEPS)
        q = double(d, JOINT_D.qpos, integer(m, JOINT_M.jnt_qposadr, j))
        v = double(d, JOINT_D.qvel, integer(m, JOINT_M.jnt_dofadr, j))
        return tau - drive_force(m, d, j, q, v)

    return {"passive": passive, "act_dyn": act_dyn, "act_bias": act_bias}
