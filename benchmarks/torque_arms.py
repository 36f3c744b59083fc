"""Arms of geared hinges in closed loop, which hide a load, or an effect at one joint.

    stribeck_friction            -s R e^(-(v/v_s)²) sign v        R: rms of the drive's torque
    quadratic_friction           -s R |v| v / v²                   v, q: rms of rate and angle
    asymmetric_viscous_friction  -s R |v| / v
    load_dependent_friction      -s |u| sign v                     u: torque of the drive
    cogging                       s R cos(n q + φ)
    stiffness, hardening         -s R q/q,  -s R q³/q³
    gravity_force                 s g                              g: weight at the joint
    gain, delay                   the drive gives (1 ± s) u, or u some milliseconds later

    bump                          s R e^(-((q - q_0)/w)²)          in no catalogue, like the rest
    stop                          -s R (|q| - q_s)₊ sign q / q
    fast                          -s R (|v| - v_c)₊ sign v / v

Sizes are those that such records tell: cogging repeats more than twice within the joint's travel,
and gains and delays, of 5 to 9 ms, are of the first three joints that carry weight, because of
others a free armature and a friction do the same. Three kinds have sizes that they do not tell:

    slow_cogging                 3 to 12 periods in a turn, mostly less than two within the travel
    any_gain, short_delay        of any joint; a delay of 0.5 to 2 ms

The controller knows nothing of it. It sees positions with noise, takes each step of the simulation,
and its log holds every 20th.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import mujoco
import numpy as np

from identification import Log

STEP, SAMPLED, LASTS = 0.0005, 20, 20.0  # the controller takes each step, the log every 20th
Y, Z = "0 1 0", "0 0 1"
AXES = {2: (Y, Y), 6: (Z, Y, Y, Y, Z, Y), 7: (Z, Y, Z, Y, Z, Y, Z)}
NOISE, TORQUE_NOISE = 5e-5, 0.01
FILTER = 0.03  # of the rates that the controller makes of positions, in each step
SPREAD = {"mass": 0.1, "armature": 0.15, "friction": 0.3}
HARMONICS, SLOWEST = 5, 0.1  # of the reference, and its first frequency [Hz]
UNLISTED = ("bump", "stop", "fast")
LISTED = (
    "stribeck_friction", "quadratic_friction", "asymmetric_viscous_friction",
    "load_dependent_friction", "cogging", "stiffness", "hardening", "gravity_force", "gain",
    "delay",
)  # fmt: skip
UNTOLD = {"slow_cogging": "cogging", "any_gain": "gain", "short_delay": "delay"}  # and their laws
DRIVES = ("gain", "delay")  # of joints that carry weight
HEAVY = 3  # joints, the first ones that carry weight
STRENGTH = (0.05, 0.2)  # s
PERIODS = (2.2, 3.2)  # of cogging, within the travel of a joint
LATE = {"delay": (0.005, 0.009), "short_delay": (0.0005, 0.002)}  # [s]


def arm(joints: int, rng: np.random.Generator | None, load: float = 0.0) -> str:
    """The MJCF of an arm: the model's numbers, or true ones drawn about them."""

    def of(kind: str) -> float:
        return 1.0 if rng is None else float(np.exp(SPREAD[kind] * rng.standard_normal()))

    text = ""
    for k in range(joints):
        m, length = 6.0 * 0.6**k, 0.4 * 0.8**k
        inertia = " ".join(f"{m * length**2 * x:.6g}" for x in (0.1, 0.1, 0.02))
        m *= of("mass")
        size = 4.0 * 0.5**k
        text += (
            f'<body name="b{k}" pos="0 0 {0.5 * 0.8**k if k else 0.3:.4f}"><joint name="j{k}"'
            f' axis="{AXES[joints][k]}"'
            f' armature="{size / 4 * of("armature"):.6g}" damping="{size * of("friction"):.6g}"'
            f' frictionloss="{size * of("friction"):.6g}"/>'
            f'<inertial pos="0.02 0.01 {length / 2:.4f}" mass="{m:.6g}" diaginertia="{inertia}"/>'
            f'<site name="s{k}" pos="0 0 {length:.4f}"/>'
        )
    end = 0.4 * 0.8 ** (joints - 1)
    if load:
        text += (f'<body pos="0 0 {end:.4f}"><inertial pos="0 0 0" mass="{load:.6g}"'
                 ' diaginertia="1e-5 1e-5 1e-5"/></body>')  # fmt: skip
    text += "</body>" * joints
    motors = "".join(f'<motor name="t{k}" joint="j{k}"/>' for k in range(joints))
    sensors = "".join(f'<jointpos name="q{k}" joint="j{k}"/>' for k in range(joints))
    return (
        f'<mujoco><compiler angle="radian"/><option timestep="{STEP}" integrator="implicitfast"/>'
        f"<worldbody>{text}</worldbody><actuator>{motors}</actuator><sensor>{sensors}</sensor>"
        "</mujoco>"
    )


@dataclass(frozen=True)
class Hidden:
    """An effect at a joint, whose sizes are in units of the joint's own motion and torque."""

    name: str = ""
    joint: int = 0
    s: float = 0.0
    torque: float = 1.0  # R [N m]
    rate: float = 1.0  # rms [rad/s]
    angle: float = 1.0  # rms about its mean [rad]
    mean: float = 0.0  # [rad]
    shape: dict[str, float] = field(default_factory=dict)

    def force(self, q: float, v: float, u: float, g: float) -> float:
        """The torque at the joint [N m]."""
        s, R, x, w = self.s, self.torque, self.shape, v / self.rate
        z, turn = (q - self.mean) / self.angle, float(np.sign(v))
        laws: dict[str, Callable[[], float]] = {
            "stribeck_friction": lambda: -s * R * np.exp(-((w / x["v_s"]) ** 2)) * turn,
            "quadratic_friction": lambda: -s * R * abs(w) * w,
            "asymmetric_viscous_friction": lambda: -s * R * abs(w),
            "load_dependent_friction": lambda: -s * abs(u) * turn,
            "cogging": lambda: s * R * np.cos(x["n"] * q + x["phase"]),
            "stiffness": lambda: -s * R * q / self.angle,
            "hardening": lambda: -s * R * (q / self.angle) ** 3,
            "gravity_force": lambda: 2 * s * g,
            "gain": lambda: x["sign"] * s * u,
            "bump": lambda: s * R * np.exp(-(((z - x["at"]) / x["width"]) ** 2)),
            "stop": lambda: -2 * s * R * max(0.0, abs(z) - 1.0) * np.sign(z),
            "fast": lambda: -2 * s * R * max(0.0, abs(w) - 0.8) * turn,
        }
        return float(laws[self.name]()) if self.name in laws else 0.0

    @property
    def late(self) -> int:
        """Steps by which the drive's torque comes late."""
        return round(self.shape.get("late", 0.0) / STEP)


def hidden(name: str, joints: int, truth: str, rng: np.random.Generator) -> Hidden:
    """An effect of a name at a joint that is drawn, in units of a record without it."""
    turned = [k for k, axis in enumerate(AXES[joints]) if axis == Y]
    at = {"gravity_force": turned, **dict.fromkeys(DRIVES, turned[:HEAVY])}.get(name, range(joints))
    joint = int(rng.choice(at))
    log, rates = _moved(truth, joints, np.random.default_rng(int(rng.integers(1 << 30))), Hidden())
    q, u = log[:, 1 + joints + joint], log[:, 1 + joint]
    shape = {
        "v_s": rng.uniform(0.2, 0.6), "n": float(rng.integers(3, 13)), "sign": rng.choice([-1, 1]),
        "phase": rng.uniform(0, 2 * np.pi), "at": rng.uniform(-0.8, 0.8),
        "width": rng.uniform(0.3, 0.8),
    }  # fmt: skip
    if name == "cogging":
        shape["n"] = float(np.ceil(2 * np.pi * rng.uniform(*PERIODS) / np.ptp(q)))
    if name in LATE:
        shape["late"] = rng.uniform(*LATE[name])
    return Hidden(
        UNTOLD.get(name, name), joint, float(rng.uniform(*STRENGTH)), float(np.sqrt(np.mean(u**2))),
        float(np.sqrt(np.mean(rates[:, joint] ** 2))), float(q.std()), float(q.mean()), shape,
    )  # fmt: skip


def _moved(
    truth: str, joints: int, rng: np.random.Generator, effect: Hidden
) -> tuple[np.ndarray, np.ndarray]:
    """Samples of time, torques and angles (N, 1 + 2 joints), and of rates (N, joints)."""
    model = mujoco.MjModel.from_xml_string(truth)
    data, still = mujoco.MjData(model), mujoco.MjData(model)
    frequency = SLOWEST * np.arange(1, HARMONICS + 1)
    a = rng.uniform(0.1, 0.35, (joints, HARMONICS)) / np.sqrt(np.arange(1, HARMONICS + 1))
    p = rng.uniform(0, 2 * np.pi, (joints, HARMONICS))
    M = np.array([4.0 * 0.5**k for k in range(joints)])
    kp, kd, j = 400.0 * M, 40.0 * M, effect.joint
    data.qpos = (a * np.sin(p)).sum(axis=1)
    rows, rates, slow, seen = [], [], np.zeros(joints), data.qpos.copy()
    given: list[np.ndarray] = []
    weight = np.zeros(joints)
    for k in range(int(LASTS / STEP)):
        phase = 2 * np.pi * frequency * k * STEP + p
        ref = (a * np.sin(phase)).sum(axis=1)
        rate = (a * 2 * np.pi * frequency * np.cos(phase)).sum(axis=1)
        measured = data.qpos + NOISE * rng.standard_normal(joints)
        slow += FILTER * ((measured - seen) / STEP - slow)
        seen = measured
        u = kp * (ref - measured) + kd * (rate - slow)
        if k % SAMPLED == 0:
            rows.append([k * STEP, *u, *measured])
            rates.append(data.qvel.copy())
        given.append(u)
        data.ctrl = u
        data.ctrl[j] = given[max(0, k - effect.late)][j]
        if effect.name:
            if effect.name == "gravity_force":
                still.qpos = data.qpos
                mujoco.mj_fwdPosition(model, still)
                mujoco.mj_rne(model, still, 0, weight)
            data.qfrc_applied[j] = effect.force(data.qpos[j], data.qvel[j], data.ctrl[j], weight[j])
        mujoco.mj_step(model, data)
    return np.array(rows), np.array(rates)


def record(
    truth: str, joints: int, rng: np.random.Generator, name: str, effect: Hidden | None = None
) -> Log:
    """A record of an arm that follows a reference."""
    table, _ = _moved(truth, joints, rng, effect or Hidden())
    torque = table[:, 1 : 1 + joints]
    torque = torque + TORQUE_NOISE * torque.std(axis=0) * rng.standard_normal(torque.shape)
    return Log(
        time=table[:, 0], inputs=torque, outputs=table[:, 1 + joints :],
        input_names=[f"t{k}" for k in range(joints)], output_names=[f"q{k}" for k in range(joints)],
        name=name, hold="foh",
    )  # fmt: skip
