"""The effects of joints inside MuJoCo's passive forces.

    f = Σ_e force_e(s, p_e)                               s: the `Joint` state of a joint
    b = max(0, Σ_e friction_e(s, p_e))                    the largest friction there
    g = M v/T + f_u + f_g + qfrc_passive + f              what would have to be resisted to stop
    qfrc_passive += f - min(max(g, -b), b)

Friction holds a joint that less than b drives, without creeping, and brakes with b what it cannot
stop within T, one step (Coulomb's law as Duclusaud et al. 2024 integrate it: BAM, equation 3).
Where a robot has several degrees of freedom, they pull at each other: the mass matrix is then
whole, the bias is in the place of f_g, and all joints are held together (see `native.holding`).
A joint behind its gear feels f_u, and I more of inertia than M has (see `native.gear`).

Every joint without a row of ours and every other model passes through untouched. Sizes of zero add
nothing, so that the bare model's trajectory is kept to the bit. A compiled callback must not
raise: a row whose set of effects is not compiled in this process makes NaN, which MuJoCo reports
as a divergence.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification.native.compose import total
from identification.native.element import Function, Term
from identification.native.joints.holding import MOST, hold, invert, resolved
from identification.native.joints.joint_callback import (
    FIRST,
    HINGE,
    JOINT,
    LAST,
    SLIDE,
    STOP,
    TAG,
    TIMESTEP,
    D,
    M,
    drive_force,
    inertia,
    joint,
    width,
    with_sign,
)
from identification.native.library import mj_rne
from identification.native.memory import (
    double,
    inlined,
    integer,
    internal,
    load_constant,
    load_double,
    store_double,
    word,
)
from identification.native.table import is_compiled

# rows of the room for joints held together
DRIVE, LOW, HIGH, STOPPING, FRICTION, MORE, SHARE, SPRING, ROWS = range(9)


@inlined
def _drive_alone(m, d, j, room):
    """Writes the drive of a joint without effects into `room`, for the joints that feel it."""
    kind, dof = integer(m, M.jnt_type, j), integer(m, M.jnt_dofadr, j)
    if kind in (HINGE, SLIDE):
        q = double(d, D.qpos, integer(m, M.jnt_qposadr, j))
        f_u = drive_force(m, d, j, q, double(d, D.qvel, dof))
        room[DRIVE, dof] = f_u if f_u == f_u else 0.0


@internal
def _hold_together(m, d, stop, room, n):
    """Subtract the friction of all joints; `room` has their drives and largest frictions."""
    A, full, w = np.empty((n, n)), np.zeros((n, n)), np.zeros(n)
    mj_rne((m, d, 0, word(d, D.qfrc_bias)))  # MuJoCo itself does so right after the passive forces
    for i in range(n):
        first = integer(m, M.M_rowadr, i)
        for k in range(first, first + integer(m, M.M_rownnz, i)):
            full[i, integer(m, M.M_colind, k)] = double(d, D.M, k)
        full[i, i] += room[MORE, i]
        v = double(d, D.qvel, i)
        g = room[DRIVE, i] - load_double(word(d, D.qfrc_bias) + 8 * i)
        room[STOPPING, i] += g + load_double(word(d, D.qfrc_passive) + 8 * i)
        for k in range(i + 1):
            room[STOPPING, i] += full[i, k] * double(d, D.qvel, k) / stop
            if k < i:
                room[STOPPING, k] += full[i, k] * v / stop
    invert(full, A, n)
    for i in range(n):
        for k in range(n):
            w[i] += A[i, k] * room[STOPPING, k]
        if room[SHARE, i] != 0.0:
            room[SHARE, i] = resolved(room[SHARE, i], 1.0 / A[i, i], load_constant(m + TIMESTEP))
    hold(A, w, room[LOW], room[HIGH], room[FRICTION], n, room[SHARE], room[SPRING])
    for i in range(n):
        f = room[FRICTION, i]
        if f != 0.0:
            at = word(d, D.qfrc_passive) + 8 * i
            store_double(at, load_double(at) - f)


def passive_force(terms: Sequence[Term], key: float, entries: int, felt: Function) -> Function:
    """Returns the passive force of a set of joint effects, to be compiled."""
    force, friction = total(JOINT, terms, "force"), total(JOINT, terms, "friction")

    @inlined
    def alone(m, d, j, row, end):
        """Add what acts on a joint that is held by itself."""
        dof = integer(m, M.jnt_dofadr, j)
        at = word(d, D.qfrc_passive) + 8 * dof
        s, more, c, p = felt(m, d, j, row, end)
        f = force(s, row + 8 * FIRST, 0)
        driven = f + s.f_g + load_double(at)
        if s.f_u == s.f_u:  # where it is known
            driven += s.f_u
        whole = inertia(m, d, dof) + more
        g = driven + whole * s.v / load_constant(row + 8 * STOP)
        if c != 0.0:
            r = resolved(c, whole, load_constant(m + TIMESTEP))
            g = (1.0 - r) * g + r * p
        b = max(0.0, friction(with_sign(s, (1.0 if g > 0.0 else -1.0,)), row + 8 * FIRST, 0))
        f -= max(-b, min(b, g))
        if f != 0.0:
            store_double(at, load_double(at) + f)

    @inlined
    def together(m, d, j, row, end, room):
        """Add the force on a joint; its drive and its largest friction into `room`."""
        dof = integer(m, M.jnt_dofadr, j)
        at = word(d, D.qfrc_passive) + 8 * dof
        s, more, c, p = felt(m, d, j, row, end)
        f = force(s, row + 8 * FIRST, 0)
        if f != 0.0:
            store_double(at, load_double(at) + f)
        room[DRIVE, dof] = s.f_u if s.f_u == s.f_u else 0.0
        room[LOW, dof] = max(0.0, friction(with_sign(s, (-1.0,)), row + 8 * FIRST, 0))
        room[HIGH, dof] = max(0.0, friction(with_sign(s, (1.0,)), row + 8 * FIRST, 0))
        room[MORE, dof], room[SHARE, dof], room[SPRING, dof] = more, c, p

    @inlined
    def row_of(m, d, j, end):
        """Returns the address of the row of a joint; zero where it is of another set of effects."""
        own = load_constant(end - 16)
        if own == key:
            return end - 8 * entries
        if not is_compiled(own):
            at = word(d, D.qfrc_passive) + 8 * integer(m, M.jnt_dofadr, j)
            store_double(at, np.nan)
        return 0

    @internal
    def each_alone(m, d, columns):
        """Add what acts on each joint, without a room for all: that takes a twentieth of a step."""
        for j in range(word(m, M.njnt)):
            end = word(m, M.jnt_user) + 8 * columns * (j + 1)
            row = row_of(m, d, j, end) if load_constant(end - 8) == TAG else 0
            if row != 0:
                alone(m, d, j, row, end)

    @internal
    def all_together(m, d, columns, n):
        """Add what acts on joints that pull at each other."""
        room, stop = np.zeros((ROWS, n)), 0.0
        for j in range(word(m, M.njnt)):
            end = word(m, M.jnt_user) + 8 * columns * (j + 1)
            if load_constant(end - 8) != TAG:
                _drive_alone(m, d, j, room)
                continue
            row = row_of(m, d, j, end)
            if row != 0:
                stop = load_constant(row + 8 * STOP)
                together(m, d, j, row, end, room)
        if room[LOW].any() or room[HIGH].any():
            _hold_together(m, d, stop, room, n)

    def passive(m, d):
        columns, n = word(m, M.nuser_jnt), word(m, M.nv)
        if columns < LAST:
            return
        if 1 < n <= MOST:
            all_together(m, d, columns, n)
        else:
            each_alone(m, d, columns)

    return passive


def callbacks(terms: Sequence[Term], key: float) -> dict[str, Function]:
    """Returns the callback of a set of joint effects without states, to be compiled; see above."""

    @inlined
    def felt(m, d, j, row, end):
        return joint(m, d, j, row), 0.0, 0.0, 0.0

    return {"passive": passive_force(terms, key, width(terms), felt)}
