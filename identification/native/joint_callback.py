"""The effects of joints inside MuJoCo's passive forces.

    f = Σ_e force_e(s, p_e)                               s: the `Joint` state of a joint
    b = max(0, Σ_e friction_e(s, p_e))                    the largest friction there
    g = M v/T + f_u + f_g + qfrc_passive + f              what would have to be resisted to stop
    qfrc_passive += f - min(max(g, -b), b)

Friction holds a joint that less than b drives, without creeping, and brakes with b what it cannot
stop within T, one step (Coulomb's law as Duclusaud et al. 2024 integrate it: BAM, equation 3).
Where a robot has several degrees of freedom, they pull at each other: the mass matrix is then
whole, the bias is in the place of f_g, and all joints are held together (see `native.holding`).
The numbers stand at the end of a joint's user data, in a row

    (T, what the records reach, parameters of the effects, key of the set of effects, TAG)

Every joint without such a row and every other model passes through untouched. Sizes of zero add
nothing, so that the bare model's trajectory is kept to the bit. A compiled callback must not
raise: a row whose set of effects is not compiled in this process makes NaN, which MuJoCo reports
as a divergence.
"""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Sequence

import mujoco
import numpy as np

from identification.native import structs
from identification.native.access import double, integer, offsets, word
from identification.native.compose import total
from identification.native.decorators import inlined, internal
from identification.native.element import Element, Function, Hook, Term
from identification.native.holding import MOST, hold, invert
from identification.native.library import mj_rne
from identification.native.memory import load_byte, load_constant, load_double, store_double
from identification.native.table import is_compiled
from identification.native.tuples import replacer

TAG = 7351.0609  # last entry of a row of ours, first of the bias of an actuator of ours
STOP, REACH, FIRST, LAST = 0, 1, 6, 2  # columns of T, of what is reached, of the first parameter;
# entries behind the last
DRIVE, LOW, HIGH, STOPPING, FRICTION, ROWS = range(6)  # rows of the room for joints held together
STEPS = 1.0  # T over the step, where joints are held together
GENTLE = 3.0  # times T, for slopes: at once, friction has none that tell what a finite step does
STEPS_ALONE = 3.0  # where each is held by itself, although the inertia of one is less than M then

# What an effect sees of a hinge or slide joint.
#   time [s]; q, v: position [rad or m] and velocity [rad/s or m/s]
#   f_u [N m or N]: force of the joint's own drives; NaN where it is not gain·u + bias
#   f_g [N m or N]: force of gravity on the joint, of all that hangs on it
#   sign: direction of the motion that friction resists, 1 or -1; 0 for a force
#   what the records reach: q_mid, q_far: middle and half of the travel [rad or m]; v_top: top speed
#   [rad/s or m/s]; f_top: largest force of its drives [N m or N]; t_end: duration [s]
Joint = namedtuple(
    "Joint", "time q v f_u f_g sign q_mid q_far v_top f_top t_end",
    defaults=(0.0, 1.0, 1.0, 1.0, 1.0),
)  # fmt: skip

JOINT = Element(
    "joint",
    Joint,
    (
        Hook("force", ("force [N] or torque [N m] on the joint",)),
        Hook("friction", ("largest friction [N] or [N m], zero or more",)),
    ),
)

M = offsets(
    "mjModel",
    "njnt nuser_jnt jnt_user jnt_qposadr jnt_dofadr nactuator actuator_trntype actuator_trnid"
    " actuator_gear actuator_gainprm actuator_biasprm actuator_dyntype actuator_gaintype"
    " actuator_biastype actuator_ctrladr actuator_ctrllimited actuator_ctrlrange"
    " actuator_forcelimited actuator_forcerange jnt_type jnt_bodyid body_subtreemass M_rowadr"
    " M_rownnz M_colind nv",
)
D = offsets("mjData", "time qpos qvel ctrl qfrc_passive qfrc_bias M subtree_com xanchor xaxis")
GRAVITY = structs.inner_word("mjModel", "opt", "gravity")
FIELDS = frozenset((*M._fields, *D._fields, "opt.gravity"))  # everything the callback touches

_JOINT = int(mujoco.mjtTrn.mjTRN_JOINT)
_HINGE = int(mujoco.mjtJoint.mjJNT_HINGE)
_SLIDE = int(mujoco.mjtJoint.mjJNT_SLIDE)
_NO_DYNAMICS = int(mujoco.mjtDyn.mjDYN_NONE)
_FIXED = int(mujoco.mjtGain.mjGAIN_FIXED)
_NO_BIAS, _AFFINE = int(mujoco.mjtBias.mjBIAS_NONE), int(mujoco.mjtBias.mjBIAS_AFFINE)
_USER_BIAS = int(mujoco.mjtBias.mjBIAS_USER)
_GAINS, _BIASES, _GEARS = mujoco.mjNGAIN, mujoco.mjNBIAS, 6


def stopping_steps(nv: int) -> float:
    """T over the step of a model with nv degrees of freedom."""
    return STEPS if nv <= MOST else STEPS_ALONE


def width(terms: Sequence[Term]) -> int:
    """Entries of a joint's row with some effects."""
    return FIRST + sum(len(term.names) for term in terms) + LAST


@inlined
def _clipped(m, limited, range_, i, x):  # type: ignore[no-untyped-def]
    """x within limit i of an array of limits, where there is one."""
    if load_byte(word(m, limited) + i):
        x = max(double(m, range_, 2 * i), min(double(m, range_, 2 * i + 1), x))
    return x


@inlined
def _actuator_force(m, d, i, q, v):  # type: ignore[no-untyped-def]
    """Force of actuator i on its joint, gain·u + bias [N or N m]; NaN where it is another law."""
    bias = integer(m, M.actuator_biastype, i)
    if bias == _USER_BIAS and double(m, M.actuator_biasprm, _BIASES * i) == TAG:
        return 0.0  # it carries a state of the joint (`identification.native.joint_states`)
    if (
        integer(m, M.actuator_dyntype, i) != _NO_DYNAMICS
        or integer(m, M.actuator_gaintype, i) != _FIXED
        or (bias != _NO_BIAS and bias != _AFFINE)
    ):
        return np.nan
    at = integer(m, M.actuator_ctrladr, i)
    u = _clipped(m, M.actuator_ctrllimited, M.actuator_ctrlrange, at, double(d, D.ctrl, at))
    gear = double(m, M.actuator_gear, _GEARS * i)
    own = double(m, M.actuator_gainprm, _GAINS * i) * u
    if bias == _AFFINE:
        b = _BIASES * i
        own += double(m, M.actuator_biasprm, b)
        own += gear * double(m, M.actuator_biasprm, b + 1) * q
        own += gear * double(m, M.actuator_biasprm, b + 2) * v
    return gear * _clipped(m, M.actuator_forcelimited, M.actuator_forcerange, i, own)


@inlined
def drive_force(m, d, j, q, v):  # type: ignore[no-untyped-def]
    """Force of the actuators on joint j [N or N m]."""
    f = 0.0
    for i in range(word(m, M.nactuator)):
        if integer(m, M.actuator_trntype, i) == _JOINT and integer(m, M.actuator_trnid, 2 * i) == j:
            f += _actuator_force(m, d, i, q, v)
    return f


@inlined
def gravity_force(m, d, j):  # type: ignore[no-untyped-def]
    """Force of gravity on joint j, of its body and all that hang on it [N or N m]."""
    body = integer(m, M.jnt_bodyid, j)
    mass = double(m, M.body_subtreemass, body)
    gx = mass * load_constant(m + 8 * GRAVITY)
    gy = mass * load_constant(m + 8 * GRAVITY + 8)
    gz = mass * load_constant(m + 8 * GRAVITY + 16)
    ax, ay, az = (
        double(d, D.xaxis, 3 * j), double(d, D.xaxis, 3 * j + 1), double(d, D.xaxis, 3 * j + 2)
    )  # fmt: skip
    if integer(m, M.jnt_type, j) != _HINGE:
        return ax * gx + ay * gy + az * gz
    rx = double(d, D.subtree_com, 3 * body) - double(d, D.xanchor, 3 * j)
    ry = double(d, D.subtree_com, 3 * body + 1) - double(d, D.xanchor, 3 * j + 1)
    rz = double(d, D.subtree_com, 3 * body + 2) - double(d, D.xanchor, 3 * j + 2)
    return ax * (ry * gz - rz * gy) + ay * (rz * gx - rx * gz) + az * (rx * gy - ry * gx)


@inlined
def inertia(m, d, dof):  # type: ignore[no-untyped-def]
    """Entry of the mass matrix of a degree of freedom with itself [kg or kg m²]."""
    last = integer(m, M.M_rowadr, dof) + integer(m, M.M_rownnz, dof) - 1
    return double(d, D.M, last)


@inlined
def joint(m, d, j, row):  # type: ignore[no-untyped-def]
    """The state of joint j, as a force sees it; `row` is the address of its row."""
    q = double(d, D.qpos, integer(m, M.jnt_qposadr, j))
    v = double(d, D.qvel, integer(m, M.jnt_dofadr, j))
    return Joint(
        time=load_constant(d + 8 * D.time), q=q, v=v, f_u=drive_force(m, d, j, q, v),
        f_g=gravity_force(m, d, j), sign=0.0,
        q_mid=load_constant(row + 8 * REACH), q_far=load_constant(row + 8 * (REACH + 1)),
        v_top=load_constant(row + 8 * (REACH + 2)), f_top=load_constant(row + 8 * (REACH + 3)),
        t_end=load_constant(row + 8 * (REACH + 4)),
    )  # fmt: skip


@inlined
def drive_alone(m, d, j, room):  # type: ignore[no-untyped-def]
    """The drive of a joint without effects into `room`, which others feel."""
    kind, dof = integer(m, M.jnt_type, j), integer(m, M.jnt_dofadr, j)
    if kind in (_HINGE, _SLIDE):
        q = double(d, D.qpos, integer(m, M.jnt_qposadr, j))
        f_u = drive_force(m, d, j, q, double(d, D.qvel, dof))
        room[DRIVE, dof] = f_u if f_u == f_u else 0.0


@internal
def hold_together(m, d, stop, room, n):  # type: ignore[no-untyped-def]
    """Subtract the friction of all joints; `room` has their drives and largest frictions."""
    A, full, w = np.empty((n, n)), np.zeros((n, n)), np.zeros(n)
    mj_rne(m, d, 0, word(d, D.qfrc_bias))  # MuJoCo itself does so right after the passive forces
    for i in range(n):
        first = integer(m, M.M_rowadr, i)
        for k in range(first, first + integer(m, M.M_rownnz, i)):
            full[i, integer(m, M.M_colind, k)] = double(d, D.M, k)
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
    hold(A, w, room[LOW], room[HIGH], room[FRICTION], n)
    for i in range(n):
        f = room[FRICTION, i]
        if f != 0.0:
            at = word(d, D.qfrc_passive) + 8 * i
            store_double(at, load_double(at) - f)


def callbacks(terms: Sequence[Term], key: float) -> dict[str, Function]:
    """The callback of a set of joint effects, to be compiled.

    Args:
        terms: the effects, their columns counted from the first parameter of a row.
        key: of the set.
    """
    force, friction = total(JOINT, terms, "force"), total(JOINT, terms, "friction")
    entries, with_sign = width(terms), replacer(Joint, "sign")

    @inlined
    def alone(m, d, j, row):  # type: ignore[no-untyped-def]
        """Add what acts on a joint that is held by itself."""
        dof = integer(m, M.jnt_dofadr, j)
        at = word(d, D.qfrc_passive) + 8 * dof
        s = joint(m, d, j, row)
        f = force(s, row + 8 * FIRST, 0)
        driven = f + s.f_g + load_double(at)
        if s.f_u == s.f_u:  # where it is known
            driven += s.f_u
        g = driven + inertia(m, d, dof) * s.v / load_constant(row + 8 * STOP)
        b = max(0.0, friction(with_sign(s, (1.0 if g > 0.0 else -1.0,)), row + 8 * FIRST, 0))
        f -= max(-b, min(b, g))
        if f != 0.0:
            store_double(at, load_double(at) + f)

    @inlined
    def together(m, d, j, row, room, n):  # type: ignore[no-untyped-def]
        """Add the force on a joint; its drive and its largest friction into `room`."""
        dof = integer(m, M.jnt_dofadr, j)
        at = word(d, D.qfrc_passive) + 8 * dof
        s = joint(m, d, j, row)
        f = force(s, row + 8 * FIRST, 0)
        if f != 0.0:
            store_double(at, load_double(at) + f)
        room[DRIVE, dof] = s.f_u if s.f_u == s.f_u else 0.0
        room[LOW, dof] = max(0.0, friction(with_sign(s, (-1.0,)), row + 8 * FIRST, 0))
        room[HIGH, dof] = max(0.0, friction(with_sign(s, (1.0,)), row + 8 * FIRST, 0))

    def passive(m, d):  # type: ignore[no-untyped-def]
        columns, n = word(m, M.nuser_jnt), word(m, M.nv)
        if columns < LAST:
            return
        are_coupled, stop = 1 < n <= MOST, 0.0
        room = np.zeros((ROWS, n if are_coupled else 1))
        for j in range(word(m, M.njnt)):
            end = word(m, M.jnt_user) + 8 * columns * (j + 1)
            if load_constant(end - 8) != TAG:
                if are_coupled:
                    drive_alone(m, d, j, room)
                continue
            own = load_constant(end - 16)
            if own != key:
                if not is_compiled(own):
                    at = word(d, D.qfrc_passive) + 8 * integer(m, M.jnt_dofadr, j)
                    store_double(at, np.nan)
                continue
            row = end - 8 * entries
            stop = load_constant(row + 8 * STOP)
            if are_coupled:
                together(m, d, j, row, room, n)
            else:
                alone(m, d, j, row)
        if are_coupled and (room[LOW].any() or room[HIGH].any()):
            hold_together(m, d, stop, room, n)

    return {"passive": passive}
