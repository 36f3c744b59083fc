"""A motor behind its gear, and friction that gives: what they put on a joint.

A motor behind the gear of a joint, at θ with the rate ω and the inertia J:

    J dω/dt = f_m - τ,    dθ/dt = ω                 f_m: force of the joint's own drives - d_m ω
    the joint feels τ in place of its drives         δ = θ - q,  dδ/dt = ω - v
    τ = (δ - dz(δ))/c + d dδ/dt                      dz: dead zone of half width ε
    d = 2 ζ √(J/c)

and friction that gives before it slips (Dahl 1968), whose force is p:

    c dp/dt = v - |v| p/b                            b: the largest friction

A step h resolves springs up to κ = m (X/h)² only, m being the inertia that swings on them. One
that is stiffer is replaced by one that settles within some steps, and carries its load T beside:
with r = κ c, which is 1 where it is resolved,

    τ = (1 - r) T + κ (δ ∓ ε) + D dδ/dt,   T = m (f_m/J - a),   1/m = 1/J + A,   A = (M⁻¹)_jj
    friction = min(max((1 - r) (M v/T_s + load) + r p, -b), b)

so that c = 0 is a rigid gear, and friction that holds as in `native.joint_friction`; of several
joints, see `native.holding`. a = dv/dt - A τ is the acceleration of the joint without its own τ, so
that d²δ/dt² = (r T - κ (δ ∓ ε) - D dδ/dt)/m however joints pull at each other. As a function of the
joint's own acceleration

    τ = f - I dv/dt,   I = β J,   f = γ τ(T = f_m) - β J A f_m                           (felt)
    β = (1 - r)/(1 + r J A),   γ = (1 + J A)/(1 + r J A)

f is the drive that the joint feels, and I what is left of the motor's inertia: with r = 0 they are
f_m and J, with r = 1 τ and 0.

A position servo with an integral part, which is a part of the joint's drive within its limits:

    f_i = clip(f_s + k_i z, f_low, f_high) - clip(f_s, f_low, f_high),    dz/dt = e

Behind the parameters of the other effects a joint's row has `GEARS` numbers more. The states are
activations: θ and ω of one actuator, p of another, z of a third.
"""

from __future__ import annotations

from collections import namedtuple
from math import sqrt
from typing import Any

import mujoco
import numpy as np

from identification.native import structs
from identification.native.element import Element, Hook
from identification.native.joints.holding import RESOLVED
from identification.native.joints.joint_callback import FIELDS as JOINT_FIELDS
from identification.native.joints.joint_callback import LAST, TIMESTEP, D, Joint, M, drive, joint
from identification.native.library import FIELDS as MASS_FIELDS
from identification.native.library import mobility
from identification.native.memory import (
    double,
    inlined,
    integer,
    load_constant,
    replacer,
    word,
)

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
                "viscous friction of the motor, d_m [N m s/rad] or [N s/m]",
            ),
        ),
        Hook("slip", ("compliance of the friction that holds [rad/(N m)] or [m/N]",)),
        Hook("integral", ("integral gain of the servo [N m/(rad s)] or [N/(m s)]",)),
    ),
)  # fmt: skip


GEARS = 11  # numbers of a row behind the parameters:
MOTOR, GRIP, SUM = 0, 1, 2  # where θ, p and z stand among the activations, -1 where there is none
SIDE = 3  # 1: the drive's own feedback sees θ, 0: it sees q
# c, ε, J, ζ, the friction's c, d_m and k_i
COMPLIANCE, GAP, INERTIA, RATIO, SLIP, DRAG, INTEGRAL = 4, 5, 6, 7, 8, 9, 10
# κ h²/m and D h/m of what is far too stiff: a semi-implicit step halves what is left of δ and its
# rate ((1 - z)² and 1 - z² for a double root z = 1/2), and teeth rebound by a quarter at most.
SETTLED, DAMPED = 0.25, 0.75
MOST_DAMPED = 1.2  # largest D h/m; with X such a step is stable up to 1.5

INTEGRATOR = structs.option_byte("integrator")
FIELDS = JOINT_FIELDS | MASS_FIELDS | {"opt.integrator"}
RK4, IS_JOINT = int(mujoco.mjtIntegrator.mjINT_RK4), int(mujoco.mjtTrn.mjTRN_JOINT)
_with_drive = replacer(Joint, "f_u")


@inlined
def gears_of(m, j):
    """Returns the address of the gear's numbers of joint j, behind those of the other effects."""
    columns = word(m, M.nuser_jnt)
    return word(m, M.jnt_user) + 8 * (columns * (j + 1) - LAST - GEARS)


@inlined
def is_geared(gears):
    """Returns whether the motor of a joint moves by itself."""
    return load_constant(gears + 8 * COMPLIANCE) != 0.0 or load_constant(gears + 8 * GAP) != 0.0


@inlined
def integral_force(d, gears, f_s, f_low, f_high):
    """Returns f_i, what the integral part of a servo adds to its force."""
    k_i = load_constant(gears + 8 * INTEGRAL)
    if k_i == 0.0:
        return 0.0
    f = f_s + k_i * double(d, D.act, np.int64(load_constant(gears + 8 * SUM)))
    return max(f_low, min(f_high, f)) - max(f_low, min(f_high, f_s))


@inlined
def whole_drive(m, d, j, q, v, gears):
    """Returns the force of the actuators on joint j with the integral part of its servo."""
    f_u, _, _, f_s, f_low, f_high = drive(m, d, j, q, v)
    return f_u + integral_force(d, gears, f_s, f_low, f_high)


@inlined
def spring(gears, A, h):
    """Returns m, κ, r and D of a gear."""
    c, J = load_constant(gears + 8 * COMPLIANCE), load_constant(gears + 8 * INERTIA)
    swinging = 1.0 / (1.0 / J + A)
    stiff = swinging / h**2
    x2 = RESOLVED**2 * stiff * c  # (X/(ω h))², ω of the swing
    kappa = stiff * (SETTLED + (RESOLVED**2 - SETTLED) * x2)
    if x2 > 1.0:
        kappa = 1.0 / c
    r = kappa * c
    damping = 2.0 * load_constant(gears + 8 * RATIO) * sqrt(J * kappa)
    damping += max(0.0, 1.0 - x2) * DAMPED * swinging / h
    return swinging, kappa, r, min(damping, MOST_DAMPED * swinging / h)


@inlined
def transmitted(load, delta, rate, gap, kappa, r, damping, h):
    """Returns τ, which a gear deflected by δ passes on of a load; each flank of teeth only pushes.

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
def motor_force(m, d, j, gears):
    """Returns f_m, the force on the motor of joint j before its gear, and the gear's δ and rate."""
    at = word(d, D.act) + 8 * np.int64(load_constant(gears + 8 * MOTOR))
    theta, omega = load_constant(at), load_constant(at + 8)
    q = double(d, D.qpos, integer(m, M.jnt_qposadr, j))
    v = double(d, D.qvel, integer(m, M.jnt_dofadr, j))
    drag = load_constant(gears + 8 * DRAG) * omega
    if load_constant(gears + 8 * SIDE) != 0.0:
        f = whole_drive(m, d, j, theta, omega, gears)
        return f - drag, theta - q, omega - v
    return whole_drive(m, d, j, q, v, gears) - drag, theta - q, omega - v


@inlined
def felt(m, d, j, row, gears):
    """Returns the state of a joint with f as its drive, and I; qfrc_smooth is used as room.

    Between the flanks of a gap it feels neither drive nor inertia.
    """
    s = joint(m, d, j, row)
    f_i = integral_force(d, gears, s.f_s, s.f_low, s.f_high)
    if f_i != 0.0:
        s = _with_drive(s, (s.f_u + f_i,))
    if not is_geared(gears):
        return s, 0.0
    h = load_constant(m + TIMESTEP)
    A = mobility(m, d, integer(m, M.jnt_dofadr, j), word(d, D.qfrc_smooth))
    f_m, delta, rate = motor_force(m, d, j, gears)
    _, kappa, r, damping = spring(gears, A, h)
    gap, J = load_constant(gears + 8 * GAP), load_constant(gears + 8 * INERTIA)
    f = transmitted(f_m, delta, rate, gap, kappa, r, damping, h)
    if gap != 0.0 and f == 0.0:
        return _with_drive(s, (0.0,)), 0.0
    beta, gamma = (1.0 - r) / (1.0 + r * J * A), (1.0 + J * A) / (1.0 + r * J * A)
    return _with_drive(s, (gamma * f - beta * J * A * f_m,)), beta * J
