"""A pendulum with a motor behind its gear, integrated by scipy from equations of its own.

    M dv/dt = τ - d v - m g l sin q - friction     J dω/dt = u - τ - d_m ω     τ: see `Truth.spring`

M is the link's inertia, J the motor's; the nominal model of `records_cases` has M + J in one piece.
"""

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from records_cases import AXIS, MJCF, PARAMETERS, STEP, record
from scipy.integrate import solve_ivp

from identification import Log, Parameter
from identification.effects.plant.joint_plant import joint_plant

FILE = 0.5 * 0.01 + 1e-3  # inertia about the hinge, as the model's file has it [kg m²]
WHOLE = FILE + 2e-3  # with the armature among the parameters
WEIGHT = 0.5 * 9.81 * 0.1  # m g l [N m]
F_C = 0.06  # Coulomb friction [N m]
COULOMB = Parameter(
    name="coulomb_friction.f_c@hinge", value=F_C, unit="N m", where="effect", lower=0.0, upper=1.0
)
ELASTIC, BACKLASH = "joint_elasticity.c@hinge", "gear_backlash.eps@hinge"
PRESLIDING, DRAG = "presliding.c@hinge", "motor_damping.d_m@hinge"
STATES = ("joint_elasticity", "gear_backlash", "motor_damping", "presliding")
WANTED = ("coulomb_friction", "stribeck_friction", *STATES)


@dataclass(frozen=True, kw_only=True)
class Truth:
    """What the pendulum is made of."""

    c: float = 0.0  # compliance of the gear [rad/(N m)]
    gap: float = 0.0  # half the gap of its teeth [rad]
    J: float = 2e-3  # inertia of the motor [kg m²]
    zeta: float = 0.05  # damping ratio of motor and spring
    slip: float = 0.0  # compliance of the friction [rad/(N m)]
    f_c: float = 0.0  # Coulomb friction [N m]; with a compliance of zero it is smoothed
    d: float = 0.02  # viscous friction [N m s/rad]
    d_m: float = 0.0  # viscous friction of the motor [N m s/rad]
    weight: float = WEIGHT  # m g l [N m]

    def spring(self, delta: float, rate: float) -> float:
        """τ: the spring presses behind its gap, where its flank only pushes."""
        over = delta - np.clip(delta, -self.gap, self.gap)
        force = over / self.c + 2 * self.zeta * np.sqrt(self.J / self.c) * rate
        if self.gap == 0:
            return float(force)
        return float(max(force, 0.0) if over > 0 else min(force, 0.0) if over < 0 else 0.0)

    def rate(self, x: np.ndarray, u: float) -> list[float]:
        """Of q, v, θ, ω and the force p of the friction."""
        q, v, theta, omega, p = x
        if self.slip:
            p_dot = (v - abs(v) * p / self.f_c) / self.slip
        else:
            p, p_dot = self.f_c * np.tanh(v / 1e-3), 0.0
        f = -self.d * v - self.weight * np.sin(q) - p
        if not self.c:
            a = (u + f) / WHOLE
            return [v, a, v, a, p_dot]
        tau = self.spring(theta - q, omega - v)
        return [
            v,
            (tau + f) / (WHOLE - self.J),
            omega,
            (u - tau - self.d_m * omega) / self.J,
            p_dot,
        ]


def moved(truth: Truth, log: Log, side: str = "motor", tight: float = 1e-9) -> np.ndarray:
    """Angles at the samples of a log, from rest, shape (N, 1)."""
    x, out = np.zeros(5), []
    for u in log.inputs[:, 0]:
        out.append(x[2] if side == "motor" else x[0])
        x = solve_ivp(
            lambda t, x, u=u: truth.rate(x, u), (0, STEP), x, method="LSODA", rtol=tight,
            atol=1e-3 * tight,
        ).y[:, -1]  # fmt: skip
    return np.array(out)[:, None]


def measured(truth: Truth, seed: int, samples: int = 400, noise: float = 1e-4) -> Log:
    """A record with noise."""
    log = record(seed, samples=samples)
    y = moved(truth, log, tight=1e-7)
    return replace(log, outputs=y + noise * np.random.default_rng(seed).standard_normal(y.shape))


@cache
def pendulum(f_c: float = F_C, step: float = 0.005, weight: bool = True):
    """The nominal pendulum at a step of the integrator."""
    text = MJCF.replace('timestep="0.005"', f'timestep="{step}"')
    text = text if weight else text.replace('integrator="RK4"', 'integrator="RK4" gravity="0 0 0"')
    given = (*PARAMETERS, replace(COULOMB, value=f_c))
    axis = replace(AXIS, give=step**2 / FILE)
    log = record(samples=50)
    every = joint_plant(text, given, log, joints=(axis,)).effects
    effects = [e for e in every if e.name in WANTED]  # a law of all would take 25 s to compile
    return joint_plant(text, given, log, joints=(axis,), effects=effects)


def share(J: float) -> float:
    """ρ of a motor's inertia."""
    return J / FILE


def elastic(c: float, J: float = 2e-3, zeta: float = 0.05, link: float = 0.0) -> dict[str, float]:
    """Values of an elastic gear."""
    return {ELASTIC: c, "joint_elasticity.rho": share(J), "joint_elasticity.zeta": zeta,
            "joint_elasticity.link": link}  # fmt: skip


def gap(eps: float, J: float = 2e-3) -> dict[str, float]:
    """Values of a gap in a stiff gear."""
    return {BACKLASH: eps, "gear_backlash.rho": share(J), "gear_backlash.link": 0.0}


def with_values(values: dict[str, float], f_c: float = 0.0, step: float = 0.001, weight=True):
    """The pendulum in a plant with the states that some values need."""
    return pendulum(f_c, step, weight).with_states_of(values)
