"""The state of a joint that its effects see, and the place of its numbers.

The numbers stand at the end of a joint's user data, in a row

    (T, what the records reach, parameters of the effects, key of the set of effects, TAG)

`identification.native.joints.joint_friction` says what is made of them,
`identification.native.joints.gear` what of those of states.
"""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Sequence

import mujoco
import numpy as np

from identification.native import structs
from identification.native.element import Element, Hook, Term
from identification.native.joints.holding import MOST
from identification.native.memory import (
    double,
    inlined,
    integer,
    load_byte,
    load_constant,
    offsets,
    replacer,
    word,
)

TAG = 7351.0609  # last entry of a row of ours, first of the bias of an actuator of ours
STOP, REACH, FIRST, LAST = 0, 1, 6, 2  # columns of T, of what is reached, of the first parameter;
# entries behind the last
STEPS = 1.0  # T over the step, where joints are held together
GENTLE = 3.0  # times T, for slopes: at once, friction has none that tell what a finite step does
STEPS_ALONE = 3.0  # where each is held by itself, although the inertia of one is less than M then

# What an effect sees of a hinge or slide joint.
#   time [s]; q, v: position [rad or m] and velocity [rad/s or m/s]
#   f_u [N m or N]: force of the joint's own drives; NaN where it is not gain·u + bias, of an input
#   or of what a filter makes of it
#   f_g [N m or N]: force of gravity on the joint, of all that hangs on it
#   sign: direction of the motion that friction resists, 1 or -1; 0 for a force
#   what the records reach: q_mid, q_far: middle and half of the travel [rad or m]; v_top: top speed
#   [rad/s or m/s]; f_top: largest force of its drives [N m or N]; t_end: duration [s]
#   x_before, x_behind: (q - q_mid)/q_far of the joints before and behind it in the model, and
#   v_before, v_behind: their v/v_top; NaN where there is none whose records reach anything
#   of the joint's position servo: e, where it is to be less where it is [rad or m]; k_p, its
#   stiffness [N m/rad or N/m], 0 where there is no servo; f_s, the force that it would give without
#   its limits f_low and f_high [N m or N]
Joint = namedtuple(
    "Joint", "time q v f_u f_g sign q_mid q_far v_top f_top t_end x_before x_behind"
    " v_before v_behind e k_p f_s f_low f_high",
    defaults=(0.0, 1.0, 1.0, 1.0, 1.0, np.nan, np.nan, np.nan, np.nan,
              0.0, 0.0, 0.0, -np.inf, np.inf),
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
    " M_rownnz M_colind nv actuator_actadr actuator_actnum actuator_actearly",
)
D = offsets(
    "mjData",
    "time qpos qvel ctrl qfrc_passive qfrc_bias M subtree_com xanchor xaxis act act_dot qfrc_smooth"
    " qacc_smooth qfrc_actuator",
)
GRAVITY, TIMESTEP = structs.option_byte("gravity"), structs.option_byte("timestep")
FIELDS = frozenset((*M._fields, *D._fields, "opt.gravity", "opt.timestep"))  # all that is touched
with_sign = replacer(Joint, "sign")

_JOINT = int(mujoco.mjtTrn.mjTRN_JOINT)
HINGE = int(mujoco.mjtJoint.mjJNT_HINGE)
SLIDE = int(mujoco.mjtJoint.mjJNT_SLIDE)
_NO_DYNAMICS = int(mujoco.mjtDyn.mjDYN_NONE)
_FILTERS = int(mujoco.mjtDyn.mjDYN_FILTER), int(mujoco.mjtDyn.mjDYN_FILTEREXACT)
_FIXED = int(mujoco.mjtGain.mjGAIN_FIXED)
_NO_BIAS, _AFFINE = int(mujoco.mjtBias.mjBIAS_NONE), int(mujoco.mjtBias.mjBIAS_AFFINE)
_USER_BIAS = int(mujoco.mjtBias.mjBIAS_USER)
_GAINS, _BIASES, _GEARS = mujoco.mjNGAIN, mujoco.mjNBIAS, 6
_NO_SERVO = (0.0, 0.0, 0.0, -np.inf, np.inf)  # e, k_p, f_s, f_low, f_high


def stopping_steps(nv: int) -> float:
    """Returns T over the step of a model with nv degrees of freedom."""
    return STEPS if nv <= MOST else STEPS_ALONE


def width(terms: Sequence[Term]) -> int:
    """Returns how many entries a joint's row has with some effects."""
    return FIRST + sum(len(term.names) for term in terms) + LAST


@inlined
def _clipped(m, limited, range_, i, x):
    """Returns x within limit i of an array of limits, where there is one."""
    if load_byte(word(m, limited) + i):
        x = max(double(m, range_, 2 * i), min(double(m, range_, 2 * i + 1), x))
    return x


@inlined
def _actuator(m, d, i, q, v):
    """Returns what actuator i does to its joint: f, e, k_p, f_s, f_low and f_high.

    f is gain·u + bias [N or N m], and NaN for another law; k_p is 0 where it is no position servo.
    u is the input, or what the actuator's filter makes of it.
    """
    bias = integer(m, M.actuator_biastype, i)
    if bias == _USER_BIAS and double(m, M.actuator_biasprm, _BIASES * i) == TAG:
        return 0.0, *_NO_SERVO  # it carries a state of the joint (`native.joint_states`)
    dynamics = integer(m, M.actuator_dyntype, i)
    is_filtered = dynamics == _FILTERS[0] or dynamics == _FILTERS[1]
    if (
        (dynamics != _NO_DYNAMICS and not is_filtered)
        or (is_filtered and load_byte(word(m, M.actuator_actearly) + i))
        or integer(m, M.actuator_gaintype, i) != _FIXED
        or (bias != _NO_BIAS and bias != _AFFINE)
    ):
        return np.nan, *_NO_SERVO
    if is_filtered:
        u = double(
            d, D.act, integer(m, M.actuator_actadr, i) + integer(m, M.actuator_actnum, i) - 1
        )
    else:
        at = integer(m, M.actuator_ctrladr, i)
        u = _clipped(m, M.actuator_ctrllimited, M.actuator_ctrlrange, at, double(d, D.ctrl, at))
    gear = double(m, M.actuator_gear, _GEARS * i)
    gain, follows = double(m, M.actuator_gainprm, _GAINS * i), 0.0
    own = gain * u
    if bias == _AFFINE:
        b = _BIASES * i
        follows = double(m, M.actuator_biasprm, b + 1)
        own += double(m, M.actuator_biasprm, b)
        own += gear * follows * q
        own += gear * double(m, M.actuator_biasprm, b + 2) * v
    f = gear * _clipped(m, M.actuator_forcelimited, M.actuator_forcerange, i, own)
    if gain * gear == 0.0 or follows != -gain:
        return f, *_NO_SERVO
    low, high = -np.inf, np.inf
    if load_byte(word(m, M.actuator_forcelimited) + i):
        one = gear * double(m, M.actuator_forcerange, 2 * i)
        other = gear * double(m, M.actuator_forcerange, 2 * i + 1)
        low, high = min(one, other), max(one, other)
    return f, u / gear - q, gear**2 * gain, gear * own, low, high


@inlined
def drive(m, d, j, q, v):
    """Returns the force of the actuators on joint j [N or N m], and e to f_high of its servo."""
    f, (e, k_p, f_s, low, high) = 0.0, _NO_SERVO
    for i in range(word(m, M.nactuator)):
        if integer(m, M.actuator_trntype, i) == _JOINT and integer(m, M.actuator_trnid, 2 * i) == j:
            of = _actuator(m, d, i, q, v)
            f += of[0]
            if of[2] != 0.0:
                e, k_p, f_s, low, high = of[1], of[2], of[3], of[4], of[5]
    return f, e, k_p, f_s, low, high


@inlined
def drive_force(m, d, j, q, v):
    """Returns the force of the actuators on joint j [N or N m]."""
    return drive(m, d, j, q, v)[0]


@inlined
def gravity_force(m, d, j):
    """Returns the force of gravity on joint j, of its body and all that hang on it [N or N m]."""
    body = integer(m, M.jnt_bodyid, j)
    mass = double(m, M.body_subtreemass, body)
    gx = mass * load_constant(m + GRAVITY)
    gy = mass * load_constant(m + GRAVITY + 8)
    gz = mass * load_constant(m + GRAVITY + 16)
    ax, ay, az = (
        double(d, D.xaxis, 3 * j), double(d, D.xaxis, 3 * j + 1), double(d, D.xaxis, 3 * j + 2)
    )  # fmt: skip
    if integer(m, M.jnt_type, j) != HINGE:
        return ax * gx + ay * gy + az * gz
    rx = double(d, D.subtree_com, 3 * body) - double(d, D.xanchor, 3 * j)
    ry = double(d, D.subtree_com, 3 * body + 1) - double(d, D.xanchor, 3 * j + 1)
    rz = double(d, D.subtree_com, 3 * body + 2) - double(d, D.xanchor, 3 * j + 2)
    return ax * (ry * gz - rz * gy) + ay * (rz * gx - rx * gz) + az * (rx * gy - ry * gx)


@inlined
def inertia(m, d, dof):
    """Returns the diagonal entry of the mass matrix for a degree of freedom [kg or kg m²]."""
    last = integer(m, M.M_rowadr, dof) + integer(m, M.M_rownnz, dof) - 1
    return double(d, D.M, last)


@inlined
def _neighbour(m, d, j, other, row):
    """Returns (q - q_mid)/q_far and v/v_top of another joint; NaN if it has no row like joint j."""
    columns = word(m, M.nuser_jnt)
    if other < 0 or other >= word(m, M.njnt):
        return np.nan, np.nan
    if load_constant(word(m, M.jnt_user) + 8 * columns * (other + 1) - 8) != TAG:
        return np.nan, np.nan
    reach = row + 8 * (columns * (other - j) + REACH)
    q = double(d, D.qpos, integer(m, M.jnt_qposadr, other))
    v = double(d, D.qvel, integer(m, M.jnt_dofadr, other))
    x = (q - load_constant(reach)) / load_constant(reach + 8)
    return x, v / load_constant(reach + 16)


@inlined
def joint(m, d, j, row):
    """Returns the state of joint j, as a force sees it; `row` is the address of its row."""
    q = double(d, D.qpos, integer(m, M.jnt_qposadr, j))
    v = double(d, D.qvel, integer(m, M.jnt_dofadr, j))
    f_u, e, k_p, f_s, f_low, f_high = drive(m, d, j, q, v)
    x_before, v_before = _neighbour(m, d, j, j - 1, row)
    x_behind, v_behind = _neighbour(m, d, j, j + 1, row)
    return Joint(
        time=load_constant(d + 8 * D.time), q=q, v=v, f_u=f_u,
        f_g=gravity_force(m, d, j), sign=0.0,
        q_mid=load_constant(row + 8 * REACH), q_far=load_constant(row + 8 * (REACH + 1)),
        v_top=load_constant(row + 8 * (REACH + 2)), f_top=load_constant(row + 8 * (REACH + 3)),
        t_end=load_constant(row + 8 * (REACH + 4)),
        x_before=x_before, x_behind=x_behind, v_before=v_before, v_behind=v_behind,
        e=e, k_p=k_p, f_s=f_s, f_low=f_low, f_high=f_high,
    )  # fmt: skip
