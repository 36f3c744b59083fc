"""A two-link arm with motors behind its gears, integrated by scipy from equations of its own.

    M(q) dv/dt + c(q, v) + g(q) = τ - d v - p           two links that hang in a vertical plane
    J_j dω_j/dt = u_j - τ_j                              where gear j gives; else M_jj + J_j
    c dp/dt = v - |v| p/b                                where friction gives, else b tanh(v/v_0)

The model has the links' inertia and that of the motors, J, as armature.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
from chain_cases import with_some
from joint_cases import arm_log, steps
from scipy.integrate import solve_ivp

from identification.effects.plant.joint_plant import JointPlant
from identification.model.rollout import State, rollout

JOINTS = ("shoulder", "elbow")
M1, C1, L1, I1, M2, C2, I2 = 1.2, 0.2, 0.35, 0.02, 0.7, 0.15, 0.01
ARMATURE, DAMPING, G = np.array([0.03, 0.012]), np.array([0.1, 0.05]), 9.81
SAMPLE = 0.01  # [s]
FULL = np.array([3.0, 1.0])  # of the inputs [N m]
LOG = arm_log(steps(100, 2, seed=3) * FULL)


def text(step: float, integrator: str, weight: float = G, damping: np.ndarray = DAMPING) -> str:
    """The arm for MuJoCo."""
    (d1, d2), (a1, a2) = damping, ARMATURE
    return f"""<mujoco model="arm"><option timestep="{step}" integrator="{integrator}"
      gravity="0 0 -{weight}"/>
      <worldbody><body name="upper">
        <joint name="shoulder" axis="0 1 0" damping="{d1}" armature="{a1}"/>
        <inertial pos="0 0 -{C1}" mass="{M1}" diaginertia="{I1} {I1} {I1}"/>
        <body name="lower" pos="0 0 -{L1}">
          <joint name="elbow" axis="0 1 0" damping="{d2}" armature="{a2}"/>
          <inertial pos="0 0 -{C2}" mass="{M2}" diaginertia="{I2} {I2} {I2}"/></body></body>
      </worldbody>
      <actuator><motor name="up" joint="shoulder"/><motor name="low" joint="elbow"/></actuator>
      <sensor><jointpos name="a" joint="shoulder"/><jointpos name="b" joint="elbow"/></sensor>
    </mujoco>"""


@cache
def arm_plant(
    step: float = 0.001, integrator: str = "RK4", weight: float = G, damped: bool = True
) -> JointPlant:
    """The arm with some effects, at a step of the integrator."""
    model = text(step, integrator, weight, DAMPING if damped else 0 * DAMPING)
    return with_some(model, LOG)


def elastic(c: dict[str, float], rho: float = 0.3, zeta: float = 0.05) -> dict[str, float]:
    """Values of elastic gears at some joints, their encoders on the links' side."""
    return {**{f"joint_elasticity.c@{joint}": x for joint, x in c.items()},
            "joint_elasticity.rho": rho, "joint_elasticity.zeta": zeta,
            "joint_elasticity.link": 1.0}  # fmt: skip


def gap(eps: dict[str, float], rho: float = 0.3) -> dict[str, float]:
    """Values of gaps in stiff gears, their encoders on the links' side."""
    return {**{f"gear_backlash.eps@{joint}": x for joint, x in eps.items()},
            "gear_backlash.rho": rho, "gear_backlash.link": 1.0}  # fmt: skip


def inertias(rho: float) -> np.ndarray:
    """J of both joints, shape (2,) [kg m²]."""
    sizes = elastic(dict.fromkeys(JOINTS, 0.0))
    return rho * np.array([*arm_plant().with_states_of(sizes).gears.inertia.values()])


def mass(q: np.ndarray) -> np.ndarray:
    """Mass matrix of the links, shape (2, 2) [kg m²]."""
    a, b, d = M1 * C1**2 + I1 + M2 * L1**2, M2 * C2 * L1, M2 * C2**2 + I2
    x = b * np.cos(q[1])
    return np.array([[a + d + 2 * x, d + x], [d + x, d]])


def weighing(q: np.ndarray, weight: float = G) -> np.ndarray:
    """g(q), shape (2,) [N m]."""
    low = weight * M2 * C2 * np.sin(q[0] + q[1])
    return np.array([weight * (M1 * C1 + M2 * L1) * np.sin(q[0]) + low, low])


@dataclass(frozen=True, kw_only=True)
class Arm:
    """What the arm is made of, each of shape (2,)."""

    c: tuple[float, float] = (0.0, 0.0)  # compliance of the gears [rad/(N m)]; 0: rigid
    J: tuple[float, float] = (0.0, 0.0)  # inertia of the motors [kg m²], of the armature in `text`
    zeta: float = 0.05  # damping ratio of motor and spring
    slip: float = 0.0  # compliance of the friction [rad/(N m)]; 0: it is smoothed
    f_c: tuple[float, float] = (0.0, 0.0)  # Coulomb friction [N m]
    d: tuple[float, float] = tuple(DAMPING)  # viscous friction [N m s/rad]
    weight: float = G  # acceleration of gravity [m/s²]

    def tau(self, x: np.ndarray) -> np.ndarray:
        """Of the gears that give."""
        q, v, theta, omega, _ = x.reshape(5, 2)
        k = np.where(self.gives, 1 / np.where(self.gives, self.c, 1.0), 0.0)
        return k * (theta - q) + 2 * self.zeta * np.sqrt(np.array(self.J) * k) * (omega - v)

    @property
    def gives(self) -> np.ndarray:
        """Which gears give."""
        return np.array(self.c) > 0

    @property
    def whole(self) -> np.ndarray:
        """Inertia that the motors leave to the joints, shape (2,)."""
        return ARMATURE - np.where(self.gives, self.J, 0.0)

    def energy(self, x: np.ndarray) -> float:
        """Kinetic and potential energy of links, motors and springs [J]."""
        q, v, theta, omega, _ = x.reshape(5, 2)
        still = np.diag(self.whole) + mass(q)
        low = C1 * M1 * np.cos(q[0]) + M2 * (L1 * np.cos(q[0]) + C2 * np.cos(q[0] + q[1]))
        spring = np.where(self.gives, (theta - q) ** 2 / np.where(self.gives, self.c, 1.0), 0.0)
        spun = np.where(self.gives, self.J * omega**2, 0.0)
        return float((v @ still @ v + spun.sum() + spring.sum()) / 2 - self.weight * low)

    def rate(self, x: np.ndarray, u: np.ndarray) -> np.ndarray:
        """Of q, v, θ, ω and p, shape (10,)."""
        q, v, _, omega, p = x.reshape(5, 2)
        b, tau = np.array(self.f_c), np.where(self.gives, self.tau(x), u)
        p_dot = np.zeros(2)
        if self.slip:
            p_dot = (v - abs(v) * p / b) / self.slip
        else:
            p = b * np.tanh(v / 1e-3)
        s = M2 * C2 * L1 * np.sin(q[1])
        bias = np.array([-s * v[1] * (2 * v[0] + v[1]), s * v[0] ** 2]) + weighing(q, self.weight)
        M = mass(q) + np.diag(self.whole)
        a = np.linalg.solve(M, tau - np.array(self.d) * v - p - bias)
        spun = np.where(self.gives, (u - tau) / np.where(self.gives, self.J, 1.0), a)
        return np.concatenate([v, a, np.where(self.gives, omega, v), spun, p_dot])

    def moved(self, u: np.ndarray, x: np.ndarray | None = None, tight: float = 1e-9) -> np.ndarray:
        """States at the samples of inputs, shape (N, 10), from rest or from x."""
        x, out = np.zeros(10) if x is None else x, []
        for now in u:
            out.append(x)
            x = solve_ivp(
                lambda t, x, now=now: self.rate(x, now), (0, SAMPLE), x, method="LSODA",
                rtol=tight, atol=1e-3 * tight,
            ).y[:, -1]  # fmt: skip
        return np.array(out)


def states_of(
    plant: JointPlant, values: dict[str, float], start: State, u: np.ndarray
) -> dict[str, np.ndarray]:
    """qpos, qvel and act of a plant with the states that some values need, shape (N, size) each."""
    plant = plant.with_states_of(values)
    _, numbers = plant.settings(tuple(values), np.array([[*values.values()]]))
    made = rollout(plant.model, start, u, SAMPLE, numbers=numbers,
                   record=("qpos", "qvel", "act"))  # fmt: skip
    return {name: x[0] for name, x in made.items()}
