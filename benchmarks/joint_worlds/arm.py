"""An arm of six hinges: Newton's and Euler's laws from link to link, out and back.

Out, link i in its own frame, R_i turns the parent's vectors into it, e_i is its axis, r_i the place
of its joint in the parent, c_i its centre:

    ω_i = R_i ω + e_i q̇_i                 α_i = R_i α + e_i q̈_i + R_i ω × e_i q̇_i
    a_i = R_i (a + α × r_i + ω × (ω × r_i))
    F_i = m_i (a_i + α_i × c_i + ω_i × (ω_i × c_i)),     N_i = I_i α_i + ω_i × I_i ω_i + c_i × F_i

and back: f_i = F_i + R_k^T f_k, n_i = N_i + R_k^T n_k + r_k × R_k^T f_k for the child k, and
τ_i = e_i·n_i. With a_0 = -γ this is M q̈ + c + g; column k of M comes from q̈ = unit vector k. At
q = 0 the arm is bent, so that gravity acts on joints 2, 3 and 5. A payload is a point at the tip.
"""

from __future__ import annotations

import numpy as np

from joint_worlds.robot import Free, JointRobot
from joint_worlds.slots import compiled

N, LINK = 6, 11  # numbers of a link: mass, centre (3), inertia (3), armature, place of joint (3)
PAYLOAD, GRAVITY, TIP = N * LINK, N * LINK + 1, N * LINK + 2
AXES = np.array([2, 1, 1, 2, 1, 2])  # z y y z y z


@compiled
def _into(axis, angle, x, y):  # type: ignore[no-untyped-def]
    """R x of a frame that is turned by an angle about an axis of its own, into y."""
    c, s = np.cos(angle), np.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    a, b = x[i], x[j]
    y[axis] = x[axis]
    y[i] = c * a + s * b
    y[j] = -s * a + c * b


@compiled
def _cross(a, b, out):  # type: ignore[no-untyped-def]
    x = a[1] * b[2] - a[2] * b[1]
    y = a[2] * b[0] - a[0] * b[2]
    out[2] = a[0] * b[1] - a[1] * b[0]
    out[0], out[1] = x, y


@compiled
def _point(m, c, w, al, a, F, N_, t, u):  # type: ignore[no-untyped-def]
    """Add what a point mass m at c asks for: F += m (a + α × c + ω × (ω × c)), N += c × that."""
    _cross(w, c, t)
    _cross(w, t, t)
    _cross(al, c, u)
    for k in range(3):
        t[k] = m * (a[k] + u[k] + t[k])
        F[k] += t[k]
    _cross(c, t, u)
    for k in range(3):
        N_[k] += u[k]


@compiled
def inverse(q, v, acc, gravity, p, work, tau):  # type: ignore[no-untyped-def]
    """Torques [N m] that a motion asks for, into tau; `work` is room, shape (6, 8, 3)."""
    for i in range(N):
        w, al, a, F, n = work[i, 0], work[i, 1], work[i, 2], work[i, 3], work[i, 4]
        t, u, s = work[i, 5], work[i, 6], work[i, 7]
        link = p[i * LINK : (i + 1) * LINK]
        e = AXES[i]
        if i == 0:
            w[:], al[:], a[:] = 0.0, 0.0, 0.0
            a[2] = gravity
        else:
            W, A, B, r = work[i - 1, 0], work[i - 1, 1], work[i - 1, 2], link[8:11]
            _cross(A, r, t)
            _cross(W, r, u)
            _cross(W, u, u)
            for k in range(3):
                t[k] += B[k] + u[k]
            _into(e, q[i], t, a)
            _into(e, q[i], W, w)
            _into(e, q[i], A, al)
        s[:] = 0.0
        s[e] = v[i]
        _cross(w, s, u)
        for k in range(3):
            al[k] += u[k]
        w[e] += v[i]
        al[e] += acc[i]
        for k in range(3):
            t[k] = link[4 + k] * w[k]
        _cross(w, t, n)
        for k in range(3):
            n[k] += link[4 + k] * al[k]
            F[k] = 0.0
        _point(link[0], link[1:4], w, al, a, F, n, t, u)
        if i == N - 1:
            _point(p[PAYLOAD], p[TIP : TIP + 3], w, al, a, F, n, t, u)
    for i in range(N - 1, -1, -1):
        F, n = work[i, 3], work[i, 4]
        tau[i] = n[AXES[i]] + p[i * LINK + 7] * acc[i]
        if i > 0:
            f, t, u = work[i, 5], work[i, 6], work[i, 7]
            _into(AXES[i], -q[i], F, f)
            _into(AXES[i], -q[i], n, t)
            _cross(p[i * LINK + 8 : i * LINK + 11], f, u)
            for k in range(3):
                work[i - 1, 3, k] += f[k]
                work[i - 1, 4, k] += t[k] + u[k]


@compiled
def arm(q, v, p, M, c, g):  # type: ignore[no-untyped-def]
    """Mass matrix, centrifugal and Coriolis forces, and gravity, into M, c and g."""
    work, zero, unit = np.empty((N, 8, 3)), np.zeros(N), np.zeros(N)
    inverse(q, zero, zero, p[GRAVITY], p, work, g)
    inverse(q, v, zero, 0.0, p, work, c)
    for k in range(N):
        unit[k] = 1.0
        inverse(q, zero, unit, 0.0, p, work, M[k])
        unit[k] = 0.0


LINKS = (  # name, mass, centre, inertia, armature, place of the joint in the parent
    ("base", 7.0, (0.0, 0.03, -0.02), (0.030, 0.030, 0.022), 0.60, (0.0, 0.0, 0.0)),
    ("upper", 8.0, (0.08, 0.0, 0.20), (0.150, 0.150, 0.025), 0.60, (0.0, 0.0, 0.18)),
    ("fore", 4.0, (0.20, 0.0, -0.05), (0.012, 0.060, 0.060), 0.30, (0.15, 0.0, 0.40)),
    ("wrist1", 1.5, (0.0, 0.01, 0.02), (0.0030, 0.0028, 0.0022), 0.08, (0.40, 0.0, -0.10)),
    ("wrist2", 1.3, (0.03, 0.0, -0.03), (0.0024, 0.0024, 0.0020), 0.08, (0.0, 0.0, -0.08)),
    ("tool", 0.6, (0.0, 0.015, -0.03), (0.0009, 0.0009, 0.0006), 0.06, (0.05, 0.0, -0.08)),
)
TOOL = (0.02, 0.03, -0.12)


def mjcf(p: np.ndarray, damping: np.ndarray) -> str:
    """The same robot for MuJoCo, without what it lacks."""
    body, end = "", ""
    for i, (name, *_) in enumerate(LINKS):
        link = [f"{x:.17g}" for x in p[i * LINK : (i + 1) * LINK]]
        axis = " ".join("1" if k == AXES[i] else "0" for k in range(3))
        body += f"""<body name="{name}" pos="{" ".join(link[8:11])}">
<inertial pos="{" ".join(link[1:4])}" mass="{link[0]}" diaginertia="{" ".join(link[4:7])}"/>
<joint name="j{i + 1}" type="hinge" axis="{axis}" damping="{damping[i]:.17g}" armature="{link[7]}"/>
"""
        end += "</body>\n"
    tip = " ".join(f"{x:.17g}" for x in p[TIP : TIP + 3])
    motors = "".join(f'<motor name="u{i}" joint="j{i}"/>\n' for i in range(1, N + 1))
    sensors = "".join(f'<jointpos name="q{i}" joint="j{i}"/>\n' for i in range(1, N + 1))
    return f"""<mujoco model="arm">
<option timestep="0.005" gravity="0 0 -{p[GRAVITY]:.17g}" integrator="RK4"/>
<worldbody>
{body}<site name="tip" pos="{tip}"/>
{end}</worldbody>
<actuator>
{motors}</actuator>
<sensor>
{sensors}</sensor>
</mujoco>
"""


ARM = JointRobot(
    name="arm", code=3, joints=tuple(f"j{i}" for i in range(1, 7)),
    inputs=tuple(f"u{i}" for i in range(1, 7)), outputs=tuple(f"q{i}" for i in range(1, 7)),
    kind="hinge",
    numbers=(
        *(x for _, m, c, I, J, r in LINKS for x in (m, *c, *I, J, *r)), 0.0, 9.81, *TOOL,
    ),
    payload=(PAYLOAD,), link=tuple(2 * LINK + k for k in (0, 4, 5, 6)), end="fore",
    tip=(TIP, TIP + 1, TIP + 2),
    damping=(8.0, 8.0, 5.0, 1.2, 1.2, 1.0), coulomb=(5.0, 6.0, 4.0, 1.0, 1.0, 0.8),
    heavy=(False, True, True, True, True, True),
    travel=(0.9, 0.5, 0.6, 1.0, 0.8, 1.2), speed=(1.5, 1.2, 1.5, 2.5, 2.5, 3.0), bandwidth=10.0,
    counts=(2**18,) * 6, white=(2e-5,) * 6,
    sampling_time=0.01, substeps=40, horizon=0.2,
    free=(
        Free("body/upper.mass", "mass", number=LINK),
        Free("body/fore.mass", "mass", number=2 * LINK),
        *(Free(f"joint/j{i + 1}.armature", "armature", number=i * LINK + 7) for i in range(6)),
    ),
    mjcf=mjcf,
)  # fmt: skip
